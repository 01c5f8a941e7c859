"""`knee_axis_mcgrath`: the published axis on causal terms.

The published method sees a whole recording. Here samples are held until `mcgrath_motion_s` of motion have been seen;
the principal component of the relative rate is then the axis, what was held is published with it, and the axis stays.
Orientations are VQF's without magnetometer, so nothing ties the headings of the two sensors, as nothing ties them in
the publication but a magnetometer. Samples are taken as evenly spaced. Only the sense of the axis is ours: the
placement tells it where it can, since a principal component has none.
"""

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription
from services.biomech.rotations import matrix_from_quaternion
from services.biomech.two_sensor_knee.grover import wrapped
from services.biomech.two_sensor_knee.mcgrath import flexion_angle, knee_flexion, segment_frame
from services.estimation.knee.estimator import (
    Evidence,
    Fitting,
    Kept,
    KneeSample,
    frame_from_axis_and_up,
    thigh_motion,
)
from services.estimation.knee.mounting import leftward
from services.estimation.knee.plane import Plane
from services.estimation.parameters import KneeParameters
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]

MCGRATH_STD = 0.061
"""rad, the published zero-mean error (3.49 deg): the method itself states none."""
MCGRATH_DATUM = "the sensors' own x axes, as published; angles are right as changes"
MARKED_DATUM = "the standing that was marked: thigh and shank vertical"
MCGRATH_QUALITY = 0.5


class PublishedAxis:
    """One leg, its sensors thigh first. Raises ValueError where VQF is not installed."""

    def __init__(self, sensors: Sequence[SensorDescription], parameters: KneeParameters) -> None:
        self._sensors = sensors
        self._parameters = parameters
        self._filters = [_vqf(1.0 / max(sensor.rate_hz for sensor in sensors)) for _ in range(2)]
        self._held: list[tuple[Array, Array]] = []
        """Rates (2, 3) and quaternions (2, 4) until the axis is found."""
        self._held_s, self._moved_s = 0.0, 0.0
        self._axes: Array | None = None
        self._declared: Array | None = None
        self._zero = 0.0
        self._thigh_up = np.zeros(3)
        self._last = KneeSample(0.0, pi, 0.0, 0.0, 0.0, 0.0, False)

    @property
    def kept_s(self) -> float:
        """All that is held can be published."""
        return self._parameters.mcgrath_kept_s

    @property
    def is_ready(self) -> bool:
        """The axis has been found."""
        return self._axes is not None

    @property
    def is_fitted(self) -> bool:
        """The same: it is found once."""
        return self._axes is not None

    @property
    def wish(self) -> str:
        """How much motion is missing."""
        wanted = self._parameters.mcgrath_motion_s
        return f"Walk or bend the knee: {min(self._moved_s, wanted):.0f} of {wanted:.0f} s of motion"

    def step(self, kept: Kept) -> KneeSample:
        """Take one sample."""
        quats = np.zeros((2, 4))
        for s, each in enumerate(self._filters):
            each.update(np.ascontiguousarray(kept.rate[s]), np.ascontiguousarray(kept.force[s]))
            quats[s] = each.getQuat6D()
        if self._axes is None:
            self._hold(kept, quats)
        if self._axes is not None:
            self._last = self._read(kept.rate, quats)
        return self._last

    def _hold(self, kept: Kept, quats: Array) -> None:
        p = self._parameters
        self._held.append((kept.rate.copy(), quats))
        self._held_s += kept.dt_s
        fastest = float(np.linalg.norm(kept.rate, axis=1).max())
        self._moved_s += kept.dt_s if fastest > p.moving_rate else 0.0
        if self._moved_s >= p.mcgrath_motion_s or self._held_s >= p.mcgrath_kept_s:
            self._find()

    def _find(self) -> None:
        """The axis of what is held; without enough motion the older half is forgotten."""
        if self._moved_s < self._parameters.mcgrath_least_s:
            del self._held[: len(self._held) // 2]
            self._held_s *= 0.5
            return
        rates = np.array([rate for rate, _ in self._held])
        thigh, shank = ([matrix_from_quaternion(quats[s]) for _, quats in self._held] for s in range(2))
        _, axes = knee_flexion(np.array(thigh), np.array(shank), rates[:, 0], rates[:, 1])
        self._axes = _sense(self._sensors, axes, self._parameters.placement_decides) * axes
        # The vertical of the beginning stands for that of standing, until one is marked.
        self._thigh_up = thigh[0][2]
        if self._declared is not None:
            self.stand(self._declared)

    def _read(self, rate: Array, quats: Array) -> KneeSample:
        assert self._axes is not None
        thigh, shank = matrix_from_quaternion(quats[0]), matrix_from_quaternion(quats[1])
        flexion = float(flexion_angle((shank.T @ thigh)[None], self._axes[0], self._axes[1])[0])
        bias = self._bias()
        # VQF's world has z up.
        motion = thigh_motion(self._axes[0], self._thigh_up, thigh[2], rate[0] - bias[0])
        bend = float((rate[1] - bias[1]) @ self._axes[1] - (rate[0] - bias[0]) @ self._axes[0])
        return KneeSample(wrapped(flexion - self._zero), MCGRATH_STD, bend, *motion, True)

    def _bias(self) -> Array:
        return np.array([each.getBiasEstimate()[0] for each in self._filters])

    def again(self, kept: list[Kept]) -> list[KneeSample | None]:
        """What is held, with the axis that was found in it."""
        used = self._held[-len(kept) :]
        samples: list[KneeSample | None] = [self._read(rate, quats) for rate, quats in used]
        self._held = []
        nothing: list[KneeSample | None] = [None] * (len(kept) - len(samples))
        return [*nothing, *samples]

    def stand(self, up: Array) -> None:
        """Zero is where these verticals are one, about the published axes; the axis may still have to be found."""
        self._declared = np.asarray(up)
        if self._axes is None:
            return
        along = np.stack([segment_frame(axis)[:, 0] for axis in self._axes])
        thigh, shank = Plane(self._axes, along, np.cross(self._axes, along)).tilts(up)
        self._zero = wrapped(shank - thigh)
        self._thigh_up = np.asarray(up[0] / np.linalg.norm(up[0]))

    def finish(self) -> None:
        """The recording is over: its motion is what there is."""
        if self._axes is None and self._moved_s >= self._parameters.mcgrath_least_s:
            self._find()

    def fitting(self) -> Fitting:
        """The published axes, with the up of the beginning or of the marked standing."""
        assert self._axes is not None
        shank_up = np.cross(self._axes[1], segment_frame(self._axes[1])[:, 0])
        ups = [self._thigh_up, shank_up if self._declared is None else self._declared[1]]
        frames = np.stack([frame_from_axis_and_up(axis, up) for axis, up in zip(self._axes, ups, strict=True)])
        datum = MCGRATH_DATUM if self._declared is None else MARKED_DATUM
        return Fitting(frames, self._bias(), MCGRATH_QUALITY, datum, "principal component of the first motion")

    def evidence(self) -> Evidence | None:
        """The published method asks for none."""
        return None

    def snapshot(self) -> State:
        """Everything that changes, VQF's state included."""
        return {
            "filters": [_pack_vqf(each) for each in self._filters],
            "rates": pack_array(np.array([rate for rate, _ in self._held]).reshape(-1, 2, 3)),
            "quats": pack_array(np.array([quats for _, quats in self._held]).reshape(-1, 2, 4)),
            "numbers": [self._held_s, self._moved_s, self._zero],
            "axes": None if self._axes is None else pack_array(self._axes),
            "declared": None if self._declared is None else pack_array(self._declared),
            "thigh_up": pack_array(self._thigh_up),
            "last": list(self._last),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        for each, packed in zip(self._filters, state["filters"], strict=True):
            _unpack_vqf(each, packed)
        self._held = list(zip(unpack_array(state["rates"]), unpack_array(state["quats"]), strict=True))
        self._held_s, self._moved_s, self._zero = state["numbers"]
        self._axes = None if state["axes"] is None else unpack_array(state["axes"])
        self._declared = None if state["declared"] is None else unpack_array(state["declared"])
        self._thigh_up = unpack_array(state["thigh_up"])
        self._last = KneeSample(*state["last"])


def _vqf(interval_s: float) -> Any:
    try:
        from vqf import VQF
    except ImportError as error:
        raise ValueError(
            "knee_axis_mcgrath needs the orientation filter VQF, which is not installed: pip install 'ambula[bench]'; "
            "or choose knee_axis"
        ) from error
    return VQF(interval_s)


def _pack_vqf(each: Any) -> State:
    """Its state as JSON values, to the bit; numbers may be NaN while its low-passes begin."""
    flags = {name: value for name, value in each.state.items() if isinstance(value, bool)}
    numbers = {name: value for name, value in each.state.items() if not isinstance(value, bool)}
    return {
        "flags": flags,
        "scalars": [name for name, value in numbers.items() if np.ndim(value) == 0],
        "numbers": {name: pack_array(np.asarray(value, dtype=np.float64)) for name, value in numbers.items()},
    }


def _unpack_vqf(each: Any, packed: State) -> None:
    arrays = {name: unpack_array(value) for name, value in packed["numbers"].items()}
    numbers = {name: float(a) if name in packed["scalars"] else a.tolist() for name, a in arrays.items()}
    each.state = {**packed["flags"], **numbers}


def _sense(sensors: Sequence[SensorDescription], axes: Array, decides: float) -> float:
    """-1 where the placement tells that the axes (2, 3) point right, else 1."""
    lefts = [leftward(sensor) for sensor in sensors]
    shares = [float(left @ axis) for left, axis in zip(lefts, axes, strict=True) if left is not None]
    clear = [share for share in shares if abs(share) > decides]
    return -1.0 if sum(clear) < 0.0 else 1.0
