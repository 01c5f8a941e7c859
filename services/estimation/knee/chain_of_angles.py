"""Legs as joint coordinates of the lower body: rows whose chain of angles gives thigh and shank their tilt and turning.

pelvis_rotation is where the leg faces, from the start on; hip_flexion the thigh's inclination, as if the pelvis were
upright; then hip_flexion - knee_flexion is the shank's. Of two legs that of the first valid one is the heading.
"""

from collections.abc import Sequence
from math import pi

import numpy as np

from schemas.vocabulary import LOWER_BODY, Side
from services.biomech.rhythm.trusted import TrustedRhythm
from services.estimation.knee.leg import LegState
from services.estimation.parameters import KneeParameters
from services.estimation.rows import INDEX, RHYTHM_CHANNELS, Row
from services.flow.node import State

HEADING = INDEX["pelvis_rotation"]
_CHANNELS = [INDEX[name] for name in RHYTHM_CHANNELS]


class ChainOfAngles:
    """Of the legs on `sides`, in their order."""

    def __init__(self, sides: Sequence[Side], rhythm: TrustedRhythm, parameters: KneeParameters) -> None:
        self._places = [(INDEX[f"hip_flexion_{side}"], INDEX[f"knee_flexion_{side}"]) for side in sides]
        self._parameters = parameters
        self._heading = 0.0
        # Per leg: rates of hip and knee at the sample before, and their smoothed accelerations.
        self._rates = [[0.0, 0.0] for _ in sides]
        self._accelerations = [[0.0, 0.0] for _ in sides]
        self._last_ns: int | None = None
        self.rhythm = rhythm

    def row(self, captured_ns: int, states: Sequence[LegState | None]) -> Row:
        """The row of one instant, one state per leg; None for a leg that is not there yet."""
        dt_s = 0.0 if self._last_ns is None else (captured_ns - self._last_ns) / 1e9
        self._last_ns = captured_ns
        size, p = len(LOWER_BODY), self._parameters
        position, velocity, acceleration = [0.0] * size, [0.0] * size, [0.0] * size
        position_std, velocity_std = [p.unworn_std] * size, [p.unworn_std] * size
        turn_rate = next((s.sample.turn_rate for s in states if s is not None and s.is_valid), 0.0)
        self._heading += turn_rate * dt_s
        position[HEADING], velocity[HEADING], position_std[HEADING] = self._heading, turn_rate, p.heading_std
        for leg, (state, (hip, knee)) in enumerate(zip(states, self._places, strict=True)):
            if state is None:
                continue
            sample = state.sample
            position[hip], velocity[hip] = sample.inclination, sample.inclination_rate
            position[knee], velocity[knee] = sample.flexion, sample.flexion_rate
            acceleration[hip], acceleration[knee] = self._accelerate(leg, state, dt_s)
            position_std[hip], position_std[knee] = p.inclination_std, sample.flexion_std
            velocity_std[hip] = velocity_std[knee] = p.rate_std
        reading = self.rhythm.step(np.array([velocity[channel] for channel in _CHANNELS]), dt_s)
        return Row(captured_ns, position, velocity, acceleration, position_std, velocity_std, reading)

    def _accelerate(self, leg: int, state: LegState, dt_s: float) -> tuple[float, float]:
        """rad/s^2 of hip and knee: differences of the rates, low-passed; 0 while nothing is known."""
        rates = (state.sample.inclination_rate, state.sample.flexion_rate)
        smoothed = self._accelerations[leg]
        for k, rate in enumerate(rates):
            if dt_s > 0.0 and state.sample.is_known:
                gain = dt_s / (dt_s + 0.5 / (pi * self._parameters.smoothing_hz))
                smoothed[k] += gain * ((rate - self._rates[leg][k]) / dt_s - smoothed[k])
            else:
                smoothed[k] = 0.0
            self._rates[leg][k] = rate
        return smoothed[0], smoothed[1]

    def validity(self, states: Sequence[LegState | None]) -> list[bool]:
        """Per LOWER_BODY coordinate: only knee flexions ever are."""
        valid = [False] * len(LOWER_BODY)
        for state, (_, knee) in zip(states, self._places, strict=True):
            valid[knee] = state is not None and state.is_valid
        return valid

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "heading": self._heading,
            "rates": [list(each) for each in self._rates],
            "accelerations": [list(each) for each in self._accelerations],
            "last_ns": self._last_ns,
            "rhythm": self.rhythm.snapshot(),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._heading, self._last_ns = state["heading"], state["last_ns"]
        self._rates = [list(each) for each in state["rates"]]
        self._accelerations = [list(each) for each in state["accelerations"]]
        self.rhythm.restore(state["rhythm"])
