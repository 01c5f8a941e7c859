"""The recording of a session that is over, opened for a few seconds of it."""

from collections.abc import Iterator
from contextlib import contextmanager
from http import HTTPStatus

from services.flow.message import DecodeError
from services.gateway.context import Gateway
from services.gateway.exports.recording import RUNS, recorded
from services.gateway.problems import Problem
from services.recordings.errors import ArchiveError, NotARecording
from services.recordings.ranges import NotClosed, RecordedRanges


@contextmanager
def opened(gateway: Gateway, session: str) -> Iterator[RecordedRanges]:
    """With the version of the results that pages show.

    Raises Problem: unknown or not recorded (404); it still runs, is being closed, or is damaged (409).
    """
    of = recorded(gateway, session)
    if of.trouble == RUNS:
        step = f"Watch it with /v1/live/{session}, or stop it and ask again."
        raise Problem(HTTPStatus.CONFLICT, f"Session {session} still runs.", step)
    try:
        yield RecordedRanges(of.folder, of.version)
    except NotClosed as error:
        step = "Ask again in some seconds; if it stays so, see the System page whether the archive runs."
        raise Problem(HTTPStatus.CONFLICT, f"The recording of session {session} is being closed.", step) from error
    except (NotARecording, FileNotFoundError) as error:
        step = "Its numbers and its report are kept; what was not recorded cannot be replayed."
        raise Problem(HTTPStatus.NOT_FOUND, f"The archive holds no recording of session {session}.", step) from error
    except (ArchiveError, DecodeError) as error:
        step = "Restore the recording from a backup, then ask again."
        raise Problem(HTTPStatus.CONFLICT, f"The recording of session {session} is damaged: {error}", step) from error
