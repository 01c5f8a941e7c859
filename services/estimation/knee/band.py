"""`knee_band` and `knee_band_grover`: a band whose sensors are worn as declared, in the plane of the leg."""

from collections.abc import Sequence
from math import cos, hypot, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription
from services.biomech.two_sensor_knee.grover import GroverParameters, PlanarSample, SimplifiedKnee, wrapped
from services.biomech.two_sensor_knee.knee_band import KneeBand
from services.estimation.knee.estimator import Evidence, Fitting, Kept, KneeSample, frame_from_axis_and_up
from services.estimation.knee.mounting import leftward, upward
from services.estimation.knee.plane import Plane, plane_of
from services.flow.node import State

Array = NDArray[np.float64]

BAND_QUALITY = 0.5
"""Of axes that nobody measured: straps are put on to some degrees."""
BAND_DATUM = "the band's own axes: zero where both sensors' upward axes are parallel"
MARKED_DATUM = "the standing that was marked: thigh and shank vertical"
GROVER_STD = 0.065
"""rad (3.7 deg), the published largest difference between both filters in walking: the method itself states none."""
LONGEST_STEP_S = 10.0


class _Angles(NamedTuple):
    """About the flexion axis, rad and rad/s."""

    thigh: float
    flexion: float
    flexion_std: float
    bias: tuple[float, float]
    is_known: bool


class _Band:
    """What both bands share. Raises ValueError where the description does not say how the sensors are worn."""

    def __init__(self, sensors: Sequence[SensorDescription]) -> None:
        self._plane = _declared_plane(sensors)
        self._zeros = (0.0, 0.0)
        self._is_marked = False
        self._last = KneeSample(0.0, pi, 0.0, 0.0, 0.0, 0.0, False)
        self._bias = (0.0, 0.0)

    @property
    def kept_s(self) -> float:
        """Nothing of before is estimated again: the method has no second look."""
        return 0.0

    @property
    def is_ready(self) -> bool:
        """From the first angle on."""
        return self._last.is_known

    @property
    def is_fitted(self) -> bool:
        """The band's axes are declared."""
        return True

    def _sample(self, kept: Kept, angles: _Angles) -> KneeSample:
        """The angles with their rates, from the declared or marked zero."""
        plane, (thigh_zero, knee_zero) = self._plane, self._zeros
        self._bias = angles.bias
        thigh = float(kept.rate[0] @ plane.axes[0]) - angles.bias[0]
        shank = float(kept.rate[1] @ plane.axes[1]) - angles.bias[1]
        up = cos(angles.thigh) * plane.along[0] - sin(angles.thigh) * plane.across[0]
        self._last = KneeSample(
            flexion=wrapped(angles.flexion - knee_zero),
            flexion_std=angles.flexion_std,
            flexion_rate=shank - thigh,
            # The axis points left: a turn about it leans the thigh back.
            inclination=-wrapped(angles.thigh - thigh_zero),
            inclination_rate=-thigh,
            turn_rate=float(up @ kept.rate[0]),
            is_known=angles.is_known,
        )
        return self._last

    def again(self, kept: list[Kept]) -> list[KneeSample | None]:
        """The newest sample alone."""
        nothing: list[KneeSample | None] = [None] * (len(kept) - 1)
        return [*nothing, self._last]

    def stand(self, up: Array) -> None:
        """Zero is where these verticals were measured."""
        thigh, shank = self._plane.tilts(up)
        self._zeros, self._is_marked = (thigh, wrapped(shank - thigh)), True

    def finish(self) -> None:
        """Nothing was waited for."""

    def fitting(self) -> Fitting:
        """The declared axes, turned by the marked zero."""
        plane = self._plane
        turns = (self._zeros[0], self._zeros[0] + self._zeros[1])
        ups = [cos(a) * plane.along[s] - sin(a) * plane.across[s] for s, a in enumerate(turns)]
        frames = np.stack([frame_from_axis_and_up(plane.axes[s], ups[s]) for s in range(2)])
        bias = plane.axes * np.array(self._bias)[:, None]
        return Fitting(frames, bias, BAND_QUALITY, MARKED_DATUM if self._is_marked else BAND_DATUM, "as declared")

    def evidence(self) -> Evidence | None:
        """The band is told how it is worn."""
        return None

    def _pack(self) -> State:
        return {
            "zeros": list(self._zeros), "is_marked": self._is_marked, "last": list(self._last),
            "bias": list(self._bias),
        }  # fmt: skip

    def _unpack(self, state: State) -> None:
        thigh, knee = state["zeros"]
        self._zeros, self._is_marked = (thigh, knee), state["is_marked"]
        self._last = KneeSample(*state["last"])
        first, second = state["bias"]
        self._bias = (first, second)


class OurBand(_Band):
    """Biases followed while it runs; known from the first samples."""

    def __init__(self, sensors: Sequence[SensorDescription]) -> None:
        super().__init__(sensors)
        self._band = KneeBand(self._plane.axes, self._plane.along)

    @property
    def wish(self) -> str:
        """Nothing is needed."""
        return ""

    def step(self, kept: Kept) -> KneeSample:
        """Take one sample."""
        band = self._band
        reading = band.step(kept.rate, kept.force, min(kept.dt_s, LONGEST_STEP_S))
        bias = (band.thigh.bias, band.shank.bias)
        return self._sample(
            kept, _Angles(band.thigh.angle, reading.flexion, reading.flexion_std, bias, reading.is_valid)
        )

    def snapshot(self) -> State:
        """Everything that changes."""
        return {**self._pack(), "band": self._band.snapshot()}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._unpack(state)
        self._band.restore(state["band"])


class PublishedBand(_Band):
    """The simplified filter as published, at its 20 Hz: the newest sample at each step, and rows only then."""

    def __init__(self, sensors: Sequence[SensorDescription]) -> None:
        super().__init__(sensors)
        self._parameters = GroverParameters()
        self._knee = SimplifiedKnee(self._parameters)
        self._since_s = 0.0
        self._learned = 0

    @property
    def wish(self) -> str:
        """How far the biases are."""
        return f"The gyroscopes' biases are being learned: {self._learned} of {self._parameters.debias_samples} samples"

    def step(self, kept: Kept) -> KneeSample | None:
        """Take one sample; None between the instants of the published rate, and while biases are learned."""
        step_s = 1.0 / self._parameters.rate_hz
        self._since_s += kept.dt_s
        # Half a millisecond for time stamps that are rounded.
        if self._since_s < step_s - 5e-4:
            return None
        self._since_s = max(0.0, self._since_s - step_s) if self._since_s < 2.0 * step_s else 0.0
        thigh, shank = self._plane.tilts(kept.force)
        rates = np.sum(kept.rate * self._plane.axes, axis=1).tolist()
        flexion = self._knee.step(PlanarSample(rates[0], thigh, rates[1], shank), step_s)
        if flexion is None:
            self._learned += 1
            return None
        angles = (self._knee.thigh.angle, flexion, GROVER_STD)
        return self._sample(kept, _Angles(*angles, (self._knee.thigh_bias, self._knee.shank_bias), True))

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            **self._pack(), "knee": self._knee.snapshot(), "since_s": self._since_s, "learned": self._learned,
        }  # fmt: skip

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._unpack(state)
        self._knee.restore(state["knee"])
        self._since_s, self._learned = state["since_s"], state["learned"]


def _declared_plane(sensors: Sequence[SensorDescription]) -> Plane:
    axes, ups = [], []
    for sensor in sensors:
        left, up = leftward(sensor), upward(sensor)
        if left is None or up is None or hypot(*np.cross(left, up)) < 0.5:
            raise ValueError(
                f"a knee band must be told how it is worn: give sensor {sensor.name} a placement and an upward_axis, "
                "or choose the estimator knee_axis, which finds out by itself"
            )
        axes.append(left)
        ups.append(up)
    return plane_of(np.array(axes), np.array(ups))
