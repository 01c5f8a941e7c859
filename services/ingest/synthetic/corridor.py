"""The synthetic walks of a corridor: for time, and over a measured distance. Pure."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from schemas.conditions import UNSAID, Conditions, SpeedInstruction, Start
from schemas.session import SessionDescription
from schemas.vocabulary import Segment, Side, Task
from services.ingest.errors import InvalidOption
from services.ingest.synthetic.corridor_parameters import CorridorParameters, SixMinutesParameters, TenMetresParameters
from services.ingest.synthetic.corridor_plan import (
    CLEAR_OF_TURN_S,
    PIVOT_SHORTENING,
    CorridorTimeline,
    Walker,
)
from services.ingest.synthetic.gait import BALL_FROM_ANKLE, Gait
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.session import SyntheticSession
from services.ingest.synthetic.tempo import OwnPace
from services.ingest.synthetic.timeline import stride_frequency_hz

STRIDES_AFTER_TIME = 2
"""Strides in which somebody comes to stand who is told to stop."""


@dataclass(frozen=True)
class Trial:
    """One walk of a measured walkway: when it begins and ends, and when the foremost toes cross the zone's lines; s."""

    start_s: float
    enters_s: float
    leaves_s: float
    end_s: float


class CorridorWalk(SyntheticSession):
    """A plan, and the person who keeps to it."""

    def __init__(self, parameters: CorridorParameters, walker: Walker, gait: Gait, size: float) -> None:
        super().__init__(parameters, walker.planned, gait)
        self.walker = walker
        self.amplitude_of_walk = size
        """Amplitude of the first walk."""

    @property
    def turns(self) -> tuple[tuple[float, float], ...]:
        """From and to, s, of those made on the way."""
        made = [start_s for start_s, _ in self.walker.turns if start_s not in self.walker.pivots]
        return tuple((start_s, start_s + self.timeline.turn_time) for start_s in made)

    @property
    def conditions(self) -> Conditions:
        """How the test was done."""
        return UNSAID

    def amplitude(self, time_s: Array) -> Jet:
        """As planned."""
        return self.timeline.amplitude(time_s)

    def description(self, session: str = "synthetic", started_unix_ns: int = 0) -> SessionDescription:
        """With how the test was done."""
        described = super().description(session, started_unix_ns)
        return described.model_copy(update={"conditions": self.conditions})


class SyntheticSixMinutes(CorridorWalk):
    """Quiet standing, then up and down a corridor until the time is over."""

    protocol = "six-minute walk"
    task = Task.SIX_MINUTE_WALK

    def __init__(self, parameters: SixMinutesParameters) -> None:
        gait, timeline, size = _body(parameters)
        timeline = replace(timeline, fades=(parameters.standing, parameters.duration, parameters.decline))
        walker = Walker.at(parameters.standing, timeline, gait)
        self.test_duration_s, self.decline = parameters.duration, parameters.decline
        self.start_s = parameters.standing
        self.end_s = parameters.standing + parameters.duration
        self.rests: tuple[tuple[float, float], ...] = tuple(_walk_for_time(walker, parameters, size, self.end_s))
        session = replace(parameters, duration=walker.now_s + parameters.pause)
        super().__init__(session, walker, gait, size)
        self.walkway_m = parameters.corridor
        self.title = f"Synthetic six-minute walk at {parameters.speed:g} m/s (seed {parameters.seed})"

    @property
    def conditions(self) -> Conditions:
        """For how long."""
        return UNSAID.model_copy(update={"test_duration_s": self.test_duration_s})

    @cached_property
    def lengths(self) -> int:
        """Ends of the corridor reached in time: turns whose middle is."""
        return sum((start_s + end_s) / 2 <= self.end_s for start_s, end_s in self.turns)

    @cached_property
    def distance_m(self) -> float:
        """As a tester counts it: whole lengths and what was walked of the last one."""
        time_s = np.arange(self.start_s, self.end_s, 0.01)
        place = float(np.trapezoid(self.walker.speeds(time_s), time_s))
        corridor = self.walkway_m or 0.0
        last = corridor if self.lengths % 2 else 0.0
        return self.lengths * corridor + abs(place - last)


class SyntheticTenMetres(CorridorWalk):
    """Quiet standing, then the walkway as often as asked for."""

    protocol = "ten-metre walk"
    task = Task.TEN_METRE_WALK

    def __init__(self, parameters: TenMetresParameters) -> None:
        if not parameters.zone_from < parameters.zone_to <= parameters.walkway:
            raise InvalidOption("zone_from, zone_to: the timed zone lies within the walkway")
        gait, timeline, size = _body(parameters)
        walker = Walker.at(parameters.standing, timeline, gait)
        walk = _walk_on if parameters.start else _walk_and_stand
        self.walks = walk(walker, parameters, size)
        """From and to, s, of each trial."""
        least_s = walker.now_s + parameters.pause
        if 0 < parameters.duration < least_s:
            raise InvalidOption(f"duration={parameters.duration:g} is too short; all trials take {least_s:.1f} s")
        session = replace(parameters, duration=parameters.duration or least_s)
        super().__init__(session, walker, gait, size)
        self.test = parameters
        self.walkway_m = parameters.walkway
        self.title = f"Synthetic ten-metre walk at {parameters.speed:g} m/s (seed {parameters.seed})"

    @property
    def conditions(self) -> Conditions:
        """How it starts, and what is timed."""
        start = Start.WALKING if self.test.start else Start.STANDING
        said = {
            "start": start,
            "timed_from_m": self.test.zone_from,
            "timed_to_m": self.test.zone_to,
            "speed_instruction": SpeedInstruction.COMFORTABLE,
        }
        return UNSAID.model_copy(update=said)

    @cached_property
    def trials(self) -> tuple[Trial, ...]:
        """Each walk of the walkway, by the body's own toes."""
        rate = 200.0
        time_s = np.arange(0.0, self.walks[-1][1] + 2.0, 1 / rate)
        body = self.body(time_s)
        toes = [body.segments[Segment(f"foot_{side}")].point(BALL_FROM_ANKLE).position[:, 0] for side in Side]
        found = []
        for number, (start_s, end_s) in enumerate(self.walks):
            way = 1.0 if number % 2 == 0 else -1.0
            foremost = np.max([way * toe for toe in toes], axis=0)
            within = slice(int(start_s * rate), int(end_s * rate))
            line = self._start_line(number, foremost[within][0])
            ahead = np.maximum.accumulate(foremost[within]) - line
            enters, leaves = (np.interp(at, ahead, time_s[within]) for at in (self.test.zone_from, self.test.zone_to))
            found.append(Trial(start_s, float(enters), float(leaves), end_s))
        return tuple(found)

    def _start_line(self, number: int, foremost: float) -> float:
        """Where the trial's distance begins, in its own direction: at the toes, or at the end of the walkway."""
        if not self.test.start or number == 0:
            return foremost
        standing_toes = float(BALL_FROM_ANKLE[0])
        return standing_toes if number % 2 == 0 else standing_toes - self.test.walkway


def _body(parameters: CorridorParameters) -> tuple[Gait, CorridorTimeline, float]:
    """The walker, an empty plan at the own pace, and the amplitude of the steps at the speed asked for."""
    gait = Gait(parameters.thigh_length, parameters.shank_length, parameters.hip_width, parameters.asymmetry)
    tempo = OwnPace.drawn(stride_frequency_hz(parameters.speed), parameters.wander, parameters.seed)
    timeline = CorridorTimeline((), (), parameters.turn_time, tempo)
    lengths = Walker.at(0.0, timeline, gait).stride_length
    wanted = parameters.speed / tempo.frequency_hz
    amplitudes = np.linspace(0.0, 1.6, 1601)
    return gait, timeline, float(np.interp(wanted, lengths(amplitudes), amplitudes))


def _walk_for_time(
    walker: Walker, parameters: SixMinutesParameters, size: float, end_s: float
) -> list[tuple[float, float]]:
    """Turns at both ends and rests between them; from and to, s, of each rest."""
    span_s = parameters.duration / (parameters.rests + 1)
    due_s = [parameters.standing + span_s * (k + 1) for k in range(parameters.rests)] + [math.inf]
    rests: list[tuple[float, float]] = []
    walker.set_out(size)
    ahead_m = parameters.corridor
    while True:
        turn_s = walker.turn_at(ahead_m)
        over_s = turn_s + parameters.turn_time
        if due_s[0] < turn_s - CLEAR_OF_TURN_S and due_s[0] < end_s:
            walker.stop(due_s.pop(0))
            rests.append((walker.now_s, walker.now_s + parameters.rest_time))
            walker.now_s += parameters.rest_time
            walker.set_out(size)
        elif turn_s + parameters.turn_time / 2 > end_s:
            walker.stop(end_s + STRIDES_AFTER_TIME / walker.timeline.frequency_hz)
            return rests
        else:
            walker.turn(turn_s)
            ahead_m = parameters.corridor - ahead_m
            due_s[0] = max(due_s[0], over_s + CLEAR_OF_TURN_S + 2 / walker.timeline.frequency_hz)


def _walk_and_stand(walker: Walker, parameters: TenMetresParameters, size: float) -> list[tuple[float, float]]:
    """Each trial from standing to standing, with a turn between pauses."""
    walks = []
    stride_m = float(walker.stride_length(size))
    for number in range(parameters.trials):
        # The first and the last stride are about half as long.
        strides = max(3, round(parameters.walkway / stride_m + 1))
        fitting = walker.sized_for(parameters.walkway, strides)
        start_s = walker.now_s
        walker.set_out(fitting)
        walker.stop_after(strides)
        walks.append((start_s, walker.now_s))
        if number < parameters.trials - 1:
            walker.now_s += parameters.pause / 2
            _turn_round(walker, size)
            walker.now_s += parameters.pause / 2
    return walks


def _turn_round(walker: Walker, size: float) -> None:
    """On small steps, from standing to standing."""
    start_s = walker.now_s
    walker.set_out((1 - PIVOT_SHORTENING) * size)
    walker.turn(start_s, pivots=True)
    strides = max(2, math.ceil(walker.timeline.turn_time * walker.timeline.frequency_hz))
    walker.stop_after(strides)


def _walk_on(walker: Walker, parameters: TenMetresParameters, size: float) -> list[tuple[float, float]]:
    """Without standing: a turn at each end, also after the last trial."""
    walks = []
    walker.set_out(size)
    start_s, ahead_m = walker.now_s, parameters.walkway
    for _ in range(parameters.trials):
        turn_s = walker.turn_at(ahead_m)
        walks.append((start_s, turn_s + parameters.turn_time / 2))
        walker.turn(turn_s)
        start_s, ahead_m = turn_s + parameters.turn_time / 2, parameters.walkway - ahead_m
    walker.stop(walker.now_s + STRIDES_AFTER_TIME / walker.timeline.frequency_hz)
    return walks
