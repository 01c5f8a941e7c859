"""Each session is started once, however often its order comes: an answer may get lost, and is then asked for again."""

import threading
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future

from schemas.session import SessionDescription
from services.ingest.orders import InvalidOrder, StartOrder

MOST_REMEMBERED = 256
"""Sessions whose order is known even after they have ended: a quick replay may be over before it is asked for again."""


class Starts:
    """Orders by the session id that the caller chose. Used from the bus's threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._known: OrderedDict[str, tuple[StartOrder, Future[SessionDescription]]] = OrderedDict()

    def once(self, order: StartOrder, start: Callable[[], SessionDescription]) -> SessionDescription:
        """What `start` made of this order the first time; an order that comes meanwhile waits for it.

        Raises what `start` raised (then the order may be given again), or InvalidOrder when the session was started
        by another order.
        """
        if order.session is None:
            return start()
        made: Future[SessionDescription] = Future()
        with self._lock:
            known = self._known.get(order.session)
            if known is None:
                self._known[order.session] = (order, made)
        if known is not None:
            if known[0] != order:
                raise InvalidOrder(
                    f"session {order.session} runs already, or has run, by another order; choose another id"
                )
            return known[1].result()
        try:
            made.set_result(start())
        except BaseException as error:
            with self._lock:
                del self._known[order.session]
            made.set_exception(error)
            raise
        self._forget_oldest()
        return made.result()

    def _forget_oldest(self) -> None:
        with self._lock:
            while len(self._known) > MOST_REMEMBERED:
                self._known.popitem(last=False)
