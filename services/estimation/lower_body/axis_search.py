"""How each sensor sits on its segment: its vertical from standing, its flexion axis from the first steps.

Thigh and shank: the angular velocity, low-passed, is projected on the plane perpendicular to the standing vertical;
its first principal direction is the flexion axis. Projection matters: without it the thigh's axis comes out 44-51
degrees wrong on a recorded walk, with it 13-14. Pelvis: rotation about the vertical rules its gyroscope, so the
frame comes from the side of the body the sensor is worn on (5 degrees).

Axis signs come from the placement where that is clear, else from the walk: the shank turns fastest while it swings
forward, and the thigh leads it; the foot's toes point down farther than up.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter
from scipy.signal import butter, lfilter

from schemas.session import Placement, SensorDescription
from schemas.vocabulary import Segment
from services.biomech.rotations import angle_between, frame_from_up_and_right, normalised
from services.estimation.alignment import Alignment
from services.estimation.parameters import AlignmentParameters
from services.estimation.samples import RATE
from services.estimation.standing import StandingReference

Array = NDArray[np.float64]

LEGS = (
    (Segment.THIGH_RIGHT, Segment.SHANK_RIGHT, Segment.FOOT_RIGHT),
    (Segment.THIGH_LEFT, Segment.SHANK_LEFT, Segment.FOOT_LEFT),
)
PELVIS_QUALITY = {True: 0.9, False: 0.2}
"""Quality of a pelvis frame whose placement is known or not."""
PLACED_QUALITY = 0.3
"""Quality of a leg frame that rests on the placement alone."""


@dataclass(frozen=True)
class FlexionAxis:
    """Flexion axis of one leg sensor, in its frame, perpendicular to the standing vertical."""

    right: Array  # (3,) unit vector, points to the body's right
    ratio: float  # second to first principal value of the projected rate, 0 a pure hinge, 1 no axis
    moving_s: float  # s of motion it rests on
    fastest: float  # rad/s about the axis
    sign_is_placed: bool  # the placement decided the sign


def placed_right(sensor: SensorDescription, up: Array) -> Array | None:
    """The body's right in the sensor frame, (3,), as the placement tells it; None when it does not.

    `up` (3,) is the standing vertical in the sensor frame. Right = forward x up; outward is forward for an anterior
    sensor, and right for a lateral one on the right side.
    """
    outward = np.array(sensor.outward_axis, dtype=np.float64)
    outward = outward - (outward @ up) * up
    if sensor.placement is Placement.UNKNOWN or np.linalg.norm(outward) < 0.2:
        return None
    outward = normalised(outward)
    if sensor.placement in (Placement.ANTERIOR, Placement.POSTERIOR):
        right = np.cross(outward, up)
        return right if sensor.placement is Placement.ANTERIOR else -right
    is_right_leg = sensor.segment.endswith("right")
    return outward if is_right_leg == (sensor.placement is Placement.LATERAL) else -outward


def low_pass(signal: Array, cutoff_hz: float, rate_hz: float) -> Array:
    """Causal second-order Butterworth over the first axis."""
    b, a = butter(2, min(cutoff_hz / (rate_hz / 2.0), 0.99))
    return np.asarray(lfilter(b, a, signal, axis=0))


def principal_direction(rate: Array, up: Array, moving_rate: float) -> tuple[Array, float, int]:
    """First principal direction of rate (n, 3) in the plane perpendicular to up, as a unit vector (3,);
    second over first principal value; number of samples that moved."""
    first = normalised(np.cross(up, np.eye(3)[np.argmin(np.abs(up))]))
    plane = np.vstack([first, np.cross(up, first)])
    flat = rate @ plane.T
    moving = flat[np.linalg.norm(flat, axis=1) > moving_rate]
    if len(moving) < 3:
        return first, 1.0, len(moving)
    values, vectors = np.linalg.eigh(moving.T @ moving)
    return vectors[:, 1] @ plane, float(max(values[0], 0.0) / values[1]), len(moving)


def foot_sign(foot: Array, rate_hz: float) -> float:
    """Sign for a foot, from its rate (n,) about the axis at hand.

    The foot is flat for most of the time, and the toes point farther down as it leaves the ground than up as it comes
    back: against its median over 2 s, the angle about +right has a negative third moment.
    """
    angle = np.cumsum(foot) / rate_hz
    angle = angle - median_filter(angle, size=max(1, round(2.0 * rate_hz)))
    return -1.0 if np.mean(angle**3) > 0.0 else 1.0


def walking_signs(thigh: Array | None, shank: Array, rate_hz: float) -> tuple[float, float]:
    """Signs for thigh and shank, from their rates (n,) about the axes at hand.

    Forward swing is a short fast turn about +right, stance a long slow one about -right: the third moment of the
    shank's rate is positive. The thigh turns the same way up to 0.3 s earlier.
    """
    shank_sign = 1.0 if np.mean(shank**3) >= 0.0 else -1.0
    if thigh is None:
        return 1.0, shank_sign
    leads = [np.mean(thigh[: len(thigh) - k] * shank[k:]) for k in range(int(0.3 * rate_hz))]
    strongest = max(leads, key=abs)
    return math.copysign(1.0, strongest) * shank_sign, shank_sign


class AxisSearch:
    """Flexion axes of the leg sensors from the samples at hand."""

    def __init__(
        self, sensors: Sequence[SensorDescription], reference: StandingReference, parameters: AlignmentParameters
    ) -> None:
        self.sensors = sensors
        self.reference = reference
        self.parameters = parameters

    @property
    def needs_no_axis(self) -> bool:
        """Only the lower back wears a sensor, and its frame comes from its placement."""
        return all(sensor.segment is Segment.PELVIS for sensor in self.sensors)

    def up(self, s: int) -> Array:
        """Standing vertical of a sensor, (3,)."""
        return normalised(self.reference.mean_force[s])

    def axes(self, samples: Array, fresh: NDArray[np.bool_]) -> dict[int, FlexionAxis]:
        """Axes from samples (n, S, 6), fresh (n, S), by sensor."""
        axes: dict[int, FlexionAxis] = {}
        for leg in LEGS:
            speaking = np.any(fresh[-self.parameters.silent_ticks :], axis=0).tolist()
            worn = {s: self._turning(s, samples, fresh) for s in self._wearing(*leg) if speaking[s]}
            signs = self._signs_by_walk({self.sensors[s].segment: found for s, found in worn.items()}, fresh, *leg)
            for s, (rates, axis, ratio, moving) in worn.items():
                placed = placed_right(self.sensors[s], self.up(s))
                sign = signs.get(self.sensors[s].segment, 1.0)
                decided = placed is not None and abs(float(axis @ placed)) > self.parameters.placement_decides
                if placed is not None and decided:
                    sign = math.copysign(1.0, float(axis @ placed))
                fastest = float(np.abs(rates @ axis).max(initial=0.0))
                axes[s] = FlexionAxis(sign * axis, ratio, moving / self.sensors[s].rate_hz, fastest, decided)
        return axes

    def _wearing(self, *segments: Segment) -> list[int]:
        return [s for s, sensor in enumerate(self.sensors) if sensor.segment in segments and self.reference.usable[s]]

    def _turning(self, s: int, samples: Array, fresh: NDArray[np.bool_]) -> tuple[Array, Array, float, int]:
        rate_hz = self.sensors[s].rate_hz
        rates = samples[fresh[:, s], s, RATE] - self.reference.gyro_bias[s]
        rates = low_pass(rates, self.parameters.cutoff_hz, rate_hz)
        return (rates, *principal_direction(rates, self.up(s), self.parameters.moving_rate))

    def _signs_by_walk(
        self,
        worn: dict[Segment, tuple[Array, Array, float, int]],
        fresh: NDArray[np.bool_],
        thigh: Segment,
        shank: Segment,
        foot: Segment,
    ) -> dict[Segment, float]:
        if shank not in worn:
            return self._foot_sign(worn, foot)
        rate_hz = self._rate_hz(shank)
        shank_rate = worn[shank][0] @ worn[shank][1]
        thigh_rate = worn[thigh][0] @ worn[thigh][1] if thigh in worn else None
        if thigh_rate is not None:
            thigh_rate, shank_rate = self._side_by_side(thigh_rate, shank_rate, fresh, thigh, shank)
        signs = walking_signs(thigh_rate, shank_rate, rate_hz)
        return dict(zip((thigh, shank), signs, strict=True))

    def _side_by_side(
        self, thigh_rate: Array, shank_rate: Array, fresh: NDArray[np.bool_], thigh: Segment, shank: Segment
    ) -> tuple[Array, Array]:
        """Rates of both at the same instants. Sensors that share no clock have none; their samples are counted off."""
        of = [fresh[:, next(s for s in self._wearing(segment))] for segment in (thigh, shank)]
        both = of[0] & of[1]
        length = min(len(thigh_rate), len(shank_rate))
        if both.sum() > length // 2:
            return thigh_rate[both[of[0]]], shank_rate[both[of[1]]]
        return thigh_rate[:length], shank_rate[:length]

    def _foot_sign(self, worn: dict[Segment, tuple[Array, Array, float, int]], foot: Segment) -> dict[Segment, float]:
        if foot not in worn:
            return {}
        return {foot: foot_sign(worn[foot][0] @ worn[foot][1], self._rate_hz(foot))}

    def _rate_hz(self, segment: Segment) -> float:
        return next(sensor.rate_hz for sensor in self.sensors if sensor.segment is segment)

    def is_clear(self, axes: dict[int, FlexionAxis], before: dict[int, FlexionAxis]) -> bool:
        """Every leg sensor has moved enough, swung, and kept its axis since the look before.

        Where the walk has to tell the sign of a shank's or a thigh's axis it takes longer. A foot rests half of the
        time and turns far the rest of it, so less of it will do.

        A sensor on the lower back alone has no axis to wait for.
        """
        limits = self.parameters
        if self.needs_no_axis:
            return True
        return bool(axes) and all(
            axis.moving_s >= self._least_moving_s(s, axis)
            and axis.fastest >= limits.swing_rate
            and axis.ratio <= limits.clearest_ratio
            and s in before
            and angle_between(axis.right, before[s].right) <= limits.steadiest_change
            for s, axis in axes.items()
        )

    def _least_moving_s(self, s: int, axis: FlexionAxis) -> float:
        if self.sensors[s].segment in (Segment.FOOT_LEFT, Segment.FOOT_RIGHT):
            return 0.5 * self.parameters.shortest_moving_s
        return self.parameters.shortest_moving_s * (1.0 if axis.sign_is_placed else 2.0)

    def is_moving(self, axes: dict[int, FlexionAxis]) -> bool:
        """Some leg sensor has moved enough to tell an axis; the lower back alone needs none."""
        return self.needs_no_axis or any(axis.moving_s >= self.parameters.shortest_moving_s for axis in axes.values())

    def align(self, axes: dict[int, FlexionAxis]) -> Alignment:
        """Frames of all sensors that standing and the axes allow."""
        count = len(self.sensors)
        frames, quality = np.tile(np.eye(3), (count, 1, 1)), np.zeros(count)
        aligned = np.zeros(count, dtype=np.bool_)
        for s, sensor in enumerate(self.sensors):
            if not self.reference.usable[s]:
                continue
            right, trust = self._right(s, sensor, axes)
            if right is not None:
                frames[s] = frame_from_up_and_right(self.reference.mean_force[s], right)
                quality[s], aligned[s] = trust, True
        return Alignment(frames, quality, aligned)

    def _right(self, s: int, sensor: SensorDescription, axes: dict[int, FlexionAxis]) -> tuple[Array | None, float]:
        placed = placed_right(sensor, self.up(s))
        if sensor.segment is Segment.PELVIS:
            if placed is None:
                behind = sensor.model_copy(update={"placement": Placement.POSTERIOR})
                placed = placed_right(behind, self.up(s))
                return placed, PELVIS_QUALITY[False]
            return placed, PELVIS_QUALITY[True]
        axis = axes.get(s)
        if axis is not None and axis.ratio <= self.parameters.clearest_ratio:
            return axis.right, 1.0 - math.sqrt(axis.ratio)
        return placed, PLACED_QUALITY
