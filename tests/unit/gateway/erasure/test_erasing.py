"""Erased is erased: every store is looked through for what was there; the audit alone still names the code (R20)."""

import shutil
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import MetaData, select

from services.archive.disk import Disk
from services.archive.erasing import erase_folder
from services.cli.erasures import apply_erasures
from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import ShareRow
from services.gateway.app import create_app
from services.gateway.audit import records as audit
from services.gateway.audit.heads import Heads
from services.gateway.control import ControlUnavailable
from services.gateway.database import DatabaseError
from services.gateway.erasure.housekeeping import Housekeeping
from services.gateway.erasure.tombstones import FILE
from services.gateway.exports.sending import Erased
from services.gateway.exports.writing import blocks
from services.gateway.live.hub import LiveHub
from services.gateway.tables import BaselineRow, ClinicRow, FormerMetricsRow, RhythmRow, SessionRow
from tests.unit.gateway import people

MARKER = "MARKER-of-somebody"
DATABASE = {"gateway.sqlite", "gateway.sqlite-wal"}
REASON = {"reason": "requested_by_patient"}


@pytest.fixture(autouse=True)
def archive(control, settings, monkeypatch):
    """An archive that does what it is told, as far as it can be reached."""

    def erase(sessions):
        control._fail()
        for session in sessions:
            erase_folder(settings.data_dir / session, Disk())
        return sessions

    monkeypatch.setattr(control, "erase", erase)


@pytest.fixture
def patient(client):
    code = client.post("/v1/patients", json={"year_of_birth": 1957}).json()["code"]
    client.put(f"/v1/patients/{code}/name", json={"name": MARKER})
    client.post(f"/v1/patients/{code}/treatments", json={"date": "2026-11-01", "kind": "botulinum_toxin"})
    return code


@pytest.fixture
def walk(client, gateway, made, settings, patient):
    """Sessions with everything that can hang on one."""

    def walk(session, code=patient, title=MARKER):
        gateway.keeper.appeared(made.describe(session, title=title))
        gateway.keeper.measured(session, made.metrics_at(30.0, final=True))
        client.patch(f"/v1/sessions/{session}", json={"patient": code})
        now = datetime.now(UTC)
        with gateway.database.transaction(EVERYTHING) as database:
            database.add(RhythmRow(session_id=session, received=now, body={"of": title}))
            database.add(
                FormerMetricsRow(session_id=session, software="old", received=now, replaced=now, body={"of": title})
            )
        folder = settings.data_dir / session
        folder.mkdir(parents=True)
        (folder / "raw.mcap").write_text(title)

    return walk


@pytest.fixture
def everything(client, gateway, walk, patient):
    """A patient with two sessions, one of them in the bin, a baseline and a share; and somebody else."""
    walk("a")
    walk("b")
    other = client.post("/v1/patients", json={}).json()["code"]
    client.put(f"/v1/patients/{other}/name", json={"name": "Somebody Else"})
    walk("c", other, "Another walk")
    guest = people.sign_in(client, Role.THERAPIST, "other")
    now = datetime.now(UTC)
    with gateway.database.transaction(EVERYTHING) as database:
        database.add(BaselineRow(patient_code=patient, session_id="a", frozen=now, body={"of": MARKER}))
        database.add(ShareRow(patient_code=patient, account_id=guest, granted_by=None, granted=now))
    people.sign_in(client, Role.ADMIN)
    client.delete("/v1/sessions/b")
    return other


def rows_with(gateway, *words):
    """Tables that hold one of the words anywhere, the audit aside."""
    tables = MetaData()
    tables.reflect(gateway.database.engine)
    found = set()
    with gateway.database.engine.connect() as connection:
        for table in tables.sorted_tables:
            text = str(connection.execute(select(table)).all())
            if table.name != "audit_entry" and any(word in text for word in words):
                found.add(table.name)
    return found


def files_with(folder, word):
    return {path.name for path in folder.rglob("*") if path.is_file() and word.encode() in path.read_bytes()}


def test_nothing_is_left_but_the_audit(client, gateway, settings, tmp_path, patient, everything):
    words = (patient, MARKER, "'a'", "'b'")
    assert len(rows_with(gateway, *words)) >= 8
    before = files_with(tmp_path, MARKER)
    assert "raw.mcap" in before
    assert before & DATABASE
    answer = client.post(f"/v1/patients/{patient}/erasure", json=REASON)
    assert (answer.status_code, answer.json()) == (200, {"sessions": 2, "recordings_left": 0})
    assert rows_with(gateway, *words) == set()
    assert files_with(tmp_path, MARKER) == set()
    assert sorted(path.name for path in settings.data_dir.iterdir() if path.is_dir()) == ["c"]
    assert files_with(tmp_path, patient) <= DATABASE, "the audit"
    assert client.get(f"/v1/patients/{patient}").status_code == 404
    assert client.get(f"/v1/patients/{everything}/name").json()["name"] == "Somebody Else"
    with gateway.database.transaction(EVERYTHING) as database:
        last = audit.entries_from(database, 1, 1000)[-3]
    assert (last.action, last.patient, last.reason) == ("erase_patient", patient, "requested_by_patient")


def test_the_list_of_erasures_names_nobody(client, settings, patient, everything):
    client.post(f"/v1/patients/{patient}/erasure", json=REASON)
    text = (settings.own_dir / FILE).read_text()
    assert patient not in text
    assert '"sessions":["a","b"]' in text


def test_a_restored_backup_brings_nobody_back(client, gateway, settings, hub, control, patient, everything, tmp_path):
    kept = tmp_path / "kept"
    shutil.copytree(settings.data_dir, kept / "recordings")
    with gateway.database.engine.connect() as connection:
        connection.exec_driver_sql(f"VACUUM INTO '{kept}/gateway.sqlite'")
    client.post(f"/v1/patients/{patient}/erasure", json=REASON)
    stones = (settings.own_dir / FILE).read_text()
    gateway.database.close()
    gateway.directory.close()
    shutil.rmtree(settings.data_dir)
    shutil.copytree(kept / "recordings", settings.data_dir)
    shutil.copy(kept / "gateway.sqlite", settings.database.removeprefix("sqlite:///"))
    shutil.rmtree(kept)
    (settings.own_dir / FILE).write_text(stones)
    assert rows_with(gateway, patient, MARKER)

    assert apply_erasures(settings) == 1 + 2 + 2
    assert rows_with(gateway, patient, MARKER, "'a'", "'b'") == set()
    assert files_with(tmp_path, MARKER) == set()
    assert apply_erasures(settings) == 0
    assert client.get(f"/v1/patients/{everything}/name").json()["name"] == "Somebody Else"


def test_a_start_applies_the_list_and_refuses_one_that_it_cannot_read(client, gateway, settings, patient, walk):
    walk("a")
    file = settings.own_dir / FILE
    client.post(f"/v1/patients/{patient}/erasure", json=REASON)
    with gateway.database.transaction(EVERYTHING) as database:
        row = dict.fromkeys(("title", "protocol", "estimator", "origin"), "x")
        now = datetime.now(UTC)
        database.add(SessionRow(id="a", clinic_id="main", state="finished", created=now, **row))
    file.write_text(file.read_text() + '{"half a li')
    again = create_app(settings, LiveHub(), None)
    assert rows_with(again.state.gateway, "'a'") == set()
    again.state.gateway.database.close()
    file.write_text("not a tombstone\n" + file.read_text())
    with pytest.raises(DatabaseError, match="line 1"):
        create_app(settings, LiveHub(), None)


def test_without_the_archive_recordings_are_removed_later(client, gateway, settings, control, patient, walk):
    walk("a")
    control.trouble = ControlUnavailable("No archive service answers.")
    answer = client.post(f"/v1/patients/{patient}/erasure", json=REASON)
    assert answer.json() == {"sessions": 1, "recordings_left": 1}
    assert (settings.data_dir / "a").exists()
    assert gateway.eraser.finish() == 1
    control.trouble = None
    assert gateway.eraser.finish() == 0
    assert not (settings.data_dir / "a").exists()


def test_what_still_comes_of_an_erased_session_is_not_kept(client, gateway, made, patient, walk):
    walk("a")
    gateway.keeper._unwritten["a", "start"] = lambda: gateway.keeper._record_start(made.describe("a"))
    client.post(f"/v1/patients/{patient}/erasure", json=REASON)
    gateway.keeper.settle()
    gateway.keeper.appeared(made.describe("a"))
    gateway.keeper.measured("a", made.metrics_at(30.0, final=True))
    assert rows_with(gateway, "'a'") == set()
    assert not gateway.live.is_live("a")


def test_a_file_on_its_way_ends(client, gateway, patient, walk, tmp_path):
    walk("a")
    file = tmp_path / "export"
    file.write_bytes(b"x" * 1_000_000)
    sending = blocks(file.open("rb"), "a", gateway.eraser.outgoing)
    assert next(sending)
    client.post(f"/v1/patients/{patient}/erasure", json=REASON)
    with pytest.raises(Erased):
        next(sending)


def test_what_runs_is_not_erased(client, gateway, made, patient):
    gateway.keeper.appeared(made.describe("a"))
    client.patch("/v1/sessions/a", json={"patient": patient})
    assert client.post(f"/v1/patients/{patient}/erasure", json=REASON).status_code == 409
    assert client.get(f"/v1/patients/{patient}").status_code == 200


def test_the_password_is_asked_for_again(client, gateway, patient):
    from services.gateway.access.tables import SignInRow

    with gateway.database.transaction(EVERYTHING) as database:
        for row in database.scalars(select(SignInRow)):
            row.confirmed = datetime.now(UTC) - timedelta(minutes=6)
    answer = client.post(f"/v1/patients/{patient}/erasure", json=REASON)
    assert (answer.status_code, answer.json()["title"]) == (403, "Confirm your password")
    assert client.get(f"/v1/patients/{patient}").status_code == 200


def test_only_an_administrator_of_the_own_clinic_erases(client, gateway, patient):
    people.sign_in(client, Role.THERAPIST)
    assert client.post(f"/v1/patients/{patient}/erasure", json=REASON).status_code == 403
    guest = people.sign_in(client, Role.ADMIN, "other")
    assert client.post(f"/v1/patients/{patient}/erasure", json=REASON).status_code == 404
    with gateway.database.transaction(EVERYTHING) as database:
        database.add(ShareRow(patient_code=patient, account_id=guest, granted_by=None, granted=datetime.now(UTC)))
    assert client.post(f"/v1/patients/{patient}/erasure", json=REASON).status_code == 403


@pytest.fixture
def housekeeping(gateway, settings):
    return Housekeeping(gateway.eraser, Heads(settings.own_dir), gateway.parameters)


def test_the_bin_is_emptied_when_its_time_is_over(client, gateway, settings, housekeeping, patient, everything):
    client.delete(f"/v1/patients/{patient}")
    now = datetime.now(UTC)
    assert housekeeping.empty_bin(now + timedelta(days=29)) == 0
    assert rows_with(gateway, MARKER)
    client.delete("/v1/sessions/c")
    assert housekeeping.empty_bin(now + timedelta(days=31)) == 2
    assert rows_with(gateway, MARKER, patient, "'a'", "'b'", "'c'") == set()
    assert not any(path.is_dir() for path in settings.data_dir.iterdir())
    with gateway.database.transaction(EVERYTHING) as database:
        entries = audit.entries_from(database, 1, 1000)[-2:]
    assert [(each.actor_kind, each.action, each.reason) for each in entries] == [
        ("housekeeping", "erase_patient", "bin_expired"),
        ("housekeeping", "erase_session", "bin_expired"),
    ]


def test_sessions_are_kept_as_long_as_their_clinic_says(client, gateway, made, housekeeping, patient, walk):
    walk("a")
    walk("b")
    gateway.keeper.appeared(made.describe("running"))
    now = datetime.now(UTC)
    assert housekeeping.keep_no_longer(now + timedelta(days=5000)) == 0
    with gateway.database.transaction(EVERYTHING) as database:
        database.get_one(ClinicRow, "main").keep_days = 365
        database.get_one(SessionRow, "b").created = now + timedelta(days=100)
    assert housekeeping.keep_no_longer(now + timedelta(days=364)) == 0
    assert housekeeping.keep_no_longer(now + timedelta(days=366)) == 1
    left = {each["id"] for each in client.get("/v1/sessions").json()["items"]}
    assert left == {"b", "running"}
    assert client.get(f"/v1/patients/{patient}").status_code == 200


def test_the_audit_is_signed_by_housekeeping(client, housekeeping, patient):
    assert housekeeping.sign_audit()
    assert not housekeeping.sign_audit()
    assert client.get("/v1/audit/verification").json()["signed_entry"] >= 1
