"""Names in their own database, apart from everything that was measured."""

import threading
from collections.abc import Iterable, Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path

from sqlalchemy import Engine, LargeBinary, String, delete, event, func, make_url, select, text
from sqlalchemy.orm import DeclarativeBase, Mapped, Session, mapped_column

from services.gateway.database import new_engine
from services.gateway.directory.cipher import Cipher, DirectoryUnusable, Name, make_key, read_key
from services.gateway.tables import UtcTime

ASKED_AT_ONCE = 500


class _Base(DeclarativeBase):
    """Base of the directory's own table."""


class NameRow(_Base):
    """One person, sealed. `place` is a keyed digest of the patient code."""

    __tablename__ = "directory_name"

    place: Mapped[str] = mapped_column(String(64), primary_key=True)
    sealed: Mapped[bytes] = mapped_column(LargeBinary)
    changed: Mapped[datetime] = mapped_column(UtcTime)


class NameDirectory:
    """Used from many threads. Database and key are opened when somebody first asks, the key is made for the first name.

    Every method may raise DirectoryUnusable, or OperationalError when its database does not answer.
    """

    def __init__(self, url: str, key_file: Path) -> None:
        self._url = url
        self._key_file = key_file
        self._engine: Engine | None = None
        self._lock = threading.Lock()

    def place_of(self, code: str) -> str | None:
        """Under what a patient would stand; None while there is no key."""
        secret = read_key(self._key_file)
        return None if secret is None else Cipher(secret).place_of(code)

    def put(self, code: str, name: Name) -> None:
        """Keep a name in place of any other."""
        with self._session() as session:
            cipher = self._cipher(session) or Cipher(self._new_key())
            row = NameRow(place=cipher.place_of(code), sealed=cipher.seal(code, name), changed=datetime.now(UTC))
            session.merge(row)
            session.commit()

    def find(self, codes: Iterable[str]) -> Iterator[tuple[str, Name]]:
        """The names of those that have one."""
        with self._session() as session:
            cipher = self._cipher(session)
            if cipher is None:
                return
            for some in _portions(codes):
                places = {cipher.place_of(code): code for code in some}
                for row in session.scalars(select(NameRow).where(NameRow.place.in_(places))):
                    code = places[row.place]
                    yield code, cipher.open(code, row.sealed)

    def remove(self, places: Sequence[str]) -> int:
        """Forget entries by where they stand, for good; how many there were."""
        removed = 0
        with self._session() as session:
            for some in _portions(places):
                gone = session.execute(delete(NameRow).where(NameRow.place.in_(some)).returning(NameRow.place))
                removed += len(gone.all())
            session.commit()
        return removed

    def scrub(self) -> None:
        """Leave nothing of what was removed in the files of SQLite."""
        engine = self._opened()
        if engine.dialect.name == "sqlite":
            with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
                connection.execute(text("VACUUM"))
                connection.execute(text("PRAGMA wal_checkpoint(TRUNCATE)"))

    def close(self) -> None:
        """Close every connection."""
        if self._engine is not None:
            self._engine.dispose()

    def _session(self) -> Session:
        return Session(self._opened())

    def _opened(self) -> Engine:
        with self._lock:
            if self._engine is None:
                address = make_url(self._url)
                if address.get_backend_name() == "sqlite" and address.database:
                    Path(address.database).parent.mkdir(parents=True, exist_ok=True)
                engine = new_engine(self._url)
                if engine.dialect.name == "sqlite":
                    event.listen(engine, "connect", lambda *_: _only_for_us(address.database))
                _Base.metadata.create_all(engine)
                self._engine = engine
            return self._engine

    def _cipher(self, session: Session) -> Cipher | None:
        secret = read_key(self._key_file)
        if secret is None and session.scalar(select(func.count()).select_from(NameRow)):
            raise DirectoryUnusable("The key of the directory is gone; restore its file from a backup.")
        return None if secret is None else Cipher(secret)

    def _new_key(self) -> bytes:
        with self._lock:
            return read_key(self._key_file) or make_key(self._key_file)


def _portions(items: Iterable[str]) -> Iterator[tuple[str, ...]]:
    left = list(items)
    for start in range(0, len(left), ASKED_AT_ONCE):
        yield tuple(left[start : start + ASKED_AT_ONCE])


def _only_for_us(file: str | None) -> None:
    if file and Path(file).exists():
        Path(file).chmod(0o600)
