from datetime import UTC, datetime, timedelta, timezone

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import inspect, text

from services.gateway.access.scope import EVERYTHING, Scope
from services.gateway.database import Database, DatabaseError, open_database
from services.gateway.patients.models import PatientIn
from services.gateway.patients.records import add_patient
from services.gateway.sessions import records
from services.gateway.settings import GatewaySettings
from services.gateway.tables import Base, PatientRow


@pytest.fixture
def database(tmp_path):
    database = open_database(f"sqlite:///{tmp_path}/folder/that/is/new/gateway.sqlite")
    yield database
    database.close()


def test_migrations_lead_to_the_mapped_tables(database):
    with database.engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Base.metadata) == []


def test_down_and_up_again(database):
    database.migrate("base")
    assert inspect(database.engine).get_table_names() == ["alembic_version"]
    database.migrate()
    assert {"patient", "session", "session_metrics"} < set(inspect(database.engine).get_table_names())


def test_migrating_again_keeps_the_data(database, made):
    with database.transaction(Scope("main")) as session:
        add_patient(session, PatientIn(year_of_birth=1957))
        records.record_start(session, made.describe("a"), "main")
        session.flush()
        records.record_metrics(session, "a", made.metrics_at(5.0, final=True))
    database.migrate()
    with database.transaction(EVERYTHING) as session:
        assert records.get_session(session, "a").metrics.final


def test_sessions_from_before_tasks_were_walks(database, made):
    with database.transaction(EVERYTHING) as session:
        records.record_start(session, made.describe("a"), "main")
    database.migrate("0002")
    database.migrate()
    with database.transaction(EVERYTHING) as session:
        row = records.get_session(session, "a")
        assert (row.task, row.walkway_m, row.calibration) == ("walk", None, None)


def test_commits_survive_a_power_cut_and_readers_do_not_wait(database):
    with database.engine.connect() as connection:
        pragmas = {
            name: connection.execute(text(f"PRAGMA {name}")).scalar() for name in ("journal_mode", "synchronous")
        }
    assert pragmas == {"journal_mode": "wal", "synchronous": 2}


def test_a_transaction_that_fails_leaves_nothing(database):
    def fail():
        with database.transaction(Scope("main")) as session:
            add_patient(session, PatientIn())
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    with database.transaction(EVERYTHING) as session:
        assert session.query(PatientRow).count() == 0


def test_times_come_back_in_utc(database):
    there = datetime(2026, 11, 22, 10, 0, tzinfo=timezone(timedelta(hours=5)))
    with database.transaction(EVERYTHING) as session:
        session.add(PatientRow(clinic_id="main", code="A", year_of_birth=None, created=there))
    with database.transaction(EVERYTHING) as session:
        stored = session.get(PatientRow, "A").created
    assert stored == there
    assert stored.tzinfo is UTC


def test_a_database_that_cannot_be_used_says_what_to_do(tmp_path):
    (tmp_path / "no.sqlite").write_bytes(b"this is not a database at all" * 100)
    with pytest.raises(DatabaseError, match="AMBULA_DATABASE"):
        open_database(f"sqlite:///{tmp_path}/no.sqlite")


def test_passwords_are_not_shown(tmp_path):
    with pytest.raises(DatabaseError) as raised:
        open_database("postgresql+psycopg://ambula:secret@127.0.0.1:1/ambula")
    assert "secret" not in str(raised.value)


def test_answers_tells_whether_it_does(tmp_path):
    database = Database(f"sqlite:///{tmp_path}/gateway.sqlite")
    assert database.answers()
    database.close()
    missing = Database(f"sqlite:///{tmp_path}/no/such/folder.sqlite")
    assert not missing.answers()
    missing.close()


@pytest.mark.parametrize(
    ("given", "used"),
    [
        ("", "sqlite:///data/ambula.sqlite"),
        ("postgresql://u@h/d", "postgresql+psycopg://u@h/d"),
        ("postgresql+psycopg://u@h/d", "postgresql+psycopg://u@h/d"),
    ],
)
def test_the_address_of_the_database(given, used, monkeypatch):
    monkeypatch.delenv("AMBULA_DATABASE", raising=False)
    monkeypatch.delenv("AMBULA_DATA_DIR", raising=False)
    assert GatewaySettings(database=given).database_url == used


def test_the_database_s_password_comes_from_a_file_where_its_address_has_none(tmp_path):
    secret = tmp_path / "password"
    secret.write_text("p@ss/word\n")
    settings = GatewaySettings(database="postgresql://ambula@host/db", database_password_file=secret)
    assert settings.database_url == "postgresql+psycopg://ambula:p%40ss%2Fword@host/db"
