"""`knee_axis`: our self-finding axis in a session, with a zero even where nobody stood."""

from collections.abc import Sequence
from math import pi

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription
from services.biomech.rotations import rotation_about
from services.biomech.two_sensor_knee.grover import wrapped
from services.biomech.two_sensor_knee.knee_axis import Datum, KneeAxis, KneeReading
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters
from services.estimation.knee.estimator import (
    Evidence,
    Fitting,
    Kept,
    KneeSample,
    frame_from_axis_and_up,
    thigh_motion,
)
from services.estimation.knee.mounting import leftward, upward
from services.estimation.parameters import KneeParameters
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]

DECLARE_S = 0.5
"""s between declarations of an operator's standing: an axis that becomes better moves the zero a little."""

BEND = "Bend and stretch the knee a few times"
STAND = "Stand still and upright for two seconds, then bend the knee: which way it bends is not known yet"

DATUMS = {
    Datum.STANDING: "quiet standing: thigh and shank vertical",
    Datum.SET: "the standing that was marked: thigh and shank vertical",
    Datum.START: (
        "the straightest the knee had been when its axis was found, taken for 5 degrees; nobody stood still, so "
        "angles are right as changes"
    ),
}


class FoundAxis:
    """One leg, its sensors thigh first."""

    def __init__(self, sensors: Sequence[SensorDescription], parameters: KneeParameters) -> None:
        self._parameters = parameters
        self._axis = KneeAxis(KneeAxisParameters())
        self._left = np.array([_or_zero(leftward(sensor)) for sensor in sensors])
        self._up = np.array([_or_zero(upward(sensor)) for sensor in sensors])
        self._axis.declare_mounting(self._left, self._up)
        self._believed_s = 0.0
        self._ready = False
        self._straight: float | None = None
        self._declared: Array | None = None
        self._since_declared_s = 0.0
        self._senseless_s = 0.0
        self._last = KneeSample(0.0, pi, 0.0, 0.0, 0.0, 0.0, False)

    @property
    def kept_s(self) -> float:
        """s of samples before the angle is believed that `again` can use."""
        return self._parameters.kept_s

    @property
    def is_ready(self) -> bool:
        """The axis is known well, or has been believed for a while, and so is the sense of flexion."""
        return self._ready

    @property
    def is_fitted(self) -> bool:
        """Whether there is an axis, however well it is known."""
        return self._axis.has_angle

    @property
    def wish(self) -> str:
        """What the person should do for the angle to be believed."""
        return STAND if self._senseless_s > self._parameters.sense_s else BEND

    def step(self, kept: Kept) -> KneeSample:
        """Take one sample."""
        reading = self._advance(kept)
        believed = self._axis.has_angle and reading.is_valid
        self._believed_s = self._believed_s + kept.dt_s if believed else 0.0
        self._senseless_s = self._senseless_s + kept.dt_s if self._is_axis_known(reading) and not believed else 0.0
        is_good = reading.axis_std <= self._parameters.good_axis_std
        self._ready = believed and (self._ready or is_good or self._believed_s >= self._parameters.longest_wait_s)
        self._last = self._read(reading, kept)
        return self._last

    def again(self, kept: list[Kept]) -> list[KneeSample | None]:
        """Back to before the samples and through them once more; where nobody stood they tell the zero."""
        rates, forces = np.array([each.rate for each in kept]), np.array([each.force for each in kept])
        self._axis.rewind(rates, forces, np.array([max(each.dt_s, 1e-6) for each in kept]))
        samples = [self._read(self._advance(each), each) for each in kept]
        if self._axis.reading().datum is Datum.START:
            shift = self._straightest(samples)
            self._straight = (self._straight or 0.0) + shift
            samples = [sample._replace(flexion=wrapped(sample.flexion - shift)) for sample in samples]
        self._last = samples[-1]
        return list(samples)

    def stand(self, up: Array) -> None:
        """Zero is where these verticals are one, from now on; the axis may still have to be found."""
        self._declared = np.asarray(up / np.linalg.norm(up, axis=1)[:, None])
        self._axis.declare_standing(self._declared)
        self._since_declared_s = 0.0

    def finish(self) -> None:
        """An axis that is believed now will do."""
        self._ready = self._ready or self._believed_s > 0.0

    def _advance(self, kept: Kept) -> KneeReading:
        if self._declared is not None:
            self._since_declared_s += kept.dt_s
            if self._since_declared_s >= DECLARE_S or self._axis.reading().datum is not Datum.SET:
                self._axis.declare_standing(self._declared)
                self._since_declared_s = 0.0
        slips = self._axis.slips
        reading = self._axis.step(kept.rate, kept.force, kept.dt_s)
        if self._axis.slips > slips:
            # A sensor that slipped no longer lies as it did in that standing.
            self._declared, self._straight = None, None
        return reading

    def _is_axis_known(self, reading: KneeReading) -> bool:
        return self._axis.has_angle and reading.axis_std < self._axis.parameters.axis_to_believe

    def _read(self, reading: KneeReading, kept: Kept) -> KneeSample:
        """The sample as it is published; the last angles where there is none."""
        axis = self._axis
        if not (axis.has_angle and reading.is_valid):
            return self._last._replace(flexion_rate=0.0, inclination_rate=0.0, turn_rate=0.0, is_known=False)
        flexion = reading.flexion
        if reading.datum is Datum.START and self._straight is not None:
            flexion = wrapped(flexion - self._straight)
        rate = kept.rate[0] - axis.gyro_bias[0]
        inclination, forward_rate, turn_rate = thigh_motion(
            axis.axes[0], self._thigh_up(reading.datum), axis.up[0], rate
        )
        inclination += axis.parameters.sample_delay_s * forward_rate
        return KneeSample(
            flexion, reading.flexion_std, reading.flexion_rate, inclination, forward_rate, turn_rate, True
        )

    def _thigh_up(self, datum: Datum) -> Array:
        """Up the thigh (3,) in its sensor: the vertical of standing, else as declared, else from knee to sensor."""
        axis = self._axis
        if datum is Datum.SET and self._declared is not None:
            return np.asarray(self._declared[0])
        if datum is Datum.STANDING:
            return np.asarray(axis.standing[0])
        if self._up[0].any():
            return np.asarray(self._up[0])
        arm = axis.arms[0]
        return np.asarray(-arm if np.linalg.norm(arm) >= axis.parameters.shortest_arm else axis.up[0])

    def _straightest(self, samples: list[KneeSample]) -> float:
        """The angle taken for zero where nobody stood: the straightest known, less what a straight knee bends."""
        flexion = [sample.flexion for sample in samples if sample.is_known]
        if not flexion:
            return 0.0
        return float(np.quantile(flexion, self._parameters.straightest_share)) - self._parameters.straightest

    def fitting(self) -> Fitting:
        """How both sensors sit; at flexion q the shank's up is the thigh's, turned by q about the axis."""
        axis, reading = self._axis, self._axis.reading()
        thigh, shank = axis.axes
        thigh_up = self._thigh_up(reading.datum)
        shank_up = axis.R_thigh_from_shank.T @ rotation_about(thigh, self._last.flexion) @ thigh_up
        frames = np.stack([frame_from_axis_and_up(thigh, thigh_up), frame_from_axis_and_up(shank, shank_up)])
        quality = min(1.0, max(0.0, 1.0 - reading.axis_std / axis.parameters.axis_to_believe))
        if reading.datum is Datum.START:
            quality = min(quality, self._parameters.population_quality)
        return Fitting(frames, axis.gyro_bias, quality, DATUMS[reading.datum], "motion: the axis of the knee itself")

    def evidence(self) -> Evidence:
        """Arms and axes as far as the motion has told them."""
        axis, reading = self._axis, self._axis.reading()
        signed = self._is_axis_known(reading) and reading.is_sign_known
        return Evidence(axis.arms if axis.is_joint_known else None, axis.up, axis.axes if signed else None)

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "axis": self._axis.snapshot(),
            "times_s": [self._believed_s, self._since_declared_s, self._senseless_s],
            "ready": self._ready,
            "straight": self._straight,
            "declared": None if self._declared is None else pack_array(self._declared),
            "last": list(self._last),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._axis.restore(state["axis"])
        self._believed_s, self._since_declared_s, self._senseless_s = state["times_s"]
        self._ready, self._straight = state["ready"], state["straight"]
        self._declared = None if state["declared"] is None else unpack_array(state["declared"])
        self._last = KneeSample(*state["last"])


def _or_zero(direction: Array | None) -> Array:
    return np.zeros(3) if direction is None else direction
