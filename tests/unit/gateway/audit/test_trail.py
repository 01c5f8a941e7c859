"""What becomes an entry, and what is in it."""

import multiprocessing
import sqlite3
import threading
from datetime import UTC, datetime

import pytest

from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.audit import records
from services.gateway.audit.chain import Entry
from services.gateway.audit.verification import verify
from services.gateway.database import Database, open_database
from tests.unit.gateway import people

EACH = 40


def entries(gateway):
    with gateway.database.transaction(EVERYTHING) as database:
        return records.entries_from(database, 1, 1000)


def test_creating_says_which_code_and_which_session(client, gateway):
    code = client.post("/v1/patients", json={}).json()["code"]
    session = client.post("/v1/sessions", json={"source": "synthetic:walk", "patient": code}).json()["id"]
    created, started = entries(gateway)
    assert (created.action, created.patient, created.outcome) == ("create_patient", code, 201)
    assert (started.action, started.patient, started.session) == ("start_session", code, session)


def test_reading_again_and_again_is_one_entry(client, gateway):
    for _ in range(5):
        client.get("/v1/patients")
    assert [each.action for each in entries(gateway)] == ["list_patients"]


def test_what_somebody_typed_into_an_address_is_not_kept(client, gateway):
    assert client.get("/v1/patients/Erika%20Mustermann").status_code == 422
    assert client.get("/v1/sessions/a/recordings/Erika%20Mustermann.mcap").status_code == 404
    assert len(entries(gateway)) == 2
    assert "Erika" not in str([records.entry_in(row) for row in entries(gateway)])


def test_reading_the_audit_out_is_in_the_audit(client, gateway):
    client.get("/v1/audit/export?format=fhir")
    (entry,) = entries(gateway)
    assert (entry.action, entry.object) == ("export_audit", "fhir")


def test_administrators_see_what_concerns_their_clinic(client, gateway):
    mine = client.post("/v1/patients", json={}).json()["code"]
    people.sign_in(client, Role.ADMIN, "other")
    client.post("/v1/patients", json={})
    client.get(f"/v1/patients/{mine}")
    theirs = client.get("/v1/audit").json()
    assert {each["clinic"] for each in theirs["items"]} == {"other"}
    people.sign_in(client, Role.ADMIN)
    seen = client.get("/v1/audit").json()
    assert {(each["clinic"], each["action"]) for each in seen["items"]} == {
        ("main", "create_patient"),
        ("other", "read_patient"),
    }
    assert [each["number"] for each in seen["items"]] == sorted(
        (each["number"] for each in seen["items"]), reverse=True
    )


def test_entries_are_chosen_by_day_actor_patient_and_action(client):
    code = client.post("/v1/patients", json={}).json()["code"]
    client.get(f"/v1/patients/{code}")
    actor = client.get("/v1/me").json()["account"]

    def count(query):
        return client.get(f"/v1/audit?{query}").json()["total"]

    today = datetime.now(UTC).date().isoformat()
    assert (count(f"patient={code}"), count("action=read_patient"), count(f"actor={actor}"), count("actor=x")) == (
        2, 1, 2, 0,
    )  # fmt: skip
    assert (count(f"from={today}"), count("from=2099-01-01"), count("to=2020-01-01"), count("to=9999-12-31")) == (
        2, 0, 0, 2,
    )  # fmt: skip


@pytest.mark.parametrize("role", [Role.VIEWER, Role.THERAPIST, Role.SERVICE])
def test_the_audit_is_for_administrators(client, role):
    people.sign_in(client, role)
    for path in ("", "/verification", "/export"):
        assert client.get(f"/v1/audit{path}").status_code == 403


def test_the_database_refuses_to_change_an_entry(client, settings):
    client.get("/v1/patients")
    with sqlite3.connect(settings.database.removeprefix("sqlite:///")) as raw:
        for change in ("UPDATE audit_entry SET outcome = 1", "DELETE FROM audit_entry"):
            with pytest.raises(sqlite3.IntegrityError, match="append-only"):
                raw.execute(change)


def append_some(database: Database, actor: str) -> None:
    for _ in range(EACH):
        entry = Entry(datetime.now(UTC), "person", actor, "admin", "main", "read", None, None, None, 200, None)
        with database.transaction(EVERYTHING) as session:
            records.append(session, entry)


def in_a_process(url: str, actor: str) -> None:
    database = Database(url)
    append_some(database, actor)
    database.close()


def test_several_gateways_append_to_one_chain(tmp_path):
    url = f"sqlite:///{tmp_path}/shared.sqlite"
    database = open_database(url)
    spawn = multiprocessing.get_context("spawn")
    others = [spawn.Process(target=in_a_process, args=(url, name)) for name in ("a", "b")]
    others.append(threading.Thread(target=append_some, args=(database, "c")))
    for other in others:
        other.start()
    append_some(database, "d")
    for other in others:
        other.join(60)
    with database.transaction(EVERYTHING) as session:
        verdict = verify(session, [])
        actors = [row.actor for row in records.entries_from(session, 1, 1000)]
    database.close()
    assert (verdict.entries, verdict.broken) == (4 * EACH, None)
    assert {actor: actors.count(actor) for actor in "abcd"} == dict.fromkeys("abcd", EACH)
