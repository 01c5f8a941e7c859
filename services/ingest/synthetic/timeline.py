"""When a synthetic person stands, moves and turns: phase, amplitude and heading over time, with two derivatives."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from services.ingest.synthetic.jets import Array, Jet, smooth_step
from services.ingest.synthetic.parameters import SessionParameters, WalkParameters
from services.ingest.synthetic.tempo import OwnPace, Tempo

RESTING_PHASE = 0.56
"""Stride phase at which every walk begins and ends: within double support, the right foot about to leave."""

WALK_RATIO = 0.0061
"""m per (steps/min): step length over cadence, near constant over an adult's speeds (order of Sekiya 1998)."""

TURN_SHORTENING = 0.4
"""Share by which steps are shorter in the middle of a turn."""


def stride_frequency_hz(speed: float) -> float:
    """Strides per second at a walking speed in m/s: speed = step length x cadence, step length = ratio x cadence."""
    steps_per_min = math.sqrt(60 * speed / WALK_RATIO)
    return steps_per_min / 120


class Bout(NamedTuple):
    """One walk without a stop, s; `strides` whole strides long, `first_phase` when it begins."""

    start_s: float
    end_s: float
    first_phase: float


@dataclass(frozen=True)
class Timeline:
    """The schedule of one session."""

    bouts: tuple[Bout, ...]
    turns: tuple[tuple[float, float], ...]  # start s, angle rad
    turn_time: float
    tempo: Tempo

    @classmethod
    def plan(cls, parameters: WalkParameters) -> "Timeline":
        """Standing, then walks and pauses until the end."""
        tempo = OwnPace.drawn(stride_frequency_hz(parameters.speed), parameters.wander, parameters.seed)
        bouts = plan_bouts(parameters, tempo)
        return cls(bouts, _plan_turns(parameters, bouts), parameters.turn_time, tempo)

    @property
    def frequency_hz(self) -> float:
        """Strides per second, nominal."""
        return self.tempo.frequency_hz

    def phase(self, time_s: Array) -> Jet:
        """Strides since the start; stands still between the walks."""
        phase = Jet.constant(RESTING_PHASE, time_s)
        for bout in self.bouts:
            walking = (time_s > bout.start_s) & (time_s <= bout.end_s)
            advanced = self.tempo.walked(bout.start_s, time_s)
            last = float(np.round(self.tempo.walked(bout.start_s, np.array([bout.end_s])).value[0]))
            phase = Jet(
                np.where(walking, bout.first_phase + advanced.value, phase.value),
                np.where(walking, advanced.rate, phase.rate),
                np.where(walking, advanced.acceleration, phase.acceleration),
            )
            phase.value[time_s > bout.end_s] = bout.first_phase + last
        return phase

    def amplitude(self, time_s: Array) -> Jet:
        """0 standing, 1 walking; rises over the first stride of a walk and falls over its last."""
        amplitude = Jet.constant(0.0, time_s)
        stride_s = 1 / self.frequency_hz
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        for bout in self.bouts:
            rise = clock.through(smooth_step(bout.start_s, bout.start_s + stride_s))
            fall = clock.through(smooth_step(bout.end_s - stride_s, bout.end_s))
            amplitude = amplitude + rise + fall.scaled(-1.0)
        for start_s, _ in self.turns:
            amplitude = amplitude * _dip(clock, start_s, self.turn_time)
        return amplitude

    def heading(self, time_s: Array) -> Jet:
        """Direction of the walk, rad about world y, to the left positive."""
        heading = Jet.constant(0.0, time_s)
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        for start_s, angle in self.turns:
            heading = heading + clock.through(smooth_step(start_s, start_s + self.turn_time)).scaled(angle)
        return heading

    def walking(self, time_s: Array) -> "np.typing.NDArray[np.bool_]":
        """True within a walk."""
        within = [(time_s > bout.start_s) & (time_s <= bout.end_s) for bout in self.bouts]
        return np.any(within, axis=0) if within else np.zeros(len(time_s), dtype=bool)


def plan_bouts(parameters: SessionParameters, tempo: Tempo) -> tuple[Bout, ...]:
    """Bouts of whole strides, with pauses between them and at the end."""
    bouts: list[Bout] = []
    start_s, phase = parameters.standing, RESTING_PHASE
    latest_end = parameters.duration - min(parameters.pause, 0.2 * parameters.duration)
    while True:
        wanted = latest_end if parameters.stop_every == 0 else min(start_s + parameters.stop_every, latest_end)
        strides = math.floor(float(tempo.walked(start_s, np.array([wanted])).value[0]))
        if strides < 3:
            return tuple(bouts)
        end_s = time_of(tempo, start_s, strides, wanted)
        bouts.append(Bout(start_s, end_s, phase))
        start_s, phase = end_s + parameters.pause, phase + strides


def time_of(tempo: Tempo, start_s: float, strides: int, latest_s: float) -> float:
    """When so many strides are done, by bisection: frequency is positive, so strides grow with time."""
    low, high = start_s, latest_s
    for _ in range(60):
        middle = (low + high) / 2
        if float(tempo.walked(start_s, np.array([middle])).value[0]) < strides:
            low = middle
        else:
            high = middle
    return high


def _dip(clock: Jet, start_s: float, length_s: float) -> Jet:
    """1, but lower by TURN_SHORTENING in the middle of a turn."""
    third = length_s / 3
    down = clock.through(smooth_step(start_s, start_s + third)).scaled(-TURN_SHORTENING)
    up = clock.through(smooth_step(start_s + 2 * third, start_s + length_s)).scaled(TURN_SHORTENING)
    return (down + up).shifted(1.0)


def _plan_turns(parameters: WalkParameters, bouts: tuple[Bout, ...]) -> tuple[tuple[float, float], ...]:
    if parameters.turn_every == 0:
        return ()
    turns: list[tuple[float, float]] = []
    period = max(parameters.turn_every, 1.5 * parameters.turn_time)
    for bout in bouts:
        start_s = bout.start_s + period
        while start_s + parameters.turn_time < bout.end_s - 1.0:
            turns.append((start_s, parameters.turn_angle * (-1.0) ** len(turns)))
            start_s += period
    return tuple(turns)
