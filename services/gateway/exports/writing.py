"""One export at a time: so its memory is bounded, and live views keep their share of the machine."""

import tempfile
import threading
from collections.abc import Iterator
from http import HTTPStatus
from typing import IO

from services.exports.errors import ExportError
from services.exports.formats import Options, write
from services.exports.recorded import RecordedSession
from services.gateway.exports.recording import Recorded
from services.gateway.exports.sending import Outgoing
from services.gateway.problems import Problem
from services.recordings.errors import ArchiveError

_BLOCK = 1 << 18


class Busy(Problem):
    """Somebody else's file comes first."""

    retry_after_s = 10


_busy = threading.Lock()


def written(of: Recorded, name: str, options: Options) -> IO[bytes]:
    """The file, written and rewound; it is gone from the disk when it is closed.

    Raises Problem: another one is being written (503), or this one cannot be (409, 503).
    """
    if not _busy.acquire(blocking=False):
        raise Busy(
            HTTPStatus.SERVICE_UNAVAILABLE,
            "Another file is being written just now.",
            "Try again in some seconds; a session of an hour takes about a minute.",
        )
    try:
        return _written(of, name, options)
    finally:
        _busy.release()


def _written(of: Recorded, name: str, options: Options) -> IO[bytes]:
    file: IO[bytes] = tempfile.TemporaryFile(prefix="ambula-export-")  # noqa: SIM115  closed by whoever sends it
    try:
        write(name, RecordedSession(of.folder, of.version), file, options)  # type: ignore[arg-type]
    except BaseException as error:
        file.close()
        raise _problem(error) or error from error
    file.seek(0)
    return file


def _problem(error: BaseException) -> Problem | None:
    match error:
        case ExportError():
            return Problem(HTTPStatus.CONFLICT, f"{error.field}: {error.what}.", f"Do this: {error.next_step}.")
        case ArchiveError():
            return Problem(HTTPStatus.CONFLICT, str(error), "Restore the recording from a backup, then export again.")
        case OSError():
            why = f"The file could not be written: {error.strerror}."
            return Problem(HTTPStatus.SERVICE_UNAVAILABLE, why, "Make room where temporary files go, then try again.")
    return None


def blocks(file: IO[bytes], session: str, outgoing: Outgoing) -> Iterator[bytes]:
    """The file in parts; closed at the end, or when nobody wants more. Raises Erased when the session is meanwhile."""
    with file:
        while block := file.read(_BLOCK):
            outgoing.check(session)
            yield block
