"""Ticks become instants at which every sensor has a sample: measured, interpolated, or known to be missing.

A knee needs both its sensors at one time. A sensor of another hub, or one whose sample was lost, is interpolated
linearly between its samples before and after, so the instant waits for the later one; a sensor that stays silent for
longer than `silent_after_s` is not interpolated and no longer waited for. Captured times alone decide.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.estimation.samples import SILENT, Tick, Values
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]


class Instant(NamedTuple):
    """Rows of `samples` (S, 6) count where `heard`; the other sensors are silent."""

    captured_ns: int
    samples: Array
    heard: tuple[bool, ...]


class _Waiting(NamedTuple):
    """An instant in the making: None where a sensor's next sample is awaited, False where it is silent."""

    captured_ns: int
    rows: list[Values | bool | None]


class CommonInstants:
    """Of S sensors. Without loss and on one hub every tick is an instant, at once and to the bit."""

    def __init__(self, rates_hz: list[float], silent_after_s: float, share: float) -> None:
        """`share`: of the shortest sample interval, that two instants at which not everyone speaks lie apart."""
        self._apart_ns = round(share * 1e9 / max(rates_hz))
        self._silent_ns = round(silent_after_s * 1e9)
        self._last: list[tuple[int, Values] | None] = [None] * len(rates_hz)
        self._waiting: list[_Waiting] = []
        self._newest_ns: int | None = None

    def add(self, tick: Tick) -> list[Instant]:
        """Take the next tick; the instants that are now complete, in order."""
        now_ns, fresh = tick.captured_ns, tick.fresh.tolist()
        rows = tick.samples.tolist()
        if all(fresh) and not self._waiting:
            self._last = [(now_ns, tuple(row)) for row in rows]
            self._newest_ns = now_ns
            return [Instant(now_ns, tick.samples, (True,) * len(rows))]
        for s, row in enumerate(rows):
            if fresh[s]:
                self._hear(s, now_ns, tuple(row))
        if all(fresh) or self._newest_ns is None or now_ns - self._newest_ns >= self._apart_ns:
            self._newest_ns = now_ns
            spoken: list[Values | bool | None] = [tuple(row) if fresh[s] else None for s, row in enumerate(rows)]
            self._waiting.append(_Waiting(now_ns, spoken))
        self._give_up(now_ns)
        return self._complete()

    def finish(self) -> list[Instant]:
        """No more ticks: who is still awaited is silent."""
        for waiting in self._waiting:
            waiting.rows[:] = [False if row is None else row for row in waiting.rows]
        return self._complete()

    def _hear(self, s: int, now_ns: int, values: Values) -> None:
        """Interpolate a sensor's instants since its last sample, unless it was silent for too long."""
        last = self._last[s]
        closes = last is not None and now_ns - last[0] <= self._silent_ns
        for waiting in self._waiting:
            if waiting.rows[s] is None:
                waiting.rows[s] = _between(last, (now_ns, values), waiting.captured_ns) if closes and last else False
        self._last[s] = (now_ns, values)

    def _give_up(self, now_ns: int) -> None:
        """Sensors that have been silent for too long, or never spoke, are not waited for."""
        for s, last in enumerate(self._last):
            if last is None or now_ns - last[0] > self._silent_ns:
                for waiting in self._waiting:
                    if waiting.rows[s] is None:
                        waiting.rows[s] = False

    def _complete(self) -> list[Instant]:
        instants: list[Instant] = []
        while self._waiting and None not in self._waiting[0].rows:
            captured_ns, rows = self._waiting.pop(0)
            heard = tuple(not isinstance(row, bool) for row in rows)
            values = [SILENT if isinstance(row, bool) or row is None else row for row in rows]
            instants.append(Instant(captured_ns, np.array(values), heard))
        return instants

    def snapshot(self) -> State:
        """The last samples, and the instants that wait."""
        return {
            "newest_ns": self._newest_ns,
            "last_ns": [None if last is None else last[0] for last in self._last],
            "last": pack_array(np.array([SILENT if last is None else last[1] for last in self._last])),
            "waiting_ns": [waiting.captured_ns for waiting in self._waiting],
            "spoken": [[_word(row) for row in waiting.rows] for waiting in self._waiting],
            "rows": pack_array(
                np.array([[SILENT if isinstance(r, bool) or r is None else r for r in w.rows] for w in self._waiting])
            ),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._newest_ns = state["newest_ns"]
        rows = unpack_array(state["last"]).tolist()
        self._last = [None if ns is None else (ns, tuple(row)) for ns, row in zip(state["last_ns"], rows, strict=True)]
        tables = unpack_array(state["rows"]).tolist()
        self._waiting = [
            _Waiting(ns, [_row(word, row) for word, row in zip(words, table, strict=True)])
            for ns, words, table in zip(state["waiting_ns"], state["spoken"], tables, strict=True)
        ]


def _between(first: tuple[int, Values], second: tuple[int, Values], captured_ns: int) -> Values:
    share = (captured_ns - first[0]) / (second[0] - first[0])
    return tuple(a + share * (b - a) for a, b in zip(first[1], second[1], strict=True))


def _word(row: Values | bool | None) -> str:
    if row is None:
        return "awaited"
    return "silent" if isinstance(row, bool) else "spoken"


def _row(word: str, values: list[float]) -> Values | bool | None:
    if word == "awaited":
        return None
    return False if word == "silent" else tuple(values)
