"""`ambula export`: files for other programs, of an archived session or of any source."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, Progress, TaskID, TextColumn

from schemas.archive_layout import folder_name
from services.cli.console import err, out, told
from services.exports.errors import ExportError
from services.exports.formats import FORMATS, Options, file_name, format_of, why_not, write
from services.exports.opensim.models import RANGES, OpenSimModel, known_model, model_from_file
from services.exports.recorded import RecordedSession
from services.exports.session import HeldSession, Session


def export(
    session: Annotated[
        str,
        typer.Argument(
            metavar="SESSION", help="id or folder of an archived session, or any source that `ambula run` takes"
        ),
    ],
    folder: Annotated[Path, typer.Option("--out", help="folder for the files; made when it is missing")],
    formats: Annotated[
        list[str] | None,
        typer.Option("--format", help=f"may be repeated; of {', '.join(FORMATS)}; default: all that can be had"),
    ] = None,
    model: Annotated[
        str, typer.Option(help=f"OpenSim model of .mot and .sto: {', '.join(RANGES)}, or an .osim file")
    ] = next(iter(RANGES)),
) -> None:
    """Write a session as CSV tables, C3D, OpenSim files or a recording for Foxglove."""
    from services.ingest.errors import SourceError
    from services.recordings.errors import ArchiveError

    with told(ExportError, SourceError, ArchiveError, OSError), _progress() as bar:
        options = Options(_model(model))
        for name in formats or ():
            format_of(name)
        found = _session(session, bar)
        for name in formats or FORMATS:
            reason = None if formats else why_not(name, found.signals, found.description.estimator)
            if reason is not None:
                _leave_out(name, reason)
                continue
            try:
                _write(found, name, folder, options, bar)
            except ExportError as error:
                if formats:
                    raise
                _leave_out(name, str(error))


def _leave_out(name: str, reason: str) -> None:
    err.print(f"{name}: not written; {reason}", highlight=False)


def _write(session: Session, name: str, folder: Path, options: Options, bar: "Bar") -> None:
    """One file, whole or not at all. Raises ExportError, OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / file_name(session.description.session, name)
    part = path.with_name(f"{path.name}.part")
    bar.begin(name)
    try:
        with part.open("wb") as file:
            size = write(name, session, file, options)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)
    out.print(f"written: {path}, {size} bytes", soft_wrap=True, highlight=False)


def _model(name: str) -> OpenSimModel:
    """By name, or from a file. Raises ExportError, OSError."""
    path = Path(name)
    if path.suffix.lower() == ".osim":
        return model_from_file(path.name, path.read_text(encoding="utf-8", errors="replace"))
    return known_model(name)


def _session(name: str, bar: "Bar") -> Session:
    """Raises SourceError, ArchiveError, OSError."""
    for folder in _folders(name):
        if folder.is_dir() and any(folder.glob("*.mcap*")):
            recorded = RecordedSession(folder, told=bar.at)
            bar.total(recorded.description.duration_s)
            return recorded
    return _computed(name, bar)


def _folders(name: str) -> Iterator[Path]:
    from services.archive.settings import ArchiveSettings

    yield Path(name)
    try:
        yield ArchiveSettings().data_dir / folder_name(name)
    except ValueError:
        return


def _computed(spec: str, bar: "Bar") -> HeldSession:
    """A source through the nodes, its results held in memory. Raises SourceError."""
    from services.cli.assembly import build_chain
    from services.ingest.choices import AS_THE_SOURCE_SAYS
    from services.ingest.source import iter_messages, open_chosen

    source = open_chosen(spec, AS_THE_SOURCE_SAYS)
    description = source.describe()
    chain = build_chain(description)
    bar.begin("computing")
    bar.total(description.duration_s)
    payloads = []
    for message in iter_messages(source):
        for produced in chain.push(message):
            if produced.payload is not None and produced.stream.signal.archived == "derived":
                payloads.append((produced.stream.signal, produced.payload))
        bar.at(message.envelope.captured_ns * 1e-9)
    return HeldSession(description, payloads)


class Bar:
    """How far reading has come, in seconds of the session."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._task: TaskID | None = None
        self._total: float | None = None

    def total(self, seconds: float | None) -> None:
        """How long the session is."""
        self._total = seconds
        if self._task is not None:
            self._progress.update(self._task, total=seconds)

    def begin(self, name: str) -> None:
        """Something else is done now."""
        if self._task is not None:
            self._progress.remove_task(self._task)
        self._task = self._progress.add_task(name, total=self._total, at="")

    def at(self, seconds: float) -> None:
        """Reading has come there."""
        if self._task is not None:
            self._progress.update(self._task, completed=seconds, at=f"{seconds:.1f} s")


@contextmanager
def _progress() -> Iterator[Bar]:
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[at]}"))
    with Progress(*columns, console=err, transient=True) as progress:
        yield Bar(progress)
