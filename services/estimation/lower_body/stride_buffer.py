"""The last seconds of some channels, kept until a rhythm is found in them."""

import numpy as np
from numpy.typing import NDArray

from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

Entry = tuple[float, Array, Flags]
"""s since the entry before, values (2, n), and which were heard (n,)."""


class StrideBuffer:
    """A sample every so often, over so many seconds."""

    def __init__(self, channels: int, seconds: float, every_s: float) -> None:
        self._channels = channels
        self._every_s = every_s
        self._most = round(seconds / every_s)
        self._entries: list[Entry] = []
        self._waited_s = 0.0

    def add(self, dt_s: float, values: Array, heard: Flags) -> None:
        """Take the values at dt_s after those before."""
        self._waited_s += dt_s
        if self._waited_s < self._every_s - 1e-4 and self._entries:
            return
        self._entries.append((self._waited_s, values.copy(), heard.copy()))
        self._waited_s = 0.0
        del self._entries[: -self._most]

    def take(self, seconds: float) -> list[tuple[float, float, Array, Flags]]:
        """Empty the buffer: what is not older than so many seconds, oldest first; age, then the entry."""
        taken, age_s = [], self._waited_s
        for since_s, values, heard in reversed(self._entries):
            if age_s > seconds:
                break
            taken.append((age_s, since_s, values, heard))
            age_s += since_s
        self._entries.clear()
        self._waited_s = 0.0
        return taken[::-1]

    def snapshot(self) -> State:
        """What is kept."""
        return {
            "waited_s": self._waited_s,
            "since_s": [since_s for since_s, _, _ in self._entries],
            "values": pack_array(np.array([values for _, values, _ in self._entries]).reshape(-1, 2, self._channels)),
            "heard": ["".join("01"[int(flag)] for flag in heard) for _, _, heard in self._entries],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._waited_s = state["waited_s"]
        heard = [np.array([flag == "1" for flag in flags], dtype=np.bool_) for flags in state["heard"]]
        values = unpack_array(state["values"])
        self._entries = list(zip(state["since_s"], values, heard, strict=True))
