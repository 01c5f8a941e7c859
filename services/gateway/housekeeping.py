"""What the gateway does by itself now and then, one job after the other, off the event loop."""

import asyncio
import logging
from collections.abc import Callable, Mapping

from starlette.concurrency import run_in_threadpool

from services.bus.logs import event

log = logging.getLogger(__name__)

EVERY_S = 600.0


async def keep_house(jobs: Mapping[str, Callable[[], object]], every_s: float = EVERY_S) -> None:
    """Do the jobs every so often until cancelled; one that fails is logged and done again next time."""
    while True:
        await asyncio.sleep(every_s)
        for name, job in jobs.items():
            try:
                await run_in_threadpool(job)
            except Exception:
                log.exception(event("housekeeping_failed", job=name))
