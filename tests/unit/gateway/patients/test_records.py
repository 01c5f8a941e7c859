"""A record as a whole: two of one person become one, and all of it can be taken away."""

import io
import json
import zipfile
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import select

from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import ShareRow, SignInRow
from services.gateway.audit import records as audit
from services.gateway.exports.sending import Erased, Outgoing
from services.gateway.patients.taking_away import as_json, zipped
from services.gateway.tables import BaselineRow, PatientRow
from tests.unit.gateway import people

TREATMENT = {"date": "2026-11-01", "kind": "botulinum_toxin"}


@pytest.fixture
def register(client):
    def register(**facts):
        return client.post("/v1/patients", json=facts).json()["code"]

    return register


@pytest.fixture
def walk(client, gateway, made, settings):
    def walk(session, code):
        gateway.keeper.appeared(made.describe(session))
        gateway.keeper.measured(session, made.metrics_at(30.0, final=True))
        client.patch(f"/v1/sessions/{session}", json={"patient": code})
        folder = settings.data_dir / session
        folder.mkdir(parents=True)
        (folder / "raw.mcap").write_bytes(b"recorded " + session.encode())

    return walk


def merge(client, code, into):
    return client.post(f"/v1/patients/{code}/merge", json={"into": into, "reason": "registered_twice"})


def add(gateway, *rows):
    with gateway.database.transaction(EVERYTHING) as database:
        database.add_all(rows)


def test_everything_comes_under_the_code_that_stays(client, gateway, register, walk):
    gone, stays = register(sex="female", year_of_birth=1957), register(sex="female", paretic_side="left")
    for session, code in (("a", gone), ("b", gone), ("c", stays)):
        walk(session, code)
    client.delete("/v1/sessions/b")
    client.post(f"/v1/patients/{gone}/treatments", json=TREATMENT)
    client.put(f"/v1/patients/{gone}/name", json={"name": "Erika Mustermann"})
    guest, both = (people.sign_in(client, Role.THERAPIST, "other", login) for login in ("guest", "both"))
    people.sign_in(client, Role.ADMIN)
    now = datetime.now(UTC)
    shared = [(gone, guest), (gone, both), (stays, both)]
    rows = [ShareRow(patient_code=code, account_id=who, granted_by=None, granted=now) for code, who in shared]
    add(gateway, *rows, BaselineRow(patient_code=gone, session_id="a", frozen=now, body={"of": "gone"}))
    assert merge(client, gone, stays).json() == {"patient": stays, "sessions": 2}
    assert client.get(f"/v1/patients/{gone}").status_code == 404
    kept = client.get(f"/v1/patients/{stays}").json()
    assert (kept["year_of_birth"], kept["sex"], kept["paretic_side"], kept["sessions"]) == (1957, "female", "left", 2)
    assert client.get(f"/v1/patients/{stays}/treatments").json()["total"] == 1
    assert client.get(f"/v1/patients/{stays}/name").json()["name"] == "Erika Mustermann"
    assert client.post("/v1/bin/sessions/b/restoration").json()["patient"] == stays
    with gateway.database.transaction(EVERYTHING) as database:
        assert sorted(database.scalars(select(ShareRow.account_id))) == sorted([guest, both])
        assert database.get(BaselineRow, stays).body == {"of": "gone"}
        entries = [each for each in audit.entries_from(database, 1, 100) if each.action == "merge_patient"]
    assert [(each.patient, each.object, each.reason) for each in entries] == [
        (code, f"from={gone} into={stays}", "registered_twice") for code in (gone, stays)
    ]
    assert len(list(gateway.directory.find([gone]))) == 0


def test_what_the_code_that_stays_has_itself_stays(client, gateway, register, walk):
    gone, stays = register(), register()
    walk("a", gone)
    walk("b", stays)
    for code, session in ((gone, "a"), (stays, "b")):
        client.put(f"/v1/patients/{code}/name", json={"name": f"Name of {code}"})
        now = datetime.now(UTC)
        add(gateway, BaselineRow(patient_code=code, session_id=session, frozen=now, body={"of": code}))
    assert merge(client, gone, stays).status_code == 200
    assert client.get(f"/v1/patients/{stays}/name").json()["name"] == f"Name of {stays}"
    with gateway.database.transaction(EVERYTHING) as database:
        assert [row.body for row in database.scalars(select(BaselineRow))] == [{"of": stays}]


def test_two_persons_are_not_joined(client, gateway, made, register):
    one, other, running = register(sex="female"), register(sex="male"), register()
    answer = merge(client, one, other)
    assert (answer.status_code, "differ in sex" in answer.json()["detail"]) == (409, True)
    assert merge(client, one, one).status_code == 409
    assert merge(client, one, "NONE").status_code == 404
    gateway.keeper.appeared(made.describe("a"))
    client.patch("/v1/sessions/a", json={"patient": running})
    assert merge(client, one, running).status_code == 409
    assert merge(client, running, one).status_code == 409
    assert client.get("/v1/patients").json()["total"] == 3


def test_records_are_joined_in_their_own_clinic_and_with_the_password(client, gateway, register):
    mine = register()
    guest = people.sign_in(client, Role.ADMIN, "other")
    theirs = register()
    assert merge(client, mine, theirs).status_code == 404
    add(gateway, ShareRow(patient_code=mine, account_id=guest, granted_by=None, granted=datetime.now(UTC)))
    assert merge(client, mine, theirs).status_code == 403
    assert merge(client, theirs, mine).status_code == 403
    people.sign_in(client, Role.ADMIN)
    second = register()
    with gateway.database.transaction(EVERYTHING) as database:
        for row in database.scalars(select(SignInRow)):
            row.confirmed = datetime.now(UTC) - timedelta(hours=1)
        assert database.get(PatientRow, mine) is not None
    answer = merge(client, second, mine)
    assert (answer.status_code, answer.json()["title"]) == (403, "Confirm your password")


def test_all_that_is_known_can_be_taken_away(client, gateway, register, walk):
    code, other = register(year_of_birth=1957), register()
    walk("a", code)
    walk("b", code)
    walk("c", other)
    client.post(f"/v1/patients/{code}/treatments", json=TREATMENT)
    client.put(f"/v1/patients/{code}/name", json={"name": "Erika MARKER"})
    client.delete("/v1/sessions/b")
    answer = client.get(f"/v1/patients/{code}/export")
    assert answer.headers["content-type"] == "application/zip"
    assert answer.headers["content-disposition"] == f'attachment; filename="ambula-{code}.zip"'
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        assert archive.testzip() is None
        files = {name: archive.read(name) for name in archive.namelist()}
    assert set(files) == {
        "patient.json", "treatments.json", "audit.ndjson", "sessions/a/fhir.json", "sessions/a/raw.mcap",
    }  # fmt: skip
    assert files["sessions/a/raw.mcap"] == b"recorded a"
    assert json.loads(files["patient.json"])["year_of_birth"] == 1957
    assert json.loads(files["treatments.json"]) == [TREATMENT]
    assert json.loads(files["sessions/a/fhir.json"])["resourceType"] == "Bundle"
    lines = [json.loads(line) for line in files["audit.ndjson"].splitlines()]
    assert {each["patient"] for each in lines} == {code}
    assert lines[-1]["action"] == "export_patient"
    assert b"MARKER" not in b"".join(files.values())


def test_only_who_works_with_the_patient_takes_it_away(client, register):
    code = register()
    people.sign_in(client, Role.VIEWER)
    assert client.get(f"/v1/patients/{code}/export").status_code == 403
    people.sign_in(client, Role.ADMIN, "other")
    assert client.get(f"/v1/patients/{code}/export").status_code == 404


def test_an_archive_of_what_is_erased_meanwhile_ends():
    outgoing = Outgoing()
    sending = zipped([("one", None, as_json(1)), ("two", "a", as_json(2))], outgoing)
    assert next(sending)
    outgoing.stop(["a"])
    with pytest.raises(Erased):
        list(sending)
