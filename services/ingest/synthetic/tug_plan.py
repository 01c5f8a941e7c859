"""When a synthetic person sits, rises, walks, turns and sits down again, and where the phases of a test truly are."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from schemas.vocabulary import TASK_PHASES, Task, TaskPhaseKind
from services.ingest.synthetic.jets import Array, Jet, smooth_step
from services.ingest.synthetic.parameters import TugParameters
from services.ingest.synthetic.tempo import OwnPace, Tempo
from services.ingest.synthetic.timeline import (
    RESTING_PHASE,
    TURN_SHORTENING,
    Bout,
    Timeline,
    stride_frequency_hz,
    time_of,
)

ONSET_RATE = 0.05
"""Share of a movement's peak rate at which it counts as begun and, at its end, as over."""
ONSET_SHARE = 0.5 - math.sqrt(0.25 - (ONSET_RATE / 64) ** (1 / 3))
"""Where in a smooth step that is: its rate is 64 u^3 (1 - u)^3 of its peak."""

CHAIR_SHORTENING = 0.7
"""Share by which steps are shorter while a person turns to sit."""
ABORTED_STRIDES = 3
STANDS_S = 1.5
"""s that a person stands who rises and sits down again."""
STEP_OVERLAP = 1.6
"""Length of one part of a turn against its even share: parts flow into each other."""


class Change(NamedTuple):
    """Rising from the seat or sitting down, s."""

    start_s: float
    end_s: float
    rises: bool


class Turn(NamedTuple):
    """Half a turn about the vertical, s and rad, to the left positive."""

    start_s: float
    end_s: float
    angle: float


class TruePhase(NamedTuple):
    """One phase of one attempt, s."""

    attempt: int
    phase: TaskPhaseKind
    start_s: float
    end_s: float


class RiseParts(NamedTuple):
    """When the trunk leans forward, the thighs turn upright and the trunk comes up, s from and to.

    First the trunk gains speed over the seat, then the body is lifted (the phases of Schenkman 1990).
    """

    forward: tuple[float, float]
    thigh: tuple[float, float]
    back: tuple[float, float]

    @classmethod
    def of(cls, rise: Change, lead: float) -> "RiseParts":
        """`lead`: share of the rise before the thighs move."""
        start_s, end_s, length_s = rise.start_s, rise.end_s, rise.end_s - rise.start_s
        return cls(
            (start_s, start_s + (lead + 0.25) * length_s),
            (start_s + lead * length_s, end_s),
            (start_s + (lead + 0.15) * length_s, end_s),
        )


class SitParts(NamedTuple):
    """When the trunk leans forward, the thighs go down to the seat and the trunk leans back, s from and to."""

    forward: tuple[float, float]
    thigh: tuple[float, float]
    back: tuple[float, float]

    @classmethod
    def of(cls, sit: Change) -> "SitParts":
        """The trunk comes to rest after the thighs."""
        start_s, end_s, length_s = sit.start_s, sit.end_s, sit.end_s - sit.start_s
        return cls(
            (start_s, start_s + 0.5 * length_s),
            (start_s + 0.1 * length_s, start_s + 0.9 * length_s),
            (start_s + 0.5 * length_s, end_s),
        )


@dataclass(frozen=True)
class TugTimeline(Timeline):
    """The walks of a test, its turns made in parts."""

    made_turns: tuple[Turn, ...] = ()
    turn_steps: int = 1

    def amplitude(self, time_s: Array) -> Jet:
        """Steps are shorter about the marker and small before the chair."""
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        amplitude = super().amplitude(time_s)
        for number, turn in enumerate(self.made_turns):
            third_s = (turn.end_s - turn.start_s) / 3
            down = clock.through(smooth_step(turn.start_s, turn.start_s + third_s))
            if number % 2 == 0:
                up = clock.through(smooth_step(turn.end_s - third_s, turn.end_s))
                amplitude = amplitude * (up + down.scaled(-1.0)).scaled(TURN_SHORTENING).shifted(1.0)
            else:
                after = [bout.start_s for bout in self.bouts if bout.start_s > turn.start_s]
                up = clock.through(smooth_step(min(after) - 0.1, min(after))) if after else Jet.constant(0.0, time_s)
                amplitude = amplitude * (up + down.scaled(-1.0)).scaled(CHAIR_SHORTENING).shifted(1.0)
        return amplitude

    def heading(self, time_s: Array) -> Jet:
        """Direction in which the feet stand, rad about world y."""
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        heading = Jet.constant(0.0, time_s)
        for turn in self.made_turns:
            for start_s, end_s in _parts(turn, self.turn_steps):
                part = clock.through(smooth_step(start_s, end_s))
                heading = heading + part.scaled(turn.angle / self.turn_steps)
        return heading

    def turned_within(self, turn: Turn) -> tuple[float, float]:
        """When the turn begins and ends, s: its rate is more than ONSET_RATE of its peak in between."""
        time_s = np.linspace(turn.start_s, turn.end_s, 4001)
        rate = np.abs(replace(self, made_turns=(turn,)).heading(time_s).rate)
        within = np.flatnonzero(rate > ONSET_RATE * rate.max())
        return float(time_s[within[0]]), float(time_s[within[-1]])


@dataclass(frozen=True)
class TugPlan:
    """Everything of one session in its order."""

    timeline: TugTimeline
    changes: tuple[Change, ...]
    phases: tuple[TruePhase, ...]
    starts_seated: bool
    lead: float
    """Share of a rise during which only the trunk moves."""
    end_s: float


class Attempt(NamedTuple):
    """What one attempt is made of; one that is cut short has no turns."""

    rise: Change
    turns: tuple[Turn, Turn] | None
    sit: Change


def onset_s(start_s: float, end_s: float) -> float:
    """When a smooth step counts as begun."""
    return start_s + ONSET_SHARE * (end_s - start_s)


def over_s(start_s: float, end_s: float) -> float:
    """When a smooth step counts as over."""
    return end_s - ONSET_SHARE * (end_s - start_s)


def _parts(turn: Turn, steps: int) -> list[tuple[float, float]]:
    length_s = turn.end_s - turn.start_s
    if steps == 1:
        return [(turn.start_s, turn.end_s)]
    width_s = STEP_OVERLAP * length_s / steps
    starts = [turn.start_s + k * (length_s - width_s) / (steps - 1) for k in range(steps)]
    return [(start_s, start_s + width_s) for start_s in starts]


class _Planner:
    """Puts one thing after another; `now_s` is where the session has come to."""

    def __init__(self, parameters: TugParameters, tempo: Tempo, lead: float) -> None:
        self.parameters, self.tempo, self.lead = parameters, tempo, lead
        self.now_s = parameters.standing
        self.phase = RESTING_PHASE
        self.bouts: list[Bout] = []
        self.turns: list[Turn] = []
        self.changes: list[Change] = []
        self.attempts: list[Attempt] = []

    def walk(self, seconds: float) -> Bout:
        """Whole strides from now on, for at least so many seconds."""
        strides = max(2, math.ceil(seconds * self.tempo.frequency_hz))
        latest_s = self.now_s + 4 * strides / self.tempo.frequency_hz
        bout = Bout(self.now_s, time_of(self.tempo, self.now_s, strides, latest_s), self.phase)
        self.bouts.append(bout)
        self.now_s, self.phase = bout.end_s, self.phase + strides
        return bout

    def change(self, *, rises: bool) -> Change:
        """Rise or sit down now."""
        p = self.parameters
        change = Change(self.now_s, self.now_s + (p.rise_time if rises else p.sit_time), rises)
        self.changes.append(change)
        self.now_s = change.end_s
        return change

    def turn(self, start_s: float) -> Turn:
        """Half a turn, to the left and to the right in turn."""
        angle = math.pi * (-1.0) ** (len(self.turns) // 2)
        turn = Turn(start_s, start_s + self.parameters.turn_time, angle)
        self.turns.append(turn)
        return turn

    def whole(self) -> None:
        """One attempt from the chair to the chair."""
        p, stride_s = self.parameters, 1 / self.tempo.frequency_hz
        self.now_s += p.pause
        rise = self.change(rises=True)
        # The first stride is half as long, and a turn is made on the way, about the marker.
        out_s = max(1.2 * stride_s, p.walkway / p.speed + 0.5 * stride_s - 0.3 * p.turn_time)
        back_s = max(0.5 * stride_s, p.walkway / p.speed - 0.6 * p.turn_time)
        if p.hesitation:
            self.walk(out_s)
            self.now_s += p.hesitation
            first = self.turn(self.now_s)
        else:
            first = self.turn(self.now_s + out_s)
        second = self.turn(first.end_s + back_s)
        bout = self.walk(second.end_s - self.now_s)
        self.now_s = max(second.end_s, bout.end_s)
        self.attempts.append(Attempt(rise, (first, second), self.change(rises=False)))

    def cut_short(self) -> None:
        """An attempt that ends on another chair before the turn."""
        self.now_s += self.parameters.pause
        rise = self.change(rises=True)
        self.walk(ABORTED_STRIDES / self.tempo.frequency_hz)
        self.attempts.append(Attempt(rise, None, self.change(rises=False)))

    def false_start(self) -> None:
        """Up and down again."""
        self.now_s += self.parameters.pause
        self.change(rises=True)
        self.now_s += STANDS_S
        self.change(rises=False)


def plan_tug(parameters: TugParameters) -> TugPlan:
    """The schedule that the dials ask for; what a person does in an own way is drawn from the seed."""
    lead = float(np.random.default_rng([parameters.seed, 5]).uniform(0.2, 0.4))
    tempo = OwnPace.drawn(stride_frequency_hz(parameters.speed), parameters.wander, parameters.seed)
    planner = _Planner(parameters, tempo, lead)
    if parameters.stroll:
        planner.walk(parameters.stroll / tempo.frequency_hz)
        planner.now_s += STANDS_S
    if not parameters.seated_start:
        planner.change(rises=False)
    for _ in range(parameters.false_starts):
        planner.false_start()
    for _ in range(parameters.aborted):
        planner.cut_short()
    for _ in range(parameters.attempts):
        planner.whole()
    timeline = TugTimeline(
        tuple(planner.bouts), (), parameters.turn_time, tempo, tuple(planner.turns), parameters.turn_steps
    )
    phases = tuple(
        phase for number, attempt in enumerate(planner.attempts) for phase in _phases(number, attempt, timeline, lead)
    )
    starts_seated = bool(parameters.seated_start) and not parameters.stroll
    return TugPlan(timeline, tuple(planner.changes), phases, starts_seated, lead, planner.now_s + parameters.pause)


def _phases(number: int, attempt: Attempt, timeline: TugTimeline, lead: float) -> list[TruePhase]:
    """Each phase begins where the one before it ends."""
    rise, sit = RiseParts.of(attempt.rise, lead), SitParts.of(attempt.sit)
    instants = [onset_s(*rise.forward), over_s(*rise.thigh)]
    if attempt.turns is None:
        instants.append(onset_s(*sit.forward))
    else:
        (begins_s, ends_s), (last_s, _) = (timeline.turned_within(turn) for turn in attempt.turns)
        instants += [begins_s, ends_s, last_s, over_s(*sit.thigh)]
    spans = zip(TASK_PHASES[Task.TIMED_UP_AND_GO], instants, instants[1:], strict=False)
    return [TruePhase(number, kind, start_s, end_s) for kind, start_s, end_s in spans]
