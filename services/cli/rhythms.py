"""Learned rhythms on disk: read from a file, a run's folder or an archived session; handed to the next session."""

from pathlib import Path

from pydantic import ValidationError

from schemas.rhythm import KnownRhythm, LearnedRhythm, RhythmKind
from services.flow.message import DecodeError
from services.recordings.errors import ArchiveError
from services.recordings.reader import open_recording

FILE_NAME = "learned_rhythm.json"
"""Where `ambula run` puts what it learned."""


class NoRhythm(ValueError):
    """There is no learned rhythm where one was looked for; says what to do."""


def read_rhythm(path: Path) -> LearnedRhythm:
    """The learned rhythm of a JSON file, of a folder that `ambula run` wrote, or of an archived session's folder.

    Raises NoRhythm.
    """
    file = path / FILE_NAME if path.is_dir() else path
    if file.exists():
        try:
            return LearnedRhythm.model_validate_json(file.read_bytes())
        except ValidationError as error:
            fault = error.errors(include_url=False, include_context=False, include_input=False)[0]
            where = ".".join(str(part) for part in fault["loc"]) or "file"
            raise NoRhythm(f"{file}: {where}: {fault['msg']}; it must hold one learned rhythm") from error
    if not path.is_dir():
        raise NoRhythm(f"no file or folder {path}; `ambula exemplar SESSION --out FILE` writes one")
    return _from_archive(path)


def _from_archive(folder: Path) -> LearnedRhythm:
    newest: LearnedRhythm | None = None
    try:
        for message in open_recording(folder).messages():
            if isinstance(message.payload, LearnedRhythm):
                newest = message.payload
    except (ArchiveError, DecodeError) as error:
        if newest is None:
            raise NoRhythm(f"{folder}: {error}") from error
    if newest is None:
        raise NoRhythm(f"{folder}: the session learned no rhythm; it takes 3 whole strides in lock")
    return newest


def read_known(paths: dict[RhythmKind, Path | None]) -> list[KnownRhythm] | None:
    """The known rhythms of a start; None when none was given, which leaves a replay what it was recorded with."""
    given = [(kind, path) for kind, path in paths.items() if path is not None]
    if not given:
        return None
    return [KnownRhythm(name=path.stem[:200] or "rhythm", kind=kind, rhythm=read_rhythm(path)) for kind, path in given]
