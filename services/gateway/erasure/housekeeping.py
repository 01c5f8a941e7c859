"""What is erased by itself: the bin when its time is over, and sessions that a clinic keeps no longer."""

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from http import HTTPStatus

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from services.gateway.access.scope import EVERYTHING
from services.gateway.audit import records as audit
from services.gateway.audit.chain import Entry
from services.gateway.audit.heads import Heads
from services.gateway.audit.tables import AuditHeadRow
from services.gateway.erasure.eraser import HERE, Eraser
from services.gateway.parameters import GatewayParameters
from services.gateway.recycling.records import RUNNING
from services.gateway.tables import ClinicRow, PatientRow, SessionRow


class Housekeeping:
    """Jobs of the gateway; each can be done again at any time. `now` is UTC."""

    def __init__(self, eraser: Eraser, heads: Heads, parameters: GatewayParameters) -> None:
        self._eraser = eraser
        self._heads = heads
        self._parameters = parameters

    def empty_bin(self, now: datetime | None = None) -> int:
        """Erase what has been in the bin for long enough; how many patients and sessions."""
        now = now or datetime.now(UTC)
        before = now - timedelta(days=self._parameters.bin_days)
        with self._database() as database:
            patients = list(database.scalars(select(PatientRow).where(PatientRow.deleted <= before)))
            chosen = [(each, _sessions(database, SessionRow.patient_code == each.code)) for each in patients]
            alone = list(database.scalars(select(SessionRow).where(SessionRow.deleted <= before)))
        for patient, sessions in chosen:
            self._erase(patient.code, patient.clinic_id, sessions, "bin_expired", now)
        gone = {session for _, sessions in chosen for session in sessions}
        left = [row for row in alone if row.id not in gone]
        for row in left:
            self._erase(None, row.clinic_id, [row.id], "bin_expired", now)
        return len(chosen) + len(left)

    def keep_no_longer(self, now: datetime | None = None) -> int:
        """Erase sessions that are older than their clinic keeps them; how many."""
        now = now or datetime.now(UTC)
        with self._database() as database:
            clinics = list(database.scalars(select(ClinicRow).where(ClinicRow.keep_days.is_not(None))))
            chosen = [
                (clinic.id, session)
                for clinic in clinics
                for session in _sessions(
                    database,
                    SessionRow.clinic_id == clinic.id,
                    SessionRow.created < now - timedelta(days=clinic.keep_days or 0),
                    SessionRow.state.not_in(RUNNING),
                )
            ]
        for clinic_id, session in chosen:
            self._erase(None, clinic_id, [session], "kept_long_enough", now)
        return len(chosen)

    def remove_recordings(self) -> int:
        """Have recordings removed that the archive could not remove before; how many are still there."""
        return self._eraser.finish()

    def sign_audit(self, now: datetime | None = None) -> bool:
        """Sign where the audit ends, once a day."""
        with self._database() as database:
            head = database.get_one(AuditHeadRow, audit.HEAD)
            number, digest = head.number, head.digest
        return self._heads.sign_if_due(number, digest, now or datetime.now(UTC)) is not None

    def _erase(self, patient: str | None, clinic: str, sessions: list[str], reason: str, now: datetime) -> None:
        self._eraser.erase(patient, sessions, HERE, reason, now)
        session = sessions[0] if patient is None else None
        action = "erase_session" if patient is None else "erase_patient"
        entry = Entry(now, HERE, None, None, clinic, action, patient, session, None, HTTPStatus.OK, reason)
        with self._database() as database:
            audit.append(database, entry)

    @contextmanager
    def _database(self) -> Iterator[Session]:
        with self._eraser.database.transaction(EVERYTHING) as database:
            yield database


def _sessions(database: Session, *conditions: ColumnElement[bool]) -> list[str]:
    return list(database.scalars(select(SessionRow.id).where(*conditions)))
