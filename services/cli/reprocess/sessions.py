"""Several sessions one after the other or in several processes, with how far each has come."""

import multiprocessing
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from services.cli.reprocess.recompute import OnProgress, Recomputed, UnderWay, open_archived, recompute
from services.cli.reprocess.storing import DerivedFile, list_files
from services.flow.software import VERSION
from services.recordings.errors import ArchiveError

Told = Callable[[str, float], None]
"""Told of a session by its folder's name how much of it has been computed, 0 to 1."""


@dataclass(frozen=True)
class Outcome:
    """Of one session: the result, or why there is none. `file` is what was stored beside the older ones."""

    session: str
    result: Recomputed | None
    file: str | None = None
    problem: str | None = None
    under_way: bool = False


def work_on(folder: Path, store: bool, on_progress: OnProgress) -> Outcome:
    """Recompute a session and, if wished, store what came out. A bad recording is an outcome, not an exception."""
    try:
        return _work_on(folder, store, on_progress)
    except UnderWay as error:
        return Outcome(folder.name, None, problem=str(error), under_way=True)
    except (ArchiveError, OSError) as error:
        return Outcome(folder.name, None, problem=str(error))


def _work_on(folder: Path, store: bool, on_progress: OnProgress) -> Outcome:
    archived = open_archived(folder)
    if not store or archived.version == VERSION:
        result = recompute(archived, on_progress)
        if store:
            list_files(folder)
        return Outcome(folder.name, result)
    with DerivedFile.begun(folder, archived.recording.description) as draft:
        result = recompute(archived, on_progress, draft.add)
        return Outcome(folder.name, result, draft.finish())


def outcomes(folders: list[Path], jobs: int, store: bool, told: Told) -> Iterator[Outcome]:
    """As they are ready, in this process where one job is enough."""
    if min(jobs, len(folders)) <= 1:
        for folder in folders:
            yield work_on(folder, store, lambda share, name=folder.name: told(name, share))  # type: ignore[misc]
    else:
        yield from _in_processes(folders, jobs, store, told)


_news: Any = None
"""In a process of the pool: where it tells how far it has come."""


def _begin(news: Any) -> None:
    global _news
    _news = news


def _in_process(folder: Path, store: bool) -> Outcome:
    return work_on(folder, store, lambda share: _news.put((folder.name, share)))


def _in_processes(folders: list[Path], jobs: int, store: bool, told: Told) -> Iterator[Outcome]:
    # Spawned, not forked: this process has threads, and a lock they hold would be held for ever in a fork.
    context = multiprocessing.get_context("spawn")
    news = context.SimpleQueue()
    with ProcessPoolExecutor(min(jobs, len(folders)), context, _begin, (news,)) as pool:
        waiting = {pool.submit(_in_process, folder, store): folder for folder in folders}
        try:
            while waiting:
                done, _ = wait(waiting, 0.1, FIRST_COMPLETED)
                while not news.empty():
                    told(*news.get())
                for future in done:
                    yield _outcome(future, waiting.pop(future))
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _outcome(future: Future[Outcome], folder: Path) -> Outcome:
    try:
        return future.result()
    except BrokenProcessPool:
        return Outcome(folder.name, None, problem="its process was killed; is there memory enough? Try --jobs 1")
