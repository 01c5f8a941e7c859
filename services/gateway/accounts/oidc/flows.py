"""Browsers that are on their way to a sign-in service and back. In memory: a restart has them begin again."""

import hmac
import secrets
import threading
import time
from collections import OrderedDict
from dataclasses import dataclass, field

LONGEST_S = 600.0
"""s that somebody may take to sign in there."""

MOST = 1000


def _random() -> str:
    return secrets.token_urlsafe(32)


@dataclass(frozen=True, slots=True)
class Flow:
    """One browser on its way. `browser`: what its cookie holds, so that no other browser can come back in its place."""

    provider: str
    again: bool
    began: float
    state: str = field(default_factory=_random)
    browser: str = field(default_factory=_random)
    nonce: str = field(default_factory=_random)
    verifier: str = field(default_factory=_random)


class Flows:
    """Used from many threads."""

    def __init__(self) -> None:
        self._flows: OrderedDict[str, Flow] = OrderedDict()
        self._lock = threading.Lock()

    def begin(self, provider: str, *, again: bool) -> Flow:
        """A browser leaves. When too many are under way, the one that left first has to begin again."""
        flow = Flow(provider, again, time.monotonic())
        with self._lock:
            self._flows[flow.state] = flow
            if len(self._flows) > MOST:
                self._flows.popitem(last=False)
        return flow

    def take(self, provider: str, state: str, browser: str) -> Flow | None:
        """A browser comes back, which it can do once; None when it did not leave, took too long or is another one."""
        with self._lock:
            flow = self._flows.pop(state, None)
        if flow is None or flow.provider != provider or time.monotonic() - flow.began > LONGEST_S:
            return None
        return flow if hmac.compare_digest(flow.browser.encode(), browser.encode()) else None
