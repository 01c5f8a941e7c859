"""Copies of databases while they are used: SQLite by its own backup, PostgreSQL by its own programs."""

import os
import shutil
import sqlite3
import subprocess
from contextlib import closing
from pathlib import Path

from sqlalchemy import URL, create_engine, inspect, make_url, text

from services.cli.backup.contents import BackupError

WAIT_S = 30.0
TAILS = ("", "-wal", "-shm", "-journal")
"""Files that belong to one SQLite database."""


def is_sqlite(url: str) -> bool:
    """Whether the database is a file of ours."""
    return make_url(url).get_backend_name() == "sqlite"


def sqlite_file(url: str) -> Path:
    """The file behind a SQLite URL."""
    return Path(make_url(url).database or "")


def copy(url: str, target: Path) -> None:
    """A consistent copy, as of one moment, at `target`. Raises BackupError."""
    if is_sqlite(url):
        _copy_sqlite(sqlite_file(url), target)
    else:
        _run_postgres("pg_dump", make_url(url), "--format=custom", "--no-owner", "--no-privileges", f"--file={target}")


def put_back(copied: Path, url: str) -> None:
    """Make the database at the URL, which must be empty, that of the copy. Raises BackupError."""
    if is_sqlite(url):
        file = sqlite_file(url)
        file.parent.mkdir(parents=True, exist_ok=True)
        _copy_sqlite(copied, file)
    else:
        options = ("--no-owner", "--no-privileges", "--single-transaction", "--exit-on-error")
        _run_postgres("pg_restore", make_url(url), *options, str(copied))


def is_empty(url: str) -> bool:
    """Whether there is nothing in the database yet."""
    if is_sqlite(url):
        file = sqlite_file(url)
        return not file.exists() or file.stat().st_size == 0
    engine = create_engine(url)
    try:
        return not inspect(engine).get_table_names()
    finally:
        engine.dispose()


def clear(url: str, kept: Path) -> None:
    """Move what is in the database out of the way, to `kept`. Raises BackupError."""
    if is_sqlite(url):
        file = sqlite_file(url)
        for tail in TAILS:
            part = file.with_name(file.name + tail)
            if part.exists():
                shutil.move(part, kept / part.name)
        return
    copy(url, kept / "database.dump")
    engine = create_engine(url)
    try:
        with engine.begin() as connection:
            connection.execute(text("DROP SCHEMA public CASCADE"))
            connection.execute(text("CREATE SCHEMA public"))
    finally:
        engine.dispose()


def sessions_in(url: str) -> set[str]:
    """Ids of all sessions that the database knows."""
    engine = create_engine(url)
    try:
        with engine.connect() as connection:
            return set(connection.scalars(text("SELECT id FROM session")))
    finally:
        engine.dispose()


def _copy_sqlite(source: Path, target: Path) -> None:
    if not source.exists():
        raise BackupError(f"there is no database at {source}; check AMBULA_DATABASE and AMBULA_DATA_DIR")
    os.close(os.open(target, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
    try:
        with (
            closing(sqlite3.connect(f"file:{source}?mode=ro", uri=True, timeout=WAIT_S)) as original,
            closing(sqlite3.connect(target)) as copied,
        ):
            # All pages at once: one moment of the original, whatever others write meanwhile.
            original.backup(copied)
            copied.execute("PRAGMA journal_mode=DELETE")
            (verdict,) = copied.execute("PRAGMA integrity_check").fetchone()
    except sqlite3.Error as error:
        raise BackupError(f"{source} cannot be copied: {error}") from error
    if verdict != "ok":
        raise BackupError(f"{source} is damaged ({verdict}); restore the last backup that is whole")


def _run_postgres(program: str, url: URL, *options: str) -> None:
    found = shutil.which(program)
    if found is None:
        raise BackupError(
            f"{program} is not on this machine: install PostgreSQL's client programs of the server's version, or run "
            "the command where they are, with the same settings"
        )
    known = URL.create("postgresql", url.username, None, url.host, url.port, url.database, url.query)
    address = known.render_as_string(hide_password=False)
    # The password goes by the environment: every user of the machine can read the arguments of a process.
    environment = {**os.environ, "PGPASSWORD": url.password or os.environ.get("PGPASSWORD", "")}
    done = subprocess.run(
        [found, "--no-password", f"--dbname={address}", *options],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise BackupError(f"{program} failed: {done.stderr.strip()[-500:]}")
