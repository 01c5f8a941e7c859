"""A device's clock on the session's clock: offset and drift from pairs of device time and arrival time.

A message arrives late by a delay that is never negative and now and then nearly as small as it can be. So the line
of device time against arrival time is the one that lies under all points and closest to them: the edge of their
lower convex hull above the mean device time, which leaves the least sum of delays (Zhang, Liu and Xia 2002,
"Clock synchronization algorithms for network measurements"). The smallest delay itself cannot be seen from one
side; it stays in the offset, as a constant.
"""

import itertools
import math
from collections import deque
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple


@dataclass(frozen=True, slots=True)
class ClockParameters:
    """Bounds of the fit."""

    block_ns: int = 1_000_000_000  # ns of device time from which the fastest message is kept
    blocks: int = 60  # number of blocks kept: a minute, over which a crystal's drift is constant
    worst_drift: float = 0.01  # relative; unsynchronised wearables reach 0.005
    jump_ns: int = 1_000_000_000  # ns that a time may lie ahead of its arrival before it is a jump


CLOCK = ClockParameters()


class ClockEvent(StrEnum):
    """What happened to a device's clock with one message."""

    STEADY = "steady"
    BACKWARDS = "backwards"
    JUMPED = "jumped"


class Reading(NamedTuple):
    """A device time on the session clock. `captured_ns` None: the message must not be used."""

    captured_ns: int | None
    event: ClockEvent


class _Point(NamedTuple):
    """The fastest message of a block."""

    device_ns: int
    arrival_ns: int


@dataclass
class DeviceClock:
    """Maps one device's time stamps, ns, to session time, ns. Pure: arrival times come as arguments.

    The output increases by at least 1 ns and, but for those, never lies after the arrival. A stamp that is not later
    than the last one is refused; two in a row that agree on a new, earlier time are a clock that was set back, and
    begin a new fit, as does a stamp that claims to come from the future.
    """

    parameters: ClockParameters = CLOCK
    drift: float = 0.0
    """Session seconds per device second, minus one."""
    _offset_ns: float = 0.0
    _reference: _Point | None = None
    _blocks: deque[_Point] = field(default_factory=deque)
    _last_device_ns: int | None = None
    _last_captured_ns: int | None = None
    _refused: int | None = None

    def read(self, device_ns: int, arrival_ns: int) -> Reading:
        """Take a stamp with the session time at which it arrived."""
        if self._last_device_ns is None:
            self._restart(device_ns, arrival_ns)
            return self._delivered(device_ns, arrival_ns, ClockEvent.STEADY)
        if device_ns <= self._last_device_ns:
            if self._refused is None or not 0 < device_ns - self._refused <= self.parameters.jump_ns:
                self._refused = device_ns
                return Reading(None, ClockEvent.BACKWARDS)
            self._restart(device_ns, arrival_ns)
            return self._delivered(device_ns, arrival_ns, ClockEvent.JUMPED)
        if self._predicted(device_ns) - arrival_ns > self.parameters.jump_ns:
            self._restart(device_ns, arrival_ns)
            return self._delivered(device_ns, arrival_ns, ClockEvent.JUMPED)
        self._learn(_Point(device_ns, arrival_ns))
        return self._delivered(device_ns, arrival_ns, ClockEvent.STEADY)

    @property
    def std_ns(self) -> float:
        """ns, how far the fastest messages of the blocks scatter about the fitted line; inf with fewer than three.

        The smallest delay of the link, which no one-way stream can show, comes on top.
        """
        if len(self._blocks) < 3:
            return math.inf
        excess = [point.arrival_ns - self._predicted(point.device_ns) for point in self._blocks]
        return math.sqrt(sum(delay**2 for delay in excess) / len(excess))

    def _restart(self, device_ns: int, arrival_ns: int) -> None:
        self._blocks.clear()
        self._reference = _Point(device_ns, arrival_ns)
        self._offset_ns = 0.0
        self._blocks.append(self._reference)

    def _predicted(self, device_ns: int) -> int:
        """Session time of a device time; integer differences keep stamps since 1970 exact."""
        assert self._reference is not None, "read starts the fit before it predicts"
        passed = device_ns - self._reference.device_ns
        return self._reference.arrival_ns + passed + round(passed * self.drift + self._offset_ns)

    def _delivered(self, device_ns: int, arrival_ns: int, event: ClockEvent) -> Reading:
        captured_ns = min(self._predicted(device_ns), arrival_ns)
        if self._last_captured_ns is not None:
            captured_ns = max(captured_ns, self._last_captured_ns + 1)
        self._last_device_ns, self._last_captured_ns, self._refused = device_ns, captured_ns, None
        return Reading(captured_ns, event)

    def _learn(self, point: _Point) -> None:
        newest = self._blocks[-1]
        if point.device_ns // self.parameters.block_ns != newest.device_ns // self.parameters.block_ns:
            self._blocks.append(point)
            if len(self._blocks) > self.parameters.blocks:
                self._blocks.popleft()
            self._fit()
        elif point.arrival_ns - self._predicted(point.device_ns) < newest.arrival_ns - self._predicted(
            newest.device_ns
        ):
            self._blocks[-1] = point
            if point.arrival_ns < self._predicted(point.device_ns):
                self._fit()

    def _fit(self) -> None:
        assert self._reference is not None, "read starts the fit before it learns"
        zero = self._reference
        passed = [(p.device_ns - zero.device_ns, p.arrival_ns - zero.arrival_ns) for p in self._blocks]
        points = [(float(on_device), float(on_session - on_device)) for on_device, on_session in passed]
        hull = _lower_hull(points)
        middle = sum(x for x, _ in points) / len(points)
        if len(points) >= 3:
            left, right = next((a, b) for a, b in itertools.pairwise(hull) if a[0] <= middle <= b[0])
            slope = (right[1] - left[1]) / (right[0] - left[0])
            self.drift = min(max(slope, -self.parameters.worst_drift), self.parameters.worst_drift)
        self._offset_ns = min(y - self.drift * x for x, y in points)


def _lower_hull(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Lower convex hull of points with increasing x (monotone chain)."""
    hull: list[tuple[float, float]] = []
    for x, y in points:
        while len(hull) >= 2 and _turns_right(hull[-2], hull[-1], (x, y)):
            hull.pop()
        hull.append((x, y))
    return hull


def _turns_right(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> bool:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0
