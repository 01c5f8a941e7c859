"""Whatever is done to the audit behind the gateway's back is told, with its place."""

import itertools
import json
import sqlite3
from datetime import UTC, datetime, timedelta

import pytest
from fhir.resources.R4B.bundle import Bundle

from services.gateway.access.scope import EVERYTHING
from services.gateway.audit import records
from services.gateway.audit.heads import HEADS_FILE, KEY_FILE, Heads, HeadsUnusable
from services.gateway.audit.tables import AuditHeadRow

NOW = datetime(2026, 11, 22, 9, tzinfo=UTC)


@pytest.fixture
def entered(client):
    """Six entries."""
    for _ in range(6):
        client.post("/v1/patients", json={})
    return client


@pytest.fixture
def tamper(settings):
    """Somebody with the database's file in hand."""

    def change(statement, *values):
        with sqlite3.connect(settings.database.removeprefix("sqlite:///")) as raw:
            for trigger in ("audit_no_update", "audit_no_delete"):
                raw.execute(f"DROP TRIGGER IF EXISTS {trigger}")
            raw.execute(statement, values)
        raw.close()

    return change


def verdict(client):
    answer = client.get("/v1/audit/verification").json()
    return answer["intact"], answer["entries"], answer["broken_entry"], answer["fault"]


def sign(gateway, settings, at=NOW):
    with gateway.database.transaction(EVERYTHING) as database:
        head = database.get_one(AuditHeadRow, records.HEAD)
        return Heads(settings.own_dir).sign_if_due(head.number, head.digest, at)


def test_an_untouched_chain_is_whole(entered):
    assert verdict(entered) == (True, 6, None, None)


FIELDS = {
    "at": "2020-01-01 00:00:00.000000", "actor_kind": "machine", "actor": "x", "role": "viewer", "clinic": "other",
    "action": "x", "patient": "X", "session": "x", "object": "x", "outcome": 500, "reason": "x", "digest": "0" * 64,
    "previous": "0" * 64,
}  # fmt: skip


def test_one_changed_field_is_told(entered, tamper, gateway):
    with gateway.database.engine.connect() as connection:
        before = connection.exec_driver_sql("SELECT * FROM audit_entry WHERE number = 3").mappings().one()
    assert set(FIELDS) | {"number"} == set(before)
    for field, value in FIELDS.items():
        tamper(f"UPDATE audit_entry SET {field} = ? WHERE number = 3", value)
        intact, entries, broken, fault = verdict(entered)
        assert (intact, entries, broken) == (False, 2, 3), field
        assert fault
        tamper(f"UPDATE audit_entry SET {field} = ? WHERE number = 3", before[field])
    assert verdict(entered) == (True, 6, None, None)


def test_a_field_that_is_no_value_of_its_kind_is_told(entered, tamper):
    tamper("UPDATE audit_entry SET at = 'yesterday' WHERE number = 5")
    assert verdict(entered)[2:] == (5, "a field is no value of its kind")


def test_a_removed_entry_is_told(entered, tamper):
    tamper("DELETE FROM audit_entry WHERE number = 4")
    assert verdict(entered) == (False, 3, 4, "the entry is missing")


def test_a_cut_end_is_told(entered, tamper):
    tamper("DELETE FROM audit_entry WHERE number > 4")
    assert verdict(entered) == (False, 4, 5, "the chain does not end where its head says")


def test_a_cut_end_is_told_by_the_signature_when_the_head_was_moved_too(entered, tamper, gateway, settings):
    sign(gateway, settings)
    tamper("UPDATE audit_head SET number = 4, digest = (SELECT digest FROM audit_entry WHERE number = 4)")
    tamper("DELETE FROM audit_entry WHERE number > 4")
    assert verdict(entered) == (False, 4, 5, "the end is missing: 6 entries had been signed")


def test_a_chain_written_anew_is_told_by_the_signature(entered, tamper, gateway, settings):
    sign(gateway, settings)
    with gateway.database.transaction(EVERYTHING) as database:
        old = [records.entry_in(row) for row in records.entries_from(database, 1, 100)]
    tamper("DELETE FROM audit_entry")
    tamper("UPDATE audit_head SET number = 0, digest = ?", "0" * 64)
    with gateway.database.transaction(EVERYTHING) as database:
        for entry in [*old[:-1], old[0]]:
            records.append(database, entry)
    assert verdict(entered)[2:] == (6, "the chain was written anew: its digest is not the one that was signed")


def test_heads_are_signed_once_a_day_and_hold_after_more_entries(entered, gateway, settings):
    assert sign(gateway, settings).number == 6
    entered.post("/v1/patients", json={})
    assert sign(gateway, settings, NOW + timedelta(hours=23)) is None
    assert sign(gateway, settings, NOW + timedelta(hours=25)).number == 7
    assert (settings.own_dir / KEY_FILE).stat().st_mode & 0o777 == 0o600
    answer = entered.get("/v1/audit/verification").json()
    assert (answer["intact"], answer["signed_entry"]) == (True, 7)


def test_a_changed_signature_or_a_lost_key_is_told(entered, gateway, settings):
    sign(gateway, settings)
    file = settings.own_dir / HEADS_FILE
    file.write_text(file.read_text().replace('"number":6', '"number":5'))
    assert "line 1 of audit-heads.ndjson is not as it was signed" in verdict(entered)[3]
    (settings.own_dir / KEY_FILE).unlink()
    intact, *_, fault = verdict(entered)
    assert (intact, "audit.key is gone" in fault) == (False, True)
    with pytest.raises(HeadsUnusable):
        sign(gateway, settings, NOW + timedelta(days=3))


def test_an_empty_audit_is_not_signed(settings, gateway):
    assert sign(gateway, settings) is None
    assert not (settings.own_dir / KEY_FILE).exists()


def test_lines_can_be_verified_by_anybody(entered, gateway, settings):
    sign(gateway, settings)
    lines = [json.loads(line) for line in entered.get("/v1/audit/export").text.splitlines()]
    *entries, last = lines
    assert [each["number"] for each in entries] == [1, 2, 3, 4, 5, 6, 7]
    assert entries[-1]["action"] == "export_audit"
    assert all(after["previous"] == before["digest"] for before, after in itertools.pairwise(entries))
    assert last["head"]["digest"] == entries[5]["digest"]


def test_entries_as_fhir(entered):
    entered.get("/v1/patients/NONE")
    made = entered.get("/v1/audit/export?format=fhir")
    assert made.headers["content-type"] == "application/fhir+json"
    Bundle.model_validate(made.json())
    events = [each["resource"] for each in made.json()["entry"]]
    assert [(event["action"], event["outcome"]) for event in events] == [("C", "0")] * 6 + [("R", "4"), ("R", "0")]
    assert {event["agent"][0]["who"]["identifier"]["value"] for event in events} == {
        entered.get("/v1/me").json()["account"]
    }


def test_an_export_without_entries_is_a_bundle_too(client):
    Bundle.model_validate(client.get("/v1/audit/export?format=fhir&to=2020-01-01").json())
