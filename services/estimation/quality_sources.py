"""Samples of each sensor as they are counted: used, refused, and the longest silence between two."""

from collections.abc import Iterable

from schemas.health import Reason
from schemas.quality import SourceQuality
from services.estimation.samples import Tick
from services.flow.node import State

Refusal = tuple[int, int, str]
"""A refused sample: its place in time, ns; its sensor; the reason."""


class SourceTallies:
    """Of all sensors of a session, tick by tick.

    While all of them speak in every tick, one count does for all: `_in_step` ticks with one longest gap.
    """

    def __init__(self, rates_hz: list[float]) -> None:
        count = len(rates_hz)
        self._rates_hz = rates_hz
        self._first_ns: list[int | None] = [None] * count
        self._last_ns: list[int | None] = [None] * count
        self._used, self._rejected, self._silence_ns = [0] * count, [0] * count, [0] * count
        self._together = 0
        self._gap_ns = 0
        self._in_step = False
        self._started_ns: int | None = None
        self.newest_ns = 0
        self.late = 0

    def take(self, ticks: Iterable[Tick]) -> None:
        """Usable samples."""
        for tick in ticks:
            self.count(tick.captured_ns, tick.fresh.tolist())

    def count(self, now_ns: int, fresh: list[bool]) -> None:
        """Who spoke at one instant."""
        if self._in_step and False not in fresh:
            gap_ns = now_ns - self.newest_ns
            if gap_ns > self._gap_ns:
                self._gap_ns = gap_ns
            self._together += 1
            self.newest_ns = now_ns
            return
        self._settle()
        if self._started_ns is None:
            self._started_ns = now_ns
        for s, spoke in enumerate(fresh):
            if spoke:
                self._silence_ns[s] = self._silence(s, now_ns)
                self._first_ns[s] = now_ns if self._first_ns[s] is None else self._first_ns[s]
                self._last_ns[s] = now_ns
                self._used[s] += 1
        self.newest_ns = now_ns
        self._in_step = bool(fresh) and False not in fresh

    def refuse(self, refused: Iterable[Refusal]) -> None:
        """Samples that came and were not used."""
        for _, s, reason in refused:
            self._rejected[s] += 1
            self.late += reason == Reason.LATE

    def _settle(self) -> None:
        """Give every sensor what was counted for all at once."""
        if self._together:
            self._used = [used + self._together for used in self._used]
            self._silence_ns = [max(silence, self._gap_ns) for silence in self._silence_ns]
            self._last_ns = [self.newest_ns] * len(self._last_ns)
        self._together, self._gap_ns = 0, 0

    def _silence(self, s: int, now_ns: int) -> int:
        """Longest time without a sample, with the one that lasts until now."""
        since_ns = self._last_ns[s] if self._last_ns[s] is not None else self._started_ns
        return self._silence_ns[s] if since_ns is None else max(self._silence_ns[s], now_ns - since_ns)

    def quality(self, s: int, name: str, misplaced: bool) -> SourceQuality:
        """Of one sensor, up to the newest instant."""
        self._settle()
        first_ns = self._first_ns[s]
        expected = 0 if first_ns is None else int((self.newest_ns - first_ns) * 1e-9 * self._rates_hz[s] + 0.5) + 1
        return SourceQuality(
            name=name,
            expected=expected,
            used=self._used[s],
            rejected=self._rejected[s],
            longest_silence_s=round(self._silence(s, self.newest_ns) * 1e-9, 9),
            misplaced=misplaced,
        )

    def snapshot(self) -> State:
        """All counts, settled: what was counted for all at once stands with each."""
        self._settle()
        return {
            "first_ns": list(self._first_ns),
            "last_ns": list(self._last_ns),
            "used": list(self._used),
            "rejected": list(self._rejected),
            "silence_ns": list(self._silence_ns),
            "in_step": self._in_step,
            "started_ns": self._started_ns,
            "newest_ns": self.newest_ns,
            "late": self.late,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._first_ns, self._last_ns = list(state["first_ns"]), list(state["last_ns"])
        self._used, self._rejected = list(state["used"]), list(state["rejected"])
        self._silence_ns, self._in_step = list(state["silence_ns"]), state["in_step"]
        self._started_ns, self.newest_ns, self.late = state["started_ns"], state["newest_ns"], state["late"]
        self._together, self._gap_ns = 0, 0
