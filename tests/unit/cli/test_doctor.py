"""The doctor names what is wrong and what to do about it, and changes nothing."""

import hashlib
import socket
import sqlite3
import threading
from contextlib import closing, suppress
from datetime import UTC, datetime, timedelta

import pytest
import uvicorn
from sqlalchemy import text

from services.archive.lock import DataFolderLock
from services.cli.doctor import stack, stored
from services.cli.doctor.clock import LOOK_S, examine_clock, is_steered
from services.cli.doctor.examine import examine
from services.gateway.access.scope import EVERYTHING
from services.gateway.accounts.first_run import code_file, write_code
from services.gateway.audit.chain import Entry
from services.gateway.audit.records import append
from services.gateway.database import open_database
from services.gateway.revisions import newest
from services.gateway.settings import GatewaySettings
from tests.unit.cli.test_backup import record


@pytest.fixture
def settings(tmp_path):
    return GatewaySettings(data_dir=tmp_path / "site", database="", http_port=0)


@pytest.fixture
def database(settings):
    database = open_database(settings.database_url)
    yield database
    database.close()


def test_a_database_at_the_code_s_schema_is_right(settings, database):
    assert stored.examine_schema(settings).ok is True
    assert newest() in stored.examine_schema(settings).says


def test_no_database_is_no_fault_and_none_is_made(settings):
    assert stored.examine_schema(settings).ok is None
    assert not settings.data_dir.exists()


def test_an_older_schema_is_brought_up_to_date_and_a_newer_one_refused(settings, database):
    database.migrate("0004")
    finding = stored.examine_schema(settings)
    assert (finding.ok, "make a backup, then start" in finding.says) == (None, True)
    with database.engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    finding = stored.examine_schema(settings)
    assert (finding.ok, "newer version" in finding.says) == (False, True)


def test_a_database_that_cannot_be_read_is_said_without_its_password(tmp_path):
    away = "postgresql+psycopg://ambula:Zx8uvWxYz@127.0.0.1:1/ambula"
    finding = stored.examine_schema(GatewaySettings(data_dir=tmp_path, database=away))
    assert finding.ok is False
    assert "AMBULA_DATABASE" in finding.says
    assert "Zx8" not in finding.says


def entry(action):
    return Entry(datetime.now(UTC), "person", "a", "admin", "main", action, None, None, None, 200, None)


def test_the_audit_is_walked(settings, database):
    for action in ("one", "two", "three"):
        with database.transaction(EVERYTHING) as records:
            append(records, entry(action))
    assert stored.examine_audit(settings).says.startswith("3 entries, chain whole")
    with closing(sqlite3.connect(settings.data_dir / "ambula.sqlite")) as file, file:
        for (name,) in file.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
            file.execute(f"DROP TRIGGER {name}")
        file.execute("UPDATE audit_entry SET action = 'else' WHERE number = 2")
    finding = stored.examine_audit(settings)
    assert finding.ok is False
    assert "broken at entry 2" in finding.says


def test_recordings_are_compared_by_size_and_deep_by_checksum(settings):
    record(settings, "s1")
    folder = settings.data_dir / "s1"
    (folder / "raw_001.mcap.part").unlink()
    assert stored.examine_archive(settings.data_dir, deep=False).ok is True
    raw = folder / "raw.mcap"
    raw.write_bytes(raw.read_bytes()[:-1] + b"x")
    assert stored.examine_archive(settings.data_dir, deep=False).ok is True
    assert "altered" in stored.examine_archive(settings.data_dir, deep=True).says
    raw.write_bytes(b"short")
    assert "another size" in stored.examine_archive(settings.data_dir, deep=False).says
    raw.unlink()
    assert "missing; restore it from a backup" in stored.examine_archive(settings.data_dir, deep=False).says
    (folder / "manifest.json").unlink()
    (folder / "raw.mcap").write_bytes(b"x")
    assert "1 of 1 sessions were not closed" in stored.examine_archive(settings.data_dir, deep=False).says


def test_an_open_file_is_worth_a_word_only_when_nobody_records(settings):
    record(settings, "s1")
    finding = stored.examine_archive(settings.data_dir, deep=False)
    assert (finding.ok, "not closed; start the archive" in finding.says) == (None, True)
    with DataFolderLock(settings.data_dir):
        assert stored.examine_archive(settings.data_dir, deep=False).ok is True


def test_an_open_first_run_is_said(settings):
    assert stored.examine_first_run(settings).ok is True
    write_code(settings.own_dir)
    assert "open" in stored.examine_first_run(settings).says
    code_file(settings.own_dir).chmod(0o644)
    assert "chmod 600" in stored.examine_first_run(settings).says


def test_the_directory_s_key_is_its_owner_s_alone(settings):
    (finding,) = stored.examine_keys(settings)
    assert finding.ok is True
    settings.own_dir.mkdir()
    settings.directory_key.write_bytes(b"k")
    settings.directory_key.chmod(0o600)
    assert next(iter(stored.examine_keys(settings))).ok is True
    settings.directory_key.chmod(0o640)
    assert "chmod 600" in next(iter(stored.examine_keys(settings))).says


@pytest.mark.parametrize(
    ("days", "ok", "word"), [(60, True, "days left"), (5, None, "renew it"), (-1, False, "expired")]
)
def test_the_certificate_s_days_are_counted(settings, make_pair, days, ok, word):
    certificate, key = make_pair(days=days)
    finding = stored.examine_certificate(settings.model_copy(update={"http_certificate": certificate, "http_key": key}))
    assert (finding.ok, word in finding.says) == (ok, True)
    assert "clinic.example" in finding.says


def test_without_a_certificate_it_matters_who_can_reach_the_page(settings):
    assert stored.examine_certificate(settings).ok is True
    open_to_all = settings.model_copy(update={"http_host": "0.0.0.0"})
    assert "AMBULA_HTTP_CERTIFICATE" in stored.examine_certificate(open_to_all).says


def clocks(walls, monotonics=(100.0, 100.0 + LOOK_S), steered=True):
    wall, monotonic = iter(walls), iter(monotonics)
    return examine_clock(lambda: next(wall), lambda: next(monotonic), lambda _s: None, lambda: steered)


def test_clocks():
    now = datetime(2026, 11, 23, tzinfo=UTC).timestamp()
    even = (now, now + LOOK_S)
    assert clocks(even).ok is True
    assert "switch NTP on" in clocks(even, steered=False).says
    assert clocks(even, steered=None).ok is None
    assert "jumped by +30.00 s" in clocks((now, now + LOOK_S + 30)).says
    assert "cannot be; set it" in clocks((now - timedelta(days=20_000).total_seconds(), now)).says
    assert is_steered() in (True, False, None)


def test_a_port_is_free_or_ours_or_taken(settings, database):
    with closing(socket.create_server(("127.0.0.1", 0))) as listener:
        port = listener.getsockname()[1]
        taken = settings.model_copy(update={"http_port": port})

        def hang_up():
            with suppress(OSError):
                while True:
                    listener.accept()[0].close()

        thread = threading.Thread(target=hang_up, daemon=True)
        thread.start()
        assert "taken by another program" in stack.page_port(taken).says
        assert "another in AMBULA_ROUTER" in stack.router_port(f"tcp/127.0.0.1:{port}").says
        listener.shutdown(socket.SHUT_RDWR)
        thread.join(10.0)
    assert stack.page_port(taken).says == f"{port} is free"
    assert stack.router_port(f"tcp/127.0.0.1:{port}").ok is None
    foreign = settings.model_copy(update={"http_host": "192.0.2.1"})
    assert "cannot be had" in stack.page_port(foreign).says


def test_our_gateway_is_known_by_its_answer(settings):
    async def app(scope, receive, send):
        if scope["type"] == "http":
            await send({"type": "http.response.start", "status": 200, "headers": []})
            await send({"type": "http.response.body", "body": b'{"first_run": true}'})

    server = uvicorn.Server(uvicorn.Config(app, port=0, lifespan="off", log_config=None))
    thread = threading.Thread(target=server.run)
    thread.start()
    while not server.started:
        assert thread.is_alive()
    port = server.servers[0].sockets[0].getsockname()[1]
    try:
        assert "the gateway answers" in stack.page_port(settings.model_copy(update={"http_port": port})).says
    finally:
        server.should_exit = True
        thread.join(20.0)


def test_every_line_says_something_and_nothing_is_changed(settings, database, monkeypatch):
    for name, value in {"DATA_DIR": settings.data_dir, "ROUTER": "tcp/127.0.0.1:1", "HTTP_PORT": "0"}.items():
        monkeypatch.setenv(f"AMBULA_{name}", str(value))
    before = hashlib.sha256((settings.data_dir / "ambula.sqlite").read_bytes()).hexdigest()
    found = {finding.subject: finding for finding in examine(deep=True)}
    assert {
        "Python",
        "Disk",
        "Clock",
        "Database",
        "Audit",
        "Archive",
        "First run",
        "Certificate",
        "Router",
        "Port",
    } <= set(found)
    assert all(finding.says for finding in found.values())
    assert hashlib.sha256((settings.data_dir / "ambula.sqlite").read_bytes()).hexdigest() == before


def test_settings_that_cannot_be_read_are_a_finding(monkeypatch):
    monkeypatch.setenv("AMBULA_HTTP_CERTIFICATE", "x.pem")
    findings = list(examine())
    assert findings[-1].subject == "Settings"
    assert "set both or none" in findings[-1].says
