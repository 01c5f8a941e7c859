"""There and back: decides sample by sample when the knee has left its resting side, turned and come back.

The resting side is where the knee was before it moved: flexed in a seated extension, extended in a squat. Angles here
are smoothed, rad; a turn counts once the angle has come back by a hysteresis, so that neither noise nor a hesitation
is one.
"""

from dataclasses import asdict, dataclass, replace
from enum import StrEnum
from typing import NamedTuple

from services.flow.node import State
from services.segmentation.repetitions.parameters import RepetitionParameters


class Point(NamedTuple):
    """The knee and the thigh's inclination (rad, forward) at one time."""

    captured_ns: int
    angle: float
    thigh: float


class Closed(StrEnum):
    """How an excursion ended."""

    BACK = "back"
    """On the resting side again."""
    OTHER_POSTURE = "other_posture"
    """The knee was as before, the thigh was not: the person sat down or stood up on the way."""
    FROM_A_HOLD = "from_a_hold"
    """The knee was extended and held when it was first seen: on a thigh that is level and still, a knee rests bent."""
    HELD = "held"
    """Resting on the far side for longer than a hold."""
    ENDLESS = "endless"
    """Longer than any repetition."""
    BROKEN_OFF = "broken_off"
    """What came next is not known."""


class Excursion(NamedTuple):
    """From the resting side out and back. `sign` is +1 if the knee flexed on its way out, -1 if it extended."""

    closed: Closed
    sign: int
    home: Point
    farthest: Point
    end: Point

    @property
    def way(self) -> float:
        """rad, from home to the farthest point."""
        return abs(self.farthest.angle - self.home.angle)


@dataclass(frozen=True, slots=True)
class Away:
    """An excursion so far. `nearest` is the point nearest to home since the farthest one."""

    sign: int
    home: Point
    farthest: Point
    nearest: Point

    def closed(self, how: Closed) -> Excursion:
        """What it has come to."""
        return Excursion(how, self.sign, self.home, self.farthest, self.nearest)


@dataclass
class ExcursionState:
    """Everything that changes. At home `low` and `high` are the extremes since the knee last rested."""

    low: Point | None = None
    high: Point | None = None
    rest: Point | None = None
    """Where and since when the knee is within the still band."""
    rested: bool = False
    usual: int = 0
    """Sign of the excursions so far; 0 when either is as good."""
    away: Away | None = None


class ExcursionDetector:
    """One knee, at increasing times.

    The hysteresis, and how far the knee must go from home against its usual direction, are the caller's, who knows the
    person's range: what is left after a stop half-way is no movement of its own.
    """

    def __init__(self, parameters: RepetitionParameters) -> None:
        self._parameters = parameters
        self.state = ExcursionState()

    @property
    def needed_from_ns(self) -> int | None:
        """Angles before this time belong to nothing that is still open."""
        state = self.state
        if state.away is not None:
            return state.away.home.captured_ns
        if state.low is None or state.high is None:
            return None
        return min(state.low.captured_ns, state.high.captured_ns)

    def step(self, point: Point, hysteresis: float, against_usual: float) -> Excursion | None:
        """Take one point; the excursion that it closes."""
        state = self.state
        if state.rest is None or abs(point.angle - state.rest.angle) > self._parameters.still_band:
            state.rest = point
        if state.away is None:
            self._at_home(point, hysteresis, against_usual)
            return None
        state.away = _farther_or_nearer(state.away, point)
        return self._closed(state.away, point, hysteresis)

    def break_off(self) -> Excursion | None:
        """Where the knee goes from here is not known; only on which side it rests is remembered."""
        away = self.state.away
        self.state = ExcursionState(usual=self.state.usual)
        return None if away is None else away.closed(Closed.BROKEN_OFF)

    def forget_home(self) -> None:
        """Home is elsewhere from now on; an excursion under way goes on."""
        if self.state.away is None:
            self.state.low = self.state.high = self.state.rest = None

    def _still_s(self, now: Point) -> float:
        return 0.0 if self.state.rest is None else (now.captured_ns - self.state.rest.captured_ns) / 1e9

    def _at_home(self, point: Point, hysteresis: float, against_usual: float) -> None:
        """Leaves home either way after a rest; before one (a gap came) only in the usual direction."""
        state, p = self.state, self._parameters
        if self._still_s(point) >= p.still_s:
            state.low, state.high, state.rested = point, point, True
        low = state.low if state.low is not None and state.low.angle <= point.angle else point
        high = state.high if state.high is not None and state.high.angle >= point.angle else point
        too_old = point.captured_ns - p.longest_s * 1e9
        state.low = low if low.captured_ns > too_old else point
        state.high = high if high.captured_ns > too_old else point
        ways = ((1, state.low),) if p.one_way else ((1, state.low), (-1, state.high))
        for sign, home in ways:
            least = against_usual if sign == -state.usual else hysteresis
            if abs(point.angle - home.angle) >= least and (state.rested or sign != -state.usual):
                state.away = Away(sign, home, point, point)

    def _closed(self, away: Away, point: Point, hysteresis: float) -> Excursion | None:
        p = self._parameters
        way = abs(away.farthest.angle - away.home.angle)
        come_back = abs(away.farthest.angle - away.nearest.angle)
        out_again = away.sign * (point.angle - away.nearest.angle)
        still_s = self._still_s(point)
        is_back = come_back >= max(hysteresis, p.return_share * way)
        turned = is_back and out_again >= hysteresis
        rested = is_back and come_back >= p.rested_share * way and still_s >= p.still_s
        if turned or rested:
            if abs(away.nearest.thigh - away.home.thigh) > p.posture_change:
                return self._turned_round(away, point, Closed.OTHER_POSTURE)
            if away.sign > 0 and self._hangs_from_level_thigh(away):
                return self._turned_round(away, point, Closed.FROM_A_HOLD)
            return self._came_home(away, point, resting=not turned)
        if self.state.usual == 0 and still_s >= p.seated_s and self._has_sat_down(away.home, point):
            return self._settled(away, point, Closed.OTHER_POSTURE)
        if still_s >= p.longest_hold_s:
            return self._settled(away, point, Closed.HELD)
        if point.captured_ns - away.home.captured_ns > p.longest_s * 1e9:
            return self._settled(away, point, Closed.ENDLESS)
        return None

    def _hangs_from_level_thigh(self, away: Away) -> bool:
        thighs = (away.home.thigh, away.farthest.thigh, away.nearest.thigh)
        turned, way = max(thighs) - min(thighs), abs(away.farthest.angle - away.home.angle)
        return min(thighs) > self._parameters.level_thigh and turned < self._parameters.still_thigh * way

    def _has_sat_down(self, home: Point, now: Point) -> bool:
        p = self._parameters
        return home.thigh < p.posture_change and now.thigh > p.level_thigh

    def _came_home(self, away: Away, point: Point, *, resting: bool) -> Excursion:
        found = away.closed(Closed.BACK)
        if resting:
            self.state = ExcursionState(point, point, self.state.rest, rested=True, usual=away.sign)
        else:
            self.state = replace(self.state, away=Away(away.sign, away.nearest, point, point), usual=away.sign)
        return found

    def _turned_round(self, away: Away, point: Point, how: Closed) -> Excursion:
        """The far side is the new resting side; what looked like the way back is the way out from it."""
        new = Away(-away.sign, away.farthest, away.nearest, point)
        self.state = replace(self.state, away=new, usual=-away.sign)
        return away.closed(how)

    def _settled(self, away: Away, point: Point, how: Closed) -> Excursion:
        """Wherever the knee is now is the new resting side."""
        rested = how is not Closed.ENDLESS
        self.state = ExcursionState(point, point, self.state.rest, rested=rested, usual=0)
        return away.closed(how)

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state)

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        away = state["away"]
        self.state = ExcursionState(
            low=_point(state["low"]),
            high=_point(state["high"]),
            rest=_point(state["rest"]),
            rested=state["rested"],
            usual=state["usual"],
            away=None
            if away is None
            else Away(away["sign"], Point(*away["home"]), Point(*away["farthest"]), Point(*away["nearest"])),
        )


def _farther_or_nearer(away: Away, point: Point) -> Away:
    if away.sign * (point.angle - away.farthest.angle) >= 0:
        return replace(away, farthest=point, nearest=point)
    if away.sign * (point.angle - away.nearest.angle) < 0:
        return replace(away, nearest=point)
    return away


def _point(values: list[float] | None) -> Point | None:
    return None if values is None else Point(int(values[0]), values[1], values[2])
