"""Everything that is known of one patient as one archive file, written while it is sent."""

import io
import json
import zipfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from services.gateway.exports.sending import Outgoing

BLOCK = 1 << 18


class _Outlet(io.RawIOBase):
    """Takes what the archive writes and hands it on; cannot be wound back, so nothing is kept."""

    def __init__(self) -> None:
        super().__init__()
        self._waiting: list[bytes] = []

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        self._waiting.append(bytes(data))
        return len(data)

    def take(self) -> bytes:
        taken, self._waiting = b"".join(self._waiting), []
        return taken


Part = tuple[str, str | None, Path | Callable[[], Iterator[bytes]]]
"""Name in the archive, session that it is of, and what is in it."""


def zipped(parts: Sequence[Part], outgoing: Outgoing) -> Iterator[bytes]:
    """A zip file. Recordings are compressed already, so nothing is compressed again.

    Raises Erased as soon as a session in it is erased: the connection then ends before the file does.
    """
    outlet = _Outlet()
    with zipfile.ZipFile(outlet, "w", zipfile.ZIP_STORED) as archive:
        for name, session, content in parts:
            with archive.open(zipfile.ZipInfo(name), "w", force_zip64=True) as entry:
                for block in _blocks(content):
                    if session is not None:
                        outgoing.check(session)
                    entry.write(block)
                    yield outlet.take()
    yield outlet.take()


def as_json(value: Any) -> Callable[[], Iterator[bytes]]:
    """Content that is known already."""
    return lambda: iter([json.dumps(value, ensure_ascii=False, indent=1).encode() + b"\n"])


def _blocks(content: Path | Callable[[], Iterator[bytes]]) -> Iterator[bytes]:
    if not isinstance(content, Path):
        yield from content()
        return
    with content.open("rb") as file:
        while block := file.read(BLOCK):
            yield block
