"""Half turns, out of the heading alone: how far it is from straight walking, and when it left that."""

import math
from dataclasses import asdict, dataclass
from typing import NamedTuple

from services.flow.node import State
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters
from services.segmentation.timed_up_and_go.trace import Trace


class Boundary(NamedTuple):
    """An instant with its deviation."""

    at_ns: int
    std_s: float


@dataclass
class TurnState:
    """Everything that changes."""

    since_ns: int = 0  # nothing before is looked at
    straight: float | None = None  # rad, heading of the straight walking at hand


class TurnWatch:
    """Follows the heading of straight walking; says when a turn has begun and when straight walking has ended it.

    The pelvis turns to and fro with each stride, so a turn cannot be told from its rate at an instant (El-Gohary 2013
    smooth it away, and the boundary with it). Here the heading is told from that of a stride of straight walking, and a
    boundary is extrapolated from the times at which it is a little and much farther away.
    """

    def __init__(self, parameters: TimedUpAndGoParameters) -> None:
        self._parameters = parameters
        self.state = TurnState()

    def start(self, captured_ns: int, straight: float | None) -> None:
        """From now on; `straight` is the heading of walking, None where it has to be found."""
        self.state = TurnState(captured_ns, straight)

    def begun(self, trace: Trace, least: float) -> Boundary | None:
        """Take the newest instant, while nobody turns. The begin of a turn by at least `least` rad."""
        p, state = self._parameters, self.state
        heading = trace.instants[-1].heading
        if state.straight is None or abs(heading - state.straight) < p.plateau_band:
            level = self._plateau(trace, p.plateau_s)
            state.straight = heading if state.straight is None else state.straight if level is None else level
        if abs(heading - state.straight) < least:
            return None
        way = 1.0 if heading > state.straight else -1.0
        level = self._level_before(trace, state.straight, way)
        return self._extrapolated(trace, level, way, len(trace.instants) - 1, -1)

    def ended(self, trace: Trace) -> Boundary | None:
        """Take the newest instant of a turn. Its end, once the person walks straight on or turns again."""
        p, state = self._parameters, self.state
        assert state.straight is not None
        level = self._plateau(trace, p.plateau_s)
        if level is None or abs(level - state.straight) < p.turned:
            return None
        newest = self._plateau(trace, p.plateau_s / 2)
        return self._close(trace, level if newest is None else newest)

    def split(self, trace: Trace, least: float) -> tuple[Boundary, Boundary] | None:
        """End of this turn and begin of the next, where there was hardly any straight walking between them.

        Either the person has turned on by `least` rad beyond half a turn, or back by as much; in between the heading
        stood still for a moment, and that is where both are told from.
        """
        assert self.state.straight is not None
        first = trace.index_of(self.state.since_ns)
        straight = self.state.straight
        headings = [each.heading for each in trace.instants[first:]]
        way = 1.0 if sum(headings) > straight * len(headings) else -1.0
        turned = [way * (heading - straight) for heading in headings]
        most, newest = max(turned), turned[-1]
        onward, back = newest > math.pi + least, most > self._parameters.turned and newest < most - least
        if not onward and not back:
            return None
        pause = self._slowest(turned, math.pi if onward else most)
        return None if pause is None else self._split_at(trace, first + pause, way)

    def _slowest(self, turned: list[float], about: float) -> int | None:
        """Where the heading changes least within half a second, among what is near half a turn."""
        p = self._parameters
        half = max(1, round(0.25 / p.instant_s))
        candidates = [
            (abs(turned[i + half] - turned[i - half]), i)
            for i in range(half, len(turned) - half)
            if abs(turned[i] - about) < p.far
        ]
        return min(candidates)[1] if candidates else None

    def _split_at(self, trace: Trace, at: int, way: float) -> tuple[Boundary, Boundary]:
        instants, last = trace.instants, len(trace.instants) - 1
        level, at_ns = instants[at].heading, instants[at].captured_ns
        end = self._extrapolated(trace, level, -way, self._far_before(trace, level, way, at), 1)
        onward = 1.0 if instants[-1].heading > level else -1.0
        begin = self._extrapolated(trace, level, onward, last, -1)
        self.start(at_ns, level)
        return Boundary(min(end.at_ns, at_ns), end.std_s), Boundary(max(begin.at_ns, at_ns), begin.std_s)

    def _plateau(self, trace: Trace, seconds: float) -> float | None:
        """Mean heading of the last seconds, if it stayed within the band of straight walking."""
        newest_ns = trace.instants[-1].captured_ns
        first_ns = newest_ns - round(seconds * 1e9)
        if first_ns < max(self.state.since_ns, trace.instants[0].captured_ns):
            return None
        headings = [each.heading for each in trace.since(first_ns)]
        within = max(headings) - min(headings) < self._parameters.plateau_band
        return sum(headings) / len(headings) if within else None

    def _level_before(self, trace: Trace, straight: float, way: float) -> float:
        """The straight heading just before a turn, without the turn's own first part in it."""
        p, i = self._parameters, len(trace.instants) - 1
        while i > 0 and way * (trace.instants[i].heading - straight) > p.near:
            i -= 1
        last_ns = trace.instants[i].captured_ns - round(0.3 * p.plateau_s * 1e9)
        first_ns = max(last_ns - round(p.plateau_s * 1e9), self.state.since_ns)
        headings = [each.heading for each in trace.instants if first_ns <= each.captured_ns <= last_ns]
        return sum(headings) / len(headings) if headings else straight

    def _close(self, trace: Trace, level: float) -> Boundary:
        assert self.state.straight is not None
        way = 1.0 if level > self.state.straight else -1.0
        last = len(trace.instants) - 1
        boundary = self._extrapolated(trace, level, -way, self._far_before(trace, level, way, last), 1)
        self.start(boundary.at_ns, level)
        return boundary

    def _far_before(self, trace: Trace, level: float, way: float, before: int) -> int:
        """Index of the newest instant before another at which the heading was still far from a level."""
        i = before
        while i > 0 and way * (level - trace.instants[i].heading) < self._parameters.far:
            i -= 1
        return i

    def _extrapolated(self, trace: Trace, level: float, way: float, i: int, step: int) -> Boundary:
        """From instant `i`, which is far from the level, in steps to where it is near; the boundary lies beyond."""
        p = self._parameters
        far_ns = self._crossing(trace, level, way, i, step, p.far)
        near_ns = self._crossing(trace, level, way, i, step, p.near)
        at_ns = near_ns + round(p.turn_onset * (near_ns - far_ns))
        spread_s = p.turn_std_s + p.turn_std_share * abs(near_ns - far_ns) * 1e-9
        return Boundary(at_ns, math.hypot(spread_s, trace.unsure_s(near_ns, p.noted_gap_s)))

    @staticmethod
    def _crossing(trace: Trace, level: float, way: float, i: int, step: int, distance: float) -> int:
        instants = trace.instants
        while 0 <= i + step < len(instants):
            here, there = (way * (instants[k].heading - level) - distance for k in (i, i + step))
            if here > 0 >= there:
                span_ns = instants[i + step].captured_ns - instants[i].captured_ns
                return instants[i].captured_ns + round(here / (here - there) * span_ns)
            i += step
        return instants[i].captured_ns

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state)

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.state = TurnState(**state)
