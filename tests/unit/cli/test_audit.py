"""`ambula audit` on the database of the settings."""

import json
import sqlite3
from datetime import UTC, datetime

import pytest
from fhir.resources.R4B.bundle import Bundle
from typer.testing import CliRunner

from services.cli.__main__ import app
from services.gateway.access.scope import EVERYTHING
from services.gateway.audit import records
from services.gateway.audit.chain import Entry
from services.gateway.audit.heads import Heads
from services.gateway.database import open_database


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A data folder with three entries, the second of them signed."""
    monkeypatch.setenv("AMBULA_DATA_DIR", str(tmp_path))
    monkeypatch.delenv("AMBULA_DATABASE", raising=False)
    monkeypatch.setenv("COLUMNS", "200")
    database = open_database(f"sqlite:///{tmp_path}/ambula.sqlite")
    now = datetime.now(UTC)
    for number in (1, 2, 3):
        entry = Entry(now, "person", "a", "admin", "main", "read_patient", f"K{number}", None, None, 200, None)
        with database.transaction(EVERYTHING) as session:
            row = records.append(session, entry)
            digest = row.digest
        if number == 2:
            Heads(tmp_path).sign_if_due(2, digest, now)
    database.close()
    return tmp_path


def run(*arguments):
    return CliRunner().invoke(app, ["audit", *arguments])


def tamper(folder, *statements):
    with sqlite3.connect(folder / "ambula.sqlite") as raw:
        for statement in ("DROP TRIGGER audit_no_update", "DROP TRIGGER audit_no_delete", *statements):
            raw.execute(statement)
    raw.close()


def test_a_whole_audit(folder):
    told = run("verify")
    assert (told.exit_code, told.output) == (0, "the audit is whole: 3 entries, signed up to entry 2\n")


@pytest.mark.parametrize(
    ("statements", "says"),
    [
        (["UPDATE audit_entry SET patient = 'X' WHERE number = 2"], "entry 2: the entry was changed"),
        (["DELETE FROM audit_entry WHERE number = 1"], "entry 1: the entry is missing"),
        (
            [
                "DELETE FROM audit_entry WHERE number > 1",
                "UPDATE audit_head SET number = 1, digest = (SELECT digest FROM audit_entry)",
            ],
            "entry 2: the end is missing: 2 entries had been signed",
        ),
    ],
)
def test_the_first_entry_that_is_not_as_it_was_is_named(folder, statements, says):
    tamper(folder, *statements)
    told = run("verify")
    assert told.exit_code == 1
    assert says in told.output


def test_entries_are_written_to_a_file(folder, tmp_path):
    lines, events = tmp_path / "audit.ndjson", tmp_path / "audit.json"
    assert run("export", "--out", str(lines)).exit_code == 0
    found = [json.loads(line) for line in lines.read_text().splitlines()]
    assert [each["patient"] for each in found[:-1]] == ["K1", "K2", "K3"]
    assert found[-1]["head"]["number"] == 2
    assert run("export", "--format", "fhir", "--out", str(events)).exit_code == 0
    assert len(Bundle.model_validate_json(events.read_text()).entry) == 3
    assert run("export", "--out", str(lines)).exit_code == 1
    assert run("export", "--format", "csv", "--out", str(tmp_path / "x")).exit_code == 1


def test_without_a_database_it_says_what_to_do(tmp_path, monkeypatch):
    monkeypatch.setenv("AMBULA_DATA_DIR", str(tmp_path / "none"))
    monkeypatch.delenv("AMBULA_DATABASE", raising=False)
    told = run("verify")
    assert (told.exit_code, "AMBULA_DATA_DIR" in told.output) == (1, True)
    assert not (tmp_path / "none").exists()
