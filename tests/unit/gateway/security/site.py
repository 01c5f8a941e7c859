"""A site of two clinics with somebody of every role, and what each may and may not see. Made once, put back at will."""

import secrets
import shutil
from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

from argon2 import PasswordHasher
from fastapi import FastAPI
from fastapi.testclient import TestClient
from sqlalchemy import select

from schemas.conditions import Conditions
from schemas.session import SessionDescription
from schemas.signals import GAIT_EVENT, JOINT_STATE, STRIDE
from schemas.vocabulary import LOWER_BODY, Side
from services.archive.disk import Disk
from services.archive.manifest import new_manifest, store, with_files
from services.archive.seal import seal
from services.archive.writer import SessionWriter
from services.flow.message import Envelope, Stream, encode_payload
from services.gateway.access import keys, sign_ins
from services.gateway.access.identify import COOKIE
from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import DeviceRow, ShareRow, SignInRow
from services.gateway.accounts.passwords import Passwords
from services.gateway.accounts.records import add_account
from services.gateway.app import create_app
from services.gateway.control import Source, StartRequest
from services.gateway.live.hub import LiveHub
from services.gateway.parameters import GatewayParameters
from services.gateway.sessions import records
from services.gateway.settings import GatewaySettings
from services.gateway.tables import ClinicRow, PatientRow, SessionRow, TreatmentRow
from services.recordings.record import Record
from tests.unit.gateway.walk import describe, metrics_at, stride_at
from tests.unit.progress.patient import SAID

NOW = datetime(2026, 11, 20, 9, tzinfo=UTC)
PASSWORD = "three quiet steps"
"""Of everybody; the example of the API's description."""

NS = 10_000_000
ROLES = ("viewer", "therapist", "admin", "service")
CALLERS = ("nobody", *ROLES, "site")
"""`site`: an administrator who may manage every clinic."""

PREPARED = {
    "PUT /v1/patients/{code}/baseline": {"session": "session"},
    "PUT /v1/patients/{code}/name": {"name": "name"},
}
"""Done for every patient by an administrator of their clinic before anything is tried; bodies by `Target.values`."""


class Obliging:
    """An ingest and an archive that do whatever they are asked to."""

    def start(self, request: StartRequest) -> SessionDescription:
        return describe(request.session)

    def stop(self, session: str) -> None:
        pass

    def mark(self, session: str, last_s: float, at_s: float | None) -> tuple[float, float]:
        return 1.0, 1.0 + last_s

    def offered(self) -> list[Source]:
        return [Source("some_walk", "A recorded walk", "recording", 49.0)]

    def erase(self, sessions: list[str]) -> list[str]:
        return sessions


@dataclass(frozen=True)
class Target:
    """What a request may be about: all of one clinic and one patient."""

    code: str
    clinic: str
    values: Mapping[str, object]
    """By the names that paths and bodies have for them."""


class Site:
    """The application, its people and its patients."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._kept = folder / "site", folder / "kept"
        pages = self._folder / "pages"
        pages.mkdir(parents=True)
        (pages / "index.html").write_text("<!doctype html><title>Ambula</title>")
        settings = GatewaySettings(
            data_dir=self._folder / "data", pages_dir=pages, database=f"sqlite:///{self._folder}/gateway.sqlite",
            http_names=["testserver"],
        )  # fmt: skip
        # Far more is asked of it than of a clinic, so nobody is asked to wait.
        free = {"requests_per_caller_per_s": 1e6, "requests_per_address_per_s": 1e6, "sign_ins_per_address_per_s": 1e6}
        self.hub = LiveHub(GatewayParameters(ask_again_s=3600.0, **free))
        self.app: FastAPI = create_app(settings, self.hub, Obliging())
        # Passwords as quick as they may be: what they cost is not what is tried here.
        self.app.state.gateway = replace(self.app.state.gateway, passwords=Passwords(PasswordHasher(1, 8, 1)))
        self._gateway = self.app.state.gateway
        self.headers: dict[str, dict[str, str]] = {"nobody": {}}
        self._password = self._gateway.passwords.keep(PASSWORD)
        with self._gateway.database.transaction(EVERYTHING) as self._rows:
            self._rows.add(ClinicRow(id="other", name="Elsewhere", keep_days=None, created=NOW))
            self._rows.flush()
            self._add_people()
            self.targets = {
                "own": self._target("own", "K7QM3F", "main"),
                "shared": self._target("shared", "SHARED9", "other"),
                "foreign": self._target("foreign", "THEIRS9", "other"),
                "binned": self._target("binned", "BINNED9", "main", NOW),
            }
            self._rows.flush()
            for code in ("SHARED9", "SHARED9B", "SHARED9R"):
                self._rows.add_all(
                    ShareRow(patient_code=code, account_id=self.accounts[who], granted_by=None, granted=NOW)
                    for who in ("viewer", "therapist", "admin", "site")
                )

    def prepare(self, client: TestClient) -> None:
        """Bring about by requests what the database alone does not tell how to make, then remember all of it."""
        self.client = client
        for name, fields in PREPARED.items():
            method, path = name.split(" ")
            for kind in ("own", "shared", "foreign"):
                values = self.targets[kind].values
                body = {field: values[value] for field, value in fields.items()}
                headers = self.headers["admin" if kind == "own" else "elsewhere"]
                answer = client.request(method, path.format_map(values), json=body, headers=headers)
                assert answer.is_success, answer.text
        self._close()
        shutil.copytree(self._folder, self._kept)

    def forget_confirmations(self) -> None:
        """Everybody signed in hours ago."""
        with self._gateway.database.transaction(EVERYTHING) as rows:
            for row in rows.scalars(select(SignInRow)):
                row.confirmed -= timedelta(hours=2)

    def put_back(self) -> None:
        """Everything on disk as it was."""
        self._close()
        shutil.rmtree(self._folder)
        shutil.copytree(self._kept, self._folder)

    def _close(self) -> None:
        self._gateway.database.close()
        self._gateway.directory.close()

    def _add_people(self) -> None:
        self.accounts: dict[str, str] = {}
        for name in (*CALLERS[1:], "elsewhere"):
            if name == "service":
                _, key = keys.add_key(self._rows, "exporter", Role.SERVICE, "main", None, datetime.now(UTC), 30)
                self.headers[name] = {"authorization": f"Bearer {key}"}
                continue
            role = Role(name) if name in ROLES else Role.ADMIN
            clinic = "other" if name == "elsewhere" else "main"
            account = add_account(
                self._rows, f"{name}.{clinic}", role, clinic, self._password, site_admin=name == "site"
            )
            self._rows.flush()
            self.accounts[name] = account.id
            self.headers[name] = {"cookie": f"{COOKIE}={sign_ins.begin(self._rows, account, datetime.now(UTC))}"}

    def _target(self, name: str, code: str, clinic: str, deleted: datetime | None = None) -> Target:
        mark = "more" if deleted else name
        staff = add_account(self._rows, f"staff.{mark}", Role.VIEWER, clinic, self._password)
        seer, guest = (
            add_account(self._rows, f"{who}.{mark}", Role.VIEWER, "other", None) for who in ("seer", "guest")
        )
        key, _ = keys.add_key(self._rows, f"key {mark}", Role.VIEWER, clinic, None, datetime.now(UTC), 30)
        device = DeviceRow(
            id=secrets.token_hex(6), clinic_id=clinic, name=f"Camera {mark}", kind="camera", source=None, note=None,
            retired=None, created=NOW,
        )  # fmt: skip
        codes = [code, f"{code}B", f"{code}R"]
        self._rows.add_all([device, *(self._patient(each, clinic, deleted) for each in codes)])
        self._rows.flush()
        treatment = TreatmentRow(patient_code=code, on=NOW.date(), what="botulinum_toxin")
        share = ShareRow(patient_code=code, account_id=seer.id, granted_by=None, granted=NOW)
        self._rows.add_all([treatment, share])
        over = self._session(f"over-{name}", code, clinic, deleted)
        running = self._session(f"running-{name}", codes[2], clinic, deleted)
        thrown = self._session(f"thrown-{name}", "K7QM3F", clinic, deleted) if deleted else over
        for session in {over.id, thrown.id}:
            records.record_metrics(self._rows, session, metrics_at(60.0, final=True))
        self._record(describe(over.id))
        self._rows.flush()
        values = {
            "code": code, "session": over.id, "running": running.id, "number": treatment.id, "codes": codes,
            "other code": codes[1], "account": staff.id, "seer": seer.id, "guest": guest.id, "login": guest.login,
            "key": key.id, "device": device.id, "clinic": clinic, "password": PASSWORD,
            "name": f"Erika {name.title()}", "thrown": thrown.id,
        }  # fmt: skip
        return Target(code, clinic, values)

    def _patient(self, code: str, clinic: str, deleted: datetime | None) -> PatientRow:
        return PatientRow(
            code=code, clinic_id=clinic, deleted=deleted, year_of_birth=1957, sex="female",
            population="stroke_chronic", paretic_side="left", created=NOW,
        )  # fmt: skip

    def _session(self, session: str, code: str, clinic: str, deleted: datetime | None) -> SessionRow:
        started = round(NOW.timestamp() * 1e9)
        said = Conditions.model_validate(SAID)
        row = records.record_start(self._rows, describe(session, started_unix_ns=started, conditions=said), clinic)
        row.patient_code, row.deleted, row.created = code, deleted, NOW
        self._rows.flush()
        return row

    def _record(self, description: SessionDescription) -> None:
        folder, disk = self._gateway.settings.data_dir / description.session, Disk()
        folder.mkdir(parents=True)
        writer = SessionWriter(folder, description, "0.1.0", disk=disk)
        for message in _messages():
            writer.write(message)
        writer.flush()
        entries = [entry for part in writer.close() if (entry := seal(part, "ambula test", disk, 4096))]
        store(folder, with_files(new_manifest(description, "0.1.0"), entries), disk)


def _messages() -> list[Record]:
    joints, events, strides = (
        Stream(JOINT_STATE, "estimation"), Stream(GAIT_EVENT, "segmentation"), Stream(STRIDE, "segmentation"),
    )  # fmt: skip
    messages = [_message(joints, number, _joint_state(number * NS), number * NS) for number in range(50)]
    event = GAIT_EVENT.model(kind="toe_off", side="left", captured_ns=20 * NS, time_std_s=0.01)
    stride = stride_at(1.2, Side.LEFT, 0)
    return [*messages, _message(events, 0, event, 20 * NS), _message(strides, 0, stride, stride.end_ns)]


def _message(stream: Stream, sequence: int, payload: object, captured_ns: int) -> Record:
    envelope = Envelope(0, sequence, captured_ns, False)
    return Record(stream, envelope, encode_payload(payload), 1_790_000_000_000_000_000 + captured_ns)


def _joint_state(captured_ns: int) -> object:
    nothing = [[0.0] * len(LOWER_BODY)]
    return JOINT_STATE.model(
        model="lower_body", captured_ns=[captured_ns], position=[[0.3] * len(LOWER_BODY)], velocity=nothing,
        acceleration=nothing, position_std=nothing, velocity_std=nothing, valid=[True] * len(LOWER_BODY), observed=[],
    )  # fmt: skip
