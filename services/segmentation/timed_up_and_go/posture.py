"""Rising from a chair and sitting down, seen by the thighs or, where there is none, by the height of the pelvis."""

import math
from dataclasses import asdict, dataclass
from typing import NamedTuple

from services.flow.node import State
from services.segmentation.timed_up_and_go.instants import Instant
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters
from services.segmentation.timed_up_and_go.trace import Trace


class Change(NamedTuple):
    """Somebody rose or sat down: from the first motion of it to upright, or to the seat."""

    rises: bool
    start_ns: int
    start_std_s: float
    end_ns: int
    end_std_s: float
    thigh_rate: float | None  # rad/s, the largest


@dataclass
class PostureState:
    """Everything that changes."""

    seated: bool | None = None
    changed_ns: int = 0
    down_since_ns: int | None = None
    lobe_start_ns: int | None = None  # of a vertical speed that goes on
    lifted_ns: int | None = None  # of one that is over and lifted or lowered the body; the trunk may still move
    lobe_peak: float = 0.0  # m/s, signed
    lobe_height: float = 0.0  # m, signed


def lean_rate(instant: Instant) -> float | None:
    """rad/s, forward."""
    return instant.lean_rate


def _lean_back(instant: Instant) -> float | None:
    return None if instant.lean_rate is None else -instant.lean_rate


def _turned_down(instant: Instant) -> float | None:
    return instant.thigh_rate


def _turned_up(instant: Instant) -> float | None:
    return None if instant.thigh_rate is None else -instant.thigh_rate


def _upward(instant: Instant) -> float | None:
    return instant.upward


def _downward(instant: Instant) -> float | None:
    return None if instant.upward is None else -instant.upward


class Posture:
    """Takes the newest instant of a trace; says when a change of posture is complete."""

    def __init__(self, parameters: TimedUpAndGoParameters) -> None:
        self._parameters = parameters
        self.state = PostureState()

    def step(self, trace: Trace) -> Change | None:
        """The change that the newest instant completes."""
        newest = trace.instants[-1]
        if newest.thigh is not None:
            return self._by_thighs(trace, newest.thigh)
        return None if newest.upward is None else self._by_pelvis(trace, newest.upward)

    def forget(self) -> None:
        """Too long without a sight of it: anything may have happened."""
        self.state = PostureState(changed_ns=self.state.changed_ns)

    def _by_thighs(self, trace: Trace, thigh: float) -> Change | None:
        p, state, now_ns = self._parameters, self.state, trace.instants[-1].captured_ns
        if thigh < p.seated_thigh:
            state.down_since_ns = None
        elif state.down_since_ns is None:
            state.down_since_ns = now_ns
        if state.seated is not True:
            lasts = state.down_since_ns is not None and now_ns - state.down_since_ns >= p.seated_for_s * 1e9
            if lasts:
                return self._change(trace, rises=False)
            if state.seated is None and thigh < p.upright_thigh:
                state.seated = False
            return None
        return self._change(trace, rises=True) if thigh < p.upright_thigh else None

    def _change(self, trace: Trace, *, rises: bool) -> Change | None:
        """The change whose middle has passed, once the thighs have come to rest."""
        p, state = self._parameters, self.state
        rate = _turned_up if rises else _turned_down
        middle = trace.last_above(lambda each: _inclined(each, rises), -p.seated_thigh if not rises else p.seated_thigh)
        if state.seated is None:
            state.seated = not rises
            state.changed_ns = trace.instants[-1].captured_ns
            return None
        first = trace.index_of(state.changed_ns)
        if middle is None or middle < first:
            middle = first
        last = min(len(trace.instants), middle + 1 + round(2.0 / p.instant_s)) if not rises else len(trace.instants)
        peak = trace.fastest(rate, max(first, middle - round(0.5 / p.instant_s)), last)
        if peak is None:
            return None
        end_ns = trace.ends_ns(rate, peak, p.over_share)
        if end_ns is None:
            return None
        start_ns = max(state.changed_ns, trace.begins_ns(rate, peak, p.begun_share))
        start_ns, start_std_s = self._with_lean(trace, start_ns, end_ns, peak)
        state.seated, state.changed_ns = not rises, end_ns
        largest = rate(trace.instants[peak])
        return self._unsure(trace, Change(rises, start_ns, start_std_s, end_ns, p.rise_std_s, largest))

    def _unsure(self, trace: Trace, change: Change) -> Change:
        """With what lost samples add to the deviations."""
        noted_s = self._parameters.noted_gap_s
        return change._replace(
            start_std_s=math.hypot(change.start_std_s, trace.unsure_s(change.start_ns, noted_s)),
            end_std_s=math.hypot(change.end_std_s, trace.unsure_s(change.end_ns, noted_s)),
        )

    def _with_lean(self, trace: Trace, start_ns: int, end_ns: int, peak: int) -> tuple[int, float]:
        """The begin of all motion, from the begin of what carries the body: the trunk leans forward before that."""
        p, length_ns = self._parameters, end_ns - start_ns
        if trace.instants[peak].lean_rate is None:
            spread_s = math.hypot(p.rise_std_s, p.lead_std * length_ns * 1e-9)
            return max(self.state.changed_ns, start_ns - round(p.lead * length_ns)), spread_s
        first = trace.index_of(max(self.state.changed_ns, start_ns - round(p.lean_before * length_ns)))
        leans = trace.fastest(lean_rate, first, peak + 1)
        if leans is None or (lean_rate(trace.instants[leans]) or 0.0) < p.lean_rate:
            return start_ns, p.rise_std_s
        begins_ns = trace.begins_ns(lean_rate, leans, p.begun_share)
        return max(self.state.changed_ns, min(start_ns, begins_ns)), p.rise_std_s

    def _by_pelvis(self, trace: Trace, speed: float) -> Change | None:
        """A lobe of vertical speed that lifts or lowers the pelvis by a chair's height."""
        p, state, now_ns = self._parameters, self.state, trace.instants[-1].captured_ns
        if state.lifted_ns is not None:
            return self._lifted(trace, state.lifted_ns, rises=state.lobe_peak > 0)
        if state.lobe_start_ns is None:
            if abs(speed) > p.lift_speed:
                state.lobe_start_ns, state.lobe_peak, state.lobe_height = now_ns, speed, 0.0
            return None
        step_s = (now_ns - trace.instants[-2].captured_ns) * 1e-9 if len(trace.instants) > 1 else 0.0
        state.lobe_height += speed * step_s
        if speed * state.lobe_peak > state.lobe_peak**2:
            state.lobe_peak = speed
        if speed * state.lobe_peak > p.pelvis_over_share * state.lobe_peak**2:
            return None
        lobe_ns, height, rises = state.lobe_start_ns, state.lobe_height, state.lobe_peak > 0
        state.lobe_start_ns = None
        if abs(height) < p.lift or abs(state.lobe_peak) < p.lift_peak or state.seated is (not rises):
            return None
        state.lifted_ns = lobe_ns
        return self._lifted(trace, lobe_ns, rises=rises)

    def _lifted(self, trace: Trace, lobe_ns: int, *, rises: bool) -> Change | None:
        p, rate = self._parameters, _upward if rises else _downward
        peak = trace.fastest(rate, trace.index_of(lobe_ns), len(trace.instants))
        end_ns = None if peak is None else trace.ends_ns(rate, peak, p.pelvis_over_share)
        if peak is None or end_ns is None:
            self.state.lifted_ns = None
            return None
        start_ns = trace.begins_ns(rate, peak, p.begun_share)
        start_ns, _ = self._with_lean(trace, start_ns, end_ns, peak)
        if rises:
            end_ns = self._trunk_is_up(trace, peak, end_ns)
            if end_ns is None:
                return None
        self.state.seated, self.state.changed_ns, self.state.lifted_ns = not rises, end_ns, None
        return self._unsure(trace, Change(rises, start_ns, p.pelvis_std_s, end_ns, p.pelvis_std_s, None))

    def _trunk_is_up(self, trace: Trace, peak: int, end_ns: int) -> int | None:
        """When the trunk has come up after a lift; None while it still does.

        The height hardly changes over the last part of rising: it goes with the cosine of the thighs' inclination.
        """
        back = trace.fastest(_lean_back, peak, len(trace.instants))
        if back is None or (_lean_back(trace.instants[back]) or 0.0) < self._parameters.lean_rate:
            return end_ns
        up_ns = trace.ends_ns(_lean_back, back, self._parameters.over_share)
        return None if up_ns is None else max(end_ns, up_ns)

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state)

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.state = PostureState(**state)


def _inclined(instant: Instant, rises: bool) -> float | None:
    """Such that the newest instant on the other side of a change is the newest one above a level."""
    return None if instant.thigh is None else instant.thigh if rises else -instant.thigh
