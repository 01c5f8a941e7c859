"""`ambula reprocess`: archived sessions through today's algorithms."""

import json
import os
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.progress import BarColumn, Progress, TaskID, TaskProgressColumn, TextColumn, TimeRemainingColumn

from services.cli.console import err, out, told

if TYPE_CHECKING:
    from services.cli.reprocess.sessions import Outcome
    from services.cli.reprocess.storing import Index


def reprocess(
    session: Annotated[
        str | None, typer.Argument(help="id of an archived session, or its folder", show_default=False)
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="every session of the data folder")] = False,
    data_dir: Annotated[
        Path | None, typer.Option(help="the archive's folder; default: AMBULA_DATA_DIR, else data", show_default=False)
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="sessions at once, each in a process of its own")] = os.cpu_count()
    or 1,
    store: Annotated[
        bool, typer.Option("--store", help="keep the new result: a file beside the old ones, and on the pages")
    ] = False,
    file: Annotated[Path | None, typer.Option("--json", help="also write what was found to this file")] = None,
) -> None:
    """Compute archived sessions anew and show, metric by metric, what has changed since and which software made each.

    The same software must come to the same numbers to the last bit: then it says identical. Exit code 1 when it does
    not, or when a session cannot be recomputed, which the others do not wait for.
    """
    from services.archive.settings import ArchiveSettings
    from services.gateway.database import DatabaseError
    from services.recordings.folder import session_folders

    data_dir = data_dir or ArchiveSettings().data_dir
    with told(ValueError, OSError, DatabaseError):
        if (session is None) == (not every):
            raise ValueError("give the id of a session or --all")
        folders = session_folders(data_dir) if session is None else [_folder(data_dir, session)]
        if not folders:
            raise ValueError(f"no recorded session in {data_dir}; give the archive's folder with --data-dir")
        try:
            failed = _reprocess(folders, data_dir, jobs, store, file)
        except KeyboardInterrupt:
            err.print("stopped; sessions that are not listed were left as they are")
            raise typer.Exit(130) from None
    raise typer.Exit(failed)


def _folder(data_dir: Path, session: str) -> Path:
    folder = Path(session) if "/" in session or (Path(session) / "manifest.json").exists() else data_dir / session
    if not folder.is_dir():
        raise ValueError(f"no session {session} in {data_dir}; give the archive's folder with --data-dir")
    return folder


def _reprocess(folders: list[Path], data_dir: Path, jobs: int, store: bool, file: Path | None) -> bool:
    """Whether anything went wrong. Raises DatabaseError, OSError."""
    from services.cli.reprocess.sessions import outcomes
    from services.cli.reprocess.shown import as_json, show
    from services.cli.reprocess.storing import Index

    rows: list[dict[str, Any]] = []
    failed = False
    with Index.opened(data_dir) if store else nullcontext() as index, _Bars(folders) as bars:
        for outcome in outcomes(folders, jobs, store, bars.tell):
            bars.tell(outcome.session, 1.0)
            show(outcome, out)
            if index is not None:
                _put(index, outcome)
            rows.append(as_json(outcome))
            failed |= outcome.result.broken if outcome.result is not None else not outcome.under_way
    if file is not None:
        file.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    return failed


def _put(index: "Index", outcome: "Outcome") -> None:
    """On the pages, too; not what contradicts the same software's stored result."""
    result = outcome.result
    if result is None or result.metrics is None or not result.metrics.final or result.broken:
        return
    if not index.replace(result.description, result.metrics):
        out.print("  the pages do not know this session; its result is in its files only")


class _Bars:
    """How far each session has come, and all of them together."""

    def __init__(self, folders: list[Path]) -> None:
        columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
        self._progress = Progress(*columns, console=err, transient=True)
        self._shares = dict.fromkeys((folder.name for folder in folders), 0.0)
        self._overall = self._progress.add_task(f"{len(folders)} sessions", total=len(folders))
        self._bars: dict[str, TaskID] = {}

    def tell(self, session: str, share: float) -> None:
        """So much of a session has been computed, 0 to 1; one that is done is not shown any more."""
        self._shares[session] = share
        self._progress.update(self._overall, completed=sum(self._shares.values()))
        if len(self._shares) == 1:
            return
        if session not in self._bars:
            self._bars[session] = self._progress.add_task(session, total=1.0)
        self._progress.update(self._bars[session], completed=share, visible=share < 1.0)

    def __enter__(self) -> "_Bars":
        self._progress.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._progress.stop()
