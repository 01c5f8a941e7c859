"""A backup made beside a running gateway, put back elsewhere: nothing is lost, nothing altered goes unnoticed."""

import hashlib
import json
import sqlite3
from contextlib import closing
from datetime import UTC, datetime

import pytest

from schemas.archive_layout import MANIFEST_FILE, Manifest, RecordingState, SegmentEntry
from services.archive.lock import DataFolderLock, DataFolderUnusable
from services.bus.settings import BusSettings
from services.cli.backup import databases
from services.cli.backup.contents import BackupError, Contents, KeptFile, read_contents
from services.cli.backup.making import make_backup
from services.cli.backup.restoring import restore
from services.cli.backup.running import running_services
from services.gateway.access.scope import EVERYTHING
from services.gateway.database import open_database
from services.gateway.settings import GatewaySettings
from services.gateway.tables import PatientRow, SessionRow


def silent(_what, _done, _total):
    """Nobody looks at the bar."""


@pytest.fixture
def site(tmp_path):
    """Settings of a site with a patient of one session, whose database is open elsewhere."""
    settings = GatewaySettings(data_dir=tmp_path / "site", database="", http_port=0)
    database = open_database(settings.database_url)
    with database.transaction(EVERYTHING) as records:
        now = datetime.now(UTC)
        records.add(PatientRow(code="K7QM3F", clinic_id="main", created=now))
        records.flush()
        records.add(
            SessionRow(
                id="s1", clinic_id="main", patient_code="K7QM3F", title="Walk", protocol="walk", state="finished",
                created=now, estimator="ekf", origin="synthetic",
            )
        )  # fmt: skip
    record(settings, "s1")
    yield settings
    database.close()


def record(settings, session, body=b"\x89MCAP0\r\n raw bytes"):
    folder = settings.data_dir / session
    folder.mkdir(parents=True)
    (folder / "raw.mcap").write_bytes(body)
    (folder / "raw_001.mcap.part").write_bytes(b"open")
    (folder / "checkpoint-estimation.json").write_text("{}")
    entry = SegmentEntry(
        name="raw.mcap",
        size_bytes=len(body),
        sha256=hashlib.sha256(body).hexdigest(),
        messages=1,
        streams=[],
        damage=None,
    )
    manifest = Manifest(
        session=session, title="Walk", protocol="walk", origin="synthetic", estimator="ekf", started_unix_ns=0,
        duration_s=1.0, state=RecordingState.FINISHED, state_reason=None, derived_version="0.1.0", files=[entry],
    )  # fmt: skip
    (folder / MANIFEST_FILE).write_text(manifest.model_dump_json())


def elsewhere(tmp_path, name="new"):
    return GatewaySettings(data_dir=tmp_path / name, database="", http_port=0)


def backed_up(site, tmp_path, **options):
    return make_backup(tmp_path / "backup", site, **({"names": False, "tell": silent} | options))


def sessions_of(settings):
    database = open_database(settings.database_url)
    try:
        with database.transaction(EVERYTHING) as records:
            return {row.id: row.patient_code for row in records.query(SessionRow)}
    finally:
        database.close()


def test_a_backup_put_back_elsewhere_is_the_site_as_it_was(site, tmp_path):
    (site.own_dir / "audit.key").write_text("key")
    (site.own_dir / "first-run-code").write_text("CODE")
    backed_up(site, tmp_path)
    new = elsewhere(tmp_path)
    assert restore(tmp_path / "backup", new, replace=False, tell=silent) is None
    assert sessions_of(new) == {"s1": "K7QM3F"}
    folder = new.data_dir / "s1"
    assert sorted(path.name for path in folder.iterdir()) == ["manifest.json", "raw.mcap"]
    assert (folder / "raw.mcap").read_bytes() == (site.data_dir / "s1" / "raw.mcap").read_bytes()
    assert (new.own_dir / "audit.key").stat().st_mode & 0o777 == 0o600
    assert not (new.own_dir / "first-run-code").exists()


def test_only_the_owner_reads_a_backup(site, tmp_path):
    backed_up(site, tmp_path)
    assert (tmp_path / "backup").stat().st_mode & 0o077 == 0
    for path in (tmp_path / "backup").rglob("*.sqlite"):
        assert path.stat().st_mode & 0o077 == 0


def test_the_second_backup_copies_what_is_new(site, tmp_path):
    assert backed_up(site, tmp_path).copied_bytes > 0
    assert backed_up(site, tmp_path).copied_bytes == 0
    record(site, "s2", b"\x89MCAP0\r\n others")
    made = backed_up(site, tmp_path)
    assert 0 < made.copied_bytes < 1500
    assert {file.path.split("/")[1] for file in made.contents.of("recordings")} == {"s1", "s2"}
    assert len(list((tmp_path / "backup" / "database").iterdir())) == 1


def test_what_was_erased_goes_and_what_is_missing_stays(site, tmp_path):
    record(site, "gone")
    backed_up(site, tmp_path)
    for name in ("s1", "gone"):
        for path in (site.data_dir / name).iterdir():
            path.unlink()
        (site.data_dir / name).rmdir()
    made = backed_up(site, tmp_path)
    assert made.forgotten == ["gone"], "the database still knows s1, so its recording got lost"
    assert sorted(path.name for path in (tmp_path / "backup" / "recordings").iterdir()) == ["s1"]
    new = elsewhere(tmp_path)
    restore(tmp_path / "backup", new, replace=False, tell=silent)
    assert (new.data_dir / "s1" / "raw.mcap").exists()


def test_names_only_when_asked(site, tmp_path):
    with closing(sqlite3.connect(site.own_dir / "directory.sqlite")) as names:
        names.execute("CREATE TABLE entry (code TEXT)")
    site.directory_key.write_bytes(b"k" * 32)
    assert not backed_up(site, tmp_path).contents.of("directory")
    assert not list((tmp_path / "backup").rglob("directory*"))
    backed_up(site, tmp_path, names=True)
    new = elsewhere(tmp_path)
    restore(tmp_path / "backup", new, replace=False, tell=silent)
    assert new.directory_key.read_bytes() == b"k" * 32
    assert new.directory_key.stat().st_mode & 0o077 == 0
    with closing(sqlite3.connect(new.own_dir / "directory.sqlite")) as names:
        assert names.execute("SELECT count(*) FROM entry").fetchone() == (0,)
    new.directory_key.write_bytes(b"other")
    aside = restore(tmp_path / "backup", new, replace=True, tell=silent)
    assert (aside / "directory.key").read_bytes() == b"other", "names aside can still be opened"
    assert new.directory_key.read_bytes() == b"k" * 32


@pytest.mark.parametrize("harm", ["altered", "missing", "cut"])
def test_a_damaged_backup_restores_nothing(site, tmp_path, harm):
    backed_up(site, tmp_path)
    path = tmp_path / "backup" / "recordings" / "s1" / "raw.mcap"
    match harm:
        case "altered":
            path.write_bytes(path.read_bytes()[:-1] + b"x")
        case "missing":
            path.unlink()
        case "cut":
            path.write_bytes(b"")
    new = elsewhere(tmp_path)
    with pytest.raises(BackupError, match=r"nothing was restored: recordings/s1/raw\.mcap"):
        restore(tmp_path / "backup", new, replace=False, tell=silent)
    assert not new.data_dir.exists()


def test_what_is_there_is_neither_overwritten_nor_deleted(site, tmp_path):
    backed_up(site, tmp_path)
    (site.own_dir / "erasures.jsonl").write_text('{"session": "x"}\n')
    record(site, "later")
    with pytest.raises(BackupError, match=r"2 recorded sessions.*--replace"):
        restore(tmp_path / "backup", site, replace=False, tell=silent)
    aside = restore(tmp_path / "backup", site, replace=True, tell=silent)
    assert (aside / "later" / "raw.mcap").exists()
    assert (aside / "ambula.sqlite").exists()
    assert sorted(path.name for path in site.data_dir.iterdir() if (path / MANIFEST_FILE).exists()) == ["s1"]
    assert sessions_of(site) == {"s1": "K7QM3F"}
    assert (site.own_dir / "erasures.jsonl").read_text() == '{"session": "x"}\n', "an erasure outlives an older backup"


def test_erasures_of_backup_and_site_are_joined(site, tmp_path):
    (site.own_dir / "erasures.jsonl").write_text('{"session": "a"}\n{"session": "b"}\n')
    backed_up(site, tmp_path)
    new = elsewhere(tmp_path)
    new.data_dir.mkdir()
    (new.own_dir / "erasures.jsonl").write_text('{"session": "b"}\n{"session": "c"}\n')
    restore(tmp_path / "backup", new, replace=False, tell=silent)
    lines = (new.own_dir / "erasures.jsonl").read_text().splitlines()
    assert [json.loads(line)["session"] for line in lines] == ["a", "b", "c"]


def test_folders_that_are_no_backup_are_told_apart(site, tmp_path):
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "cat.jpg").write_bytes(b"x")
    with pytest.raises(BackupError, match="something else"):
        make_backup(tmp_path / "photos", site, names=False, tell=silent)
    with pytest.raises(BackupError, match="no backup"):
        restore(tmp_path / "photos", elsewhere(tmp_path), replace=False, tell=silent)
    (tmp_path / "photos" / "backup.json").write_text("{}")
    with pytest.raises(BackupError, match="cannot be read"):
        read_contents(tmp_path / "photos")


@pytest.mark.parametrize("path", ["../x/y", "database/../../x", "/etc/passwd", "other/x", "database"])
def test_a_list_cannot_name_a_place_outside(path):
    with pytest.raises(ValueError, match="one of its folders"):
        KeptFile(path=path, size_bytes=0, sha256="", changed_ns=0)


def test_a_backup_of_a_newer_version_is_refused(site, tmp_path):
    backed_up(site, tmp_path)
    file = tmp_path / "backup" / "backup.json"
    newer = read_contents(tmp_path / "backup").model_copy(update={"revision": "9999", "software": "9.0"})
    file.write_text(newer.model_dump_json())
    with pytest.raises(BackupError, match=r"newer version \(9\.0\)"):
        restore(tmp_path / "backup", elsewhere(tmp_path), replace=False, tell=silent)


def test_a_database_without_tables_or_none_is_not_backed_up(tmp_path):
    empty = elsewhere(tmp_path)
    empty.data_dir.mkdir()
    (empty.data_dir / "ambula.sqlite").touch()
    with pytest.raises(BackupError, match="start the gateway once"):
        make_backup(tmp_path / "backup", empty, names=False, tell=silent)


def test_the_copy_is_of_one_moment_while_others_write(site, tmp_path):
    with closing(sqlite3.connect(site.data_dir / "ambula.sqlite")) as writer:
        writer.execute("BEGIN IMMEDIATE")
        writer.execute("UPDATE session SET title = 'half'")
        backed_up(site, tmp_path)
        writer.rollback()
    (copy,) = (tmp_path / "backup" / "database").iterdir()
    with closing(sqlite3.connect(copy)) as copied:
        assert copied.execute("SELECT title FROM session").fetchall() == [("Walk",)]


def test_while_an_archive_records_nothing_is_restored(site, tmp_path):
    nobody = BusSettings(router="tcp/127.0.0.1:1")
    backed_up(site, tmp_path)
    new = elsewhere(tmp_path)
    with DataFolderLock(new.data_dir):
        assert running_services(new, nobody) == ["archive"]
        with pytest.raises(DataFolderUnusable):
            restore(tmp_path / "backup", new, replace=False, tell=silent)
    assert running_services(new, nobody) == []


PG = "postgresql+psycopg://ambula:Zx8uvWxYz@database:5433/site"


def test_postgresql_is_copied_by_its_own_programs_and_the_password_is_in_no_argument(tmp_path, monkeypatch):
    said = tmp_path / "said"
    program = tmp_path / "pg_dump"
    program.write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" "$PGPASSWORD" > {said}\n')
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    databases.copy(PG, tmp_path / "copy.dump")
    *arguments, password = said.read_text().splitlines()
    assert password == "Zx8uvWxYz"
    assert "--dbname=postgresql://ambula@database:5433/site" in arguments
    assert f"--file={tmp_path}/copy.dump" in arguments
    program.write_text("#!/bin/sh\necho no route >&2\nexit 1\n")
    with pytest.raises(BackupError, match="pg_dump failed: no route"):
        databases.copy(PG, tmp_path / "copy.dump")
    program.unlink()
    with pytest.raises(BackupError, match="install PostgreSQL's client programs"):
        databases.copy(PG, tmp_path / "copy.dump")


def test_a_list_says_what_it_holds(site, tmp_path):
    made = backed_up(site, tmp_path).contents
    assert Contents.model_validate_json((tmp_path / "backup" / "backup.json").read_text()) == made
    assert (made.database, made.names, len(made.of("database"))) == ("sqlite", False, 1)
