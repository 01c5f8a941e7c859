"""Everything a report is made from, out of database, archive and reference sets."""

import hashlib
from http import HTTPStatus
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from schemas.archive_layout import Manifest, RecordingState, folder_name, parse_file_name
from schemas.gait import Stride
from schemas.kinematics import Calibration
from schemas.metrics import SessionMetrics
from schemas.population import Population, Sex
from schemas.session import SessionDescription
from schemas.signals import STRIDE
from services.exports.recorded import RecordedSession
from services.gateway.context import Gateway
from services.gateway.problems import Problem
from services.gateway.progress.routes import patient_progress
from services.gateway.references.shelf import shelf_of
from services.gateway.sessions.models import SessionState
from services.gateway.sessions.records import get_session
from services.gateway.sessions.shapes import stored_metrics
from services.gateway.sessions.told import description_of
from services.gateway.tables import PatientRow, SessionRow, TreatmentRow
from services.recordings.errors import ArchiveError, NotARecording
from services.recordings.folder import read_manifest
from services.reference.bands import Person
from services.report.from_progress import progress_of
from services.report.from_reference import References, references_of
from services.report.source import Patient, Progress, ReportSource, Treatment


def report_source(gateway: Gateway, session: str, *, with_strides: bool = False) -> ReportSource:
    """Raises a 404 problem for an unknown session or recording, a 409 problem for one without final metrics."""
    strides = recorded_strides(gateway.settings.data_dir, session) if with_strides else ()
    with gateway.transaction() as database:
        row = get_session(database, session)
        metrics = _final_metrics(row)
        description = _description(row)
        calibration = None if row.calibration is None else Calibration.model_validate(row.calibration.body)
        began = row.started or row.created
        person = None if row.patient_code is None else database.get(PatientRow, row.patient_code)
        progress = None if person is None else _progress(database, gateway, person.code, session)
        references = _references(gateway, metrics, person, began.year, calibration)
        return ReportSource(
            description=description,
            metrics=metrics,
            calibration=calibration,
            began=began,
            patient=None if person is None else _patient(person),
            progress=progress,
            references=references.ranges,
            reference_curves=references.curves,
            reference_gaps=references.gaps,
            installed_sets=references.sets,
            recording_sha256=recording_digest(gateway.settings.data_dir, session),
            strides=strides,
        )


def _final_metrics(row: SessionRow) -> SessionMetrics:
    metrics = stored_metrics(row)
    if metrics is not None and metrics.final:
        return metrics
    if row.state in (SessionState.CREATED, SessionState.LIVE):
        step = f"Stop it with POST /v1/sessions/{row.id}/stop, or wait until it has ended."
        raise Problem(HTTPStatus.CONFLICT, f"Session {row.id} still runs; a report needs its final metrics.", step)
    step = f"Compute them from the recording with `ambula reprocess {row.id} --store`, then ask again."
    raise Problem(HTTPStatus.CONFLICT, f"Session {row.id} has no final metrics.", step)


def _description(row: SessionRow) -> SessionDescription:
    description = description_of(row)
    if description is None:
        step = f"Compute it anew from the recording with `ambula reprocess {row.id} --store`, then ask again."
        raise Problem(HTTPStatus.CONFLICT, f"Nothing is stored of how session {row.id} was done.", step)
    return description


def _patient(row: PatientRow) -> Patient:
    return Patient(
        code=row.code,
        year_of_birth=row.year_of_birth,
        sex=None if row.sex is None else Sex(row.sex),
        population=None if row.population is None else Population(row.population),
    )


def _progress(database: Session, gateway: Gateway, code: str, session: str) -> Progress | None:
    visits, told = patient_progress(database, gateway, code)
    rows = database.scalars(select(TreatmentRow).where(TreatmentRow.patient_code == code).order_by(TreatmentRow.id))
    return progress_of(session, visits, told, [Treatment(each.on, each.what) for each in rows])


def _references(
    gateway: Gateway, metrics: SessionMetrics, person: PatientRow | None, year: int, calibration: Calibration | None
) -> References:
    born = None if person is None else person.year_of_birth
    sex = None if person is None or person.sex is None else Sex(person.sex)
    speed = next((each.value for each in metrics.metrics if each.name == "walking_speed" and each.side is None), None)
    compared = Person(None if born is None else float(year - born), sex, speed)
    datum = None if calibration is None else calibration.datum
    return references_of(shelf_of(gateway).sets, metrics, compared, datum)


def recorded_strides(data_dir: Path, session: str) -> tuple[Stride, ...]:
    """Every stride that the archive has. Raises a 404 problem without a recording, a 409 problem for a damaged one."""
    try:
        recording = RecordedSession(data_dir / folder_name(session))
        return tuple(each for each in recording.payloads(STRIDE) if isinstance(each, Stride))
    except (NotARecording, FileNotFoundError) as error:
        step = "Ask for the report without its strides."
        raise Problem(HTTPStatus.NOT_FOUND, f"Session {session} has no recording.", step) from error
    except ArchiveError as error:
        step = "Ask for the report without its strides, or restore the recording from a backup."
        raise Problem(HTTPStatus.CONFLICT, f"The recording of session {session} is damaged.", step) from error


def recording_digest(data_dir: Path, session: str) -> str | None:
    """The raw recording's SHA-256, hexadecimal: that of its one file, or of the lines `sum  name` of several in order.

    None while it is being written, and where the archive has none.
    """
    manifest = read_manifest(data_dir / folder_name(session))
    if manifest is None or manifest.state is RecordingState.RECORDING:
        return None
    return _digest(manifest)


def _digest(manifest: Manifest) -> str | None:
    raw = [each for each in manifest.files if (name := parse_file_name(each.name)) is not None and name.kind == "raw"]
    if len(raw) == 1:
        return raw[0].sha256
    lines = "".join(f"{each.sha256}  {each.name}\n" for each in sorted(raw, key=lambda each: each.name))
    return hashlib.sha256(lines.encode()).hexdigest() if raw else None
