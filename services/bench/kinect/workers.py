"""Several processes, each with one trial at a time."""

import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from typing import Any

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
Spread = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
"""Like `map`: a function over pieces of work, results in their order."""


@contextmanager
def workers(processes: int) -> Iterator[Spread]:
    """A `map` over so many processes, or over this one if that is 1. What is not begun when an error or Ctrl-C comes is
    dropped, and no process outlives the block.

    Raises:
        ValueError: fewer than one process.
    """
    if processes < 1:
        raise ValueError(f"the work needs at least one process, not {processes}")
    if processes == 1:
        yield map
        return
    with _one_thread_each():
        pool = ProcessPoolExecutor(processes, mp_context=get_context("spawn"), initializer=_leave_interrupts)
        try:
            yield pool.map
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Matrices of 87 rows on as many threads as there are cores, in every process, take eight times as long."""
    missing = [name for name in THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(missing, "1"))
    try:
        yield
    finally:
        for name in missing:
            os.environ.pop(name, None)


def _leave_interrupts() -> None:
    """Ctrl-C reaches the whole group; the process that started it all decides."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
