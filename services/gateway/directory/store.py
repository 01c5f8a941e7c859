"""Names in their own database, apart from everything that was measured."""

import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from sqlalchemy import LargeBinary, String, delete, func, select
from sqlalchemy.orm import DeclarativeBase, Mapped, Session, mapped_column

from services.gateway.access.scope import EVERYTHING
from services.gateway.database import Database, open_apart
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
        self._database: Database | None = None
        self._lock = threading.Lock()

    def place_of(self, code: str) -> str | None:
        """Under what a patient would stand; None while there is no key."""
        secret = read_key(self._key_file)
        return None if secret is None else Cipher(secret).place_of(code)

    def put(self, code: str, name: Name) -> None:
        """Keep a name in place of any other."""
        with self._names() as names:
            cipher = self._cipher(names) or Cipher(self._new_key())
            row = NameRow(place=cipher.place_of(code), sealed=cipher.seal(code, name), changed=datetime.now(UTC))
            names.merge(row)

    def find(self, codes: Iterable[str]) -> Iterator[tuple[str, Name]]:
        """The names of those that have one."""
        with self._names() as names:
            cipher = self._cipher(names)
            if cipher is None:
                return
            for some in _portions(codes):
                places = {cipher.place_of(code): code for code in some}
                for row in names.scalars(select(NameRow).where(NameRow.place.in_(places))):
                    code = places[row.place]
                    yield code, cipher.open(code, row.sealed)

    def remove(self, places: Iterable[str]) -> int:
        """Forget entries by where they stand; how many there were."""
        with self._names() as names:
            removed = 0
            for some in _portions(places):
                gone = names.execute(delete(NameRow).where(NameRow.place.in_(some)).returning(NameRow.place))
                removed += len(gone.all())
            return removed

    def scrub(self) -> None:
        """Leave nothing of what was removed in the files of SQLite."""
        self._opened().scrub()

    def close(self) -> None:
        """Close every connection."""
        if self._database is not None:
            self._database.close()

    @contextmanager
    def _names(self) -> Iterator[Session]:
        with self._opened().transaction(EVERYTHING) as names:
            yield names

    def _opened(self) -> Database:
        with self._lock:
            if self._database is None:
                self._database = open_apart(self._url, _Base.metadata)
            return self._database

    def _cipher(self, names: Session) -> Cipher | None:
        secret = read_key(self._key_file)
        if secret is None and names.scalar(select(func.count()).select_from(NameRow)):
            raise DirectoryUnusable("The key of the directory is gone; restore its file from a backup.")
        return None if secret is None else Cipher(secret)

    def _new_key(self) -> bytes:
        with self._lock:
            return read_key(self._key_file) or make_key(self._key_file)


def _portions(items: Iterable[str]) -> Iterator[Sequence[str]]:
    left = list(items)
    for start in range(0, len(left), ASKED_AT_ONCE):
        yield left[start : start + ASKED_AT_ONCE]
