"""What a service does before it works: on a thread, so that it can say so each second and be told to stop."""

import logging
import threading
import time
from collections.abc import Callable, Sequence

from schemas.health import Readiness
from services.bus.connection import Bus
from services.bus.health import HealthReporter
from services.bus.logs import event

LOOK_S = 0.05

logger = logging.getLogger(__name__)


def prepare(bus: Bus, steps: Sequence[Callable[[], None]], stop: threading.Event) -> bool:
    """Take the steps in order while health says `compiling`; False when stopped before. Raises what a step raised.

    The service holds no token meanwhile: nobody waits for it to take part in a session.
    """
    raised: list[BaseException] = []

    def work() -> None:
        try:
            for step in steps:
                step()
        except BaseException as error:  # noqa: BLE001 - handed to whoever waits
            raised.append(error)

    began = time.monotonic()
    reporter = HealthReporter(bus, readiness=Readiness.COMPILING)
    thread = threading.Thread(target=work, name="preparation", daemon=True)
    thread.start()
    while thread.is_alive() and not stop.is_set():
        thread.join(LOOK_S)
    reporter.close()
    if raised:
        raise raised[0]
    logger.info(event("prepared", took_s=round(time.monotonic() - began, 1)))
    return not stop.is_set()
