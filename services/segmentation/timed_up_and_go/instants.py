"""What is looked at: posture, heading and steps at one instant, from whatever is worn."""

import math
from typing import NamedTuple

import numpy as np

from schemas.vocabulary import Segment, Side
from services.flow.node import State
from services.segmentation.batch import INDEX, Array, Batch
from services.segmentation.gait.lone_motion import Motion
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters

SIDES = (Side.LEFT, Side.RIGHT)
_THIGHS = tuple(Segment(f"thigh_{side}") for side in SIDES)
_SHANKS = tuple(Segment(f"shank_{side}") for side in SIDES)
_HIPS = [INDEX[f"hip_flexion_{side}"] for side in SIDES]
_KNEES = [INDEX[f"knee_flexion_{side}"] for side in SIDES]
_TILT, _HEADING = INDEX["pelvis_tilt"], INDEX["pelvis_rotation"]


class Instant(NamedTuple):
    """One instant; what no sensor sees is None."""

    captured_ns: int
    heading: float  # rad, of the pelvis or of the one leg that is worn
    thigh: float | None  # rad, inclination of the thighs, forward positive: 0 upright, pi/2 on a chair
    thigh_rate: float | None  # rad/s
    lean: float | None  # rad, of the pelvis, forward positive
    lean_rate: float | None  # rad/s
    upward: float | None  # m/s, vertical speed of the pelvis, where it alone is worn
    bounces: int | None  # its ups and downs so far, where it alone is worn: one a step


class Sight(NamedTuple):
    """The samples of one batch, column by column."""

    thigh: Array | None
    thigh_rate: Array | None
    lean: Array | None
    lean_rate: Array | None
    heading: Array
    shank_rate: Array  # (n, 2) rad/s, forward positive
    sees_shank: tuple[bool, bool]


def sight(batch: Batch) -> Sight:
    """Sagittal inclinations from the chain of angles.

    A thigh is inclined forward by hip flexion - pelvis tilt, a shank by that - knee flexion. Both stand in the world
    although the joints between may not be known one by one: only the sums are used. With both thighs the mean, in
    which the steps of the legs cancel.
    """
    p, v, seen = batch.position, batch.velocity, batch.observed
    hips = [hip for hip, segment in zip(_HIPS, _THIGHS, strict=True) if segment in seen]
    thigh = p[:, hips].mean(axis=1) - p[:, _TILT] if hips else None
    thigh_rate = v[:, hips].mean(axis=1) - v[:, _TILT] if hips else None
    sees_pelvis = Segment.PELVIS in seen
    left, right = (segment in seen for segment in _SHANKS)
    return Sight(
        thigh,
        thigh_rate,
        p[:, _TILT] if sees_pelvis else None,
        v[:, _TILT] if sees_pelvis else None,
        p[:, _HEADING],
        v[:, _HIPS] - v[:, [_TILT]] - v[:, _KNEES],
        (left, right),
    )


class VerticalSpeed:
    """How fast the pelvis goes up, from its upward acceleration: integrated, forgetting, zero where it rests.

    dw/dt = a - b - w / tau, b the mean of what is felt at rest; tau is short while the person steps, when no climb or
    fall lasts. A bounce is a fall of the smoothed acceleration below -c and a rise beyond c after it.
    """

    def __init__(self, parameters: TimedUpAndGoParameters) -> None:
        self._parameters = parameters
        self.speed, self.bounces = 0.0, 0
        self._bias = self._smooth = 0.0
        self._falls = False
        self._bounced_ns: int | None = None
        self._last_ns: int | None = None
        self._still_since_ns: int | None = None

    def step(self, captured_ns: int, motion: Motion) -> None:
        """Take a sample in the pelvis's heading frame."""
        p = self._parameters
        dt_s = 0.0 if self._last_ns is None else min((captured_ns - self._last_ns) * 1e-9, 0.2)
        self._last_ns = captured_ns
        upward = motion.acceleration[1] - self._bias
        turning = math.hypot(*motion.angular_velocity)
        steps = self._bounced_ns is not None and captured_ns - self._bounced_ns < p.stepping_s * 1e9
        self.speed += dt_s * (upward - self.speed / (p.stepping_memory_s if steps else p.speed_memory_s))
        self._smooth += min(1.0, dt_s / p.bounce_smoothing_s) * (upward - self._smooth)
        if self._falls and self._smooth > p.bounce:
            self.bounces += 1
            self._bounced_ns = captured_ns
        if abs(self._smooth) > p.bounce:
            self._falls = self._smooth < 0
        if abs(upward) > p.still_acceleration or turning > p.still_turning:
            self._still_since_ns = None
        elif self._still_since_ns is None:
            self._still_since_ns = captured_ns
        elif captured_ns - self._still_since_ns >= p.still_for_s * 1e9:
            self.speed = 0.0
            self._bias += min(1.0, dt_s / p.bias_memory_s) * upward

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "speed": self.speed,
            "bounces": self.bounces,
            "bias": self._bias,
            "smooth": self._smooth,
            "falls": self._falls,
            "bounced_ns": self._bounced_ns,
            "last_ns": self._last_ns,
            "still_since_ns": self._still_since_ns,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.speed, self.bounces = state["speed"], state["bounces"]
        self._bias, self._smooth, self._falls = state["bias"], state["smooth"], state["falls"]
        self._bounced_ns, self._last_ns = state["bounced_ns"], state["last_ns"]
        self._still_since_ns = state["still_since_ns"]


def instant(captured_ns: int, seen: Sight, i: int, pelvis: VerticalSpeed | None) -> Instant:
    """Sample `i` of a batch."""
    columns = (seen.thigh, seen.thigh_rate, seen.lean, seen.lean_rate)
    thigh, thigh_rate, lean, lean_rate = (None if column is None else float(column[i]) for column in columns)
    upward, bounces = (None, None) if pelvis is None else (pelvis.speed, pelvis.bounces)
    return Instant(captured_ns, float(seen.heading[i]), thigh, thigh_rate, lean, lean_rate, upward, bounces)


def rates_of(seen: Sight) -> list[list[float]]:
    """Forward rates of the shanks (left, right), rad/s; never positive where a shank is not seen."""
    hidden = np.where(seen.sees_shank, np.inf, 0.0)
    return np.minimum(seen.shank_rate, hidden).tolist()  # type: ignore[no-any-return]
