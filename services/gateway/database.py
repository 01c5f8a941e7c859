"""The database: SQLite in WAL mode by default, PostgreSQL by URL; brought to the newest schema at start."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from sqlalchemy import Engine, MetaData, create_engine, event, make_url, text
from sqlalchemy.orm import Session, sessionmaker

from services.gateway.access.guard import check_rows
from services.gateway.access.scope import SCOPE, Scope, narrow

MIGRATIONS = Path(__file__).parent / "migrations"


class DatabaseError(RuntimeError):
    """The database cannot be used; says what to do."""


class Database:
    """Engine and session factory. Used from many threads."""

    def __init__(self, url: str) -> None:
        self.engine = _engine(url)
        self._sessions = sessionmaker(self.engine, expire_on_commit=False)
        event.listen(self._sessions, "do_orm_execute", narrow)
        event.listen(self._sessions, "before_flush", check_rows)

    @contextmanager
    def transaction(self, scope: Scope) -> Iterator[Session]:
        """A session in which only what the scope has exists. Commits at the end, rolls back when something is raised.

        Raises OutOfScope when what is written is not the scope's.
        """
        with self._sessions.begin() as session:
            session.info[SCOPE] = scope
            yield session

    def migrate(self, revision: str = "head") -> None:
        """Bring the schema to a revision, up or down. Data survive both ways."""
        config = Config()
        config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
        with self.engine.begin() as connection:
            config.attributes["connection"] = connection
            if revision == "head":
                command.upgrade(config, revision)
            else:
                command.downgrade(config, revision)

    def answers(self) -> bool:
        """Whether a trivial question is answered."""
        try:
            with self.engine.connect() as connection:
                return bool(connection.execute(text("select 1")).scalar() == 1)
        except Exception:  # noqa: BLE001 - the question is exactly whether anything goes wrong
            return False

    def scrub(self) -> None:
        """Leave nothing of what was deleted in the database's files. Raises OperationalError while others write.

        SQLite only: PostgreSQL writes over what was deleted by itself (autovacuum).
        """
        if self.engine.dialect.name == "sqlite":
            with self.engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
                connection.execute(text("VACUUM"))
                connection.execute(text("PRAGMA wal_checkpoint(TRUNCATE)"))

    def close(self) -> None:
        """Close every connection."""
        self.engine.dispose()


def open_database(url: str) -> Database:
    """Connect and bring the schema up to date. Raises DatabaseError with what to do next."""
    address = make_url(url)
    if address.get_backend_name() == "sqlite" and address.database:
        Path(address.database).parent.mkdir(parents=True, exist_ok=True)
    database = Database(url)
    try:
        database.migrate()
    except Exception as error:
        database.close()
        shown = address.render_as_string(hide_password=True)
        raise DatabaseError(f"cannot use the database {shown}: {error}. Check AMBULA_DATABASE.") from error
    return database


def open_apart(url: str, tables: MetaData) -> Database:
    """Connect to a database with a few tables of its own, made when they are not there, for its owner alone."""
    file = make_url(url).database if make_url(url).get_backend_name() == "sqlite" else None
    if file:
        Path(file).parent.mkdir(parents=True, exist_ok=True)
        Path(file).touch(mode=0o600)
    database = Database(url)
    tables.create_all(database.engine)
    return database


def _engine(url: str) -> Engine:
    engine = create_engine(url, pool_pre_ping=True, hide_parameters=True)
    if engine.dialect.name == "sqlite":
        event.listen(engine, "connect", _set_up_sqlite)
    return engine


def _set_up_sqlite(connection: Any, _: object) -> None:
    # FULL: a committed row survives a power cut, which NORMAL does not promise in WAL mode. What is deleted is zeroed.
    pragmas = ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", "busy_timeout=5000", "secure_delete=ON")
    for pragma in pragmas:
        connection.execute(f"PRAGMA {pragma}")
