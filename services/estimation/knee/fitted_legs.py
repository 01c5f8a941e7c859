"""How the sensors of all legs sit, as the calibration says it, and when that has changed enough to say it again."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import Calibration, SensorAlignment
from schemas.session import SessionDescription
from services.biomech.event_sources import event_sources
from services.biomech.rotations import quaternion_from_matrix
from services.estimation.alignment import Alignment
from services.estimation.knee.leg import Leg
from services.estimation.rows import MODEL
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]


class FittedLegs:
    """Of one session."""

    def __init__(
        self, description: SessionDescription, legs: Sequence[Leg], unused: dict[str, str], axis_change: float
    ) -> None:
        self._description = description
        self._legs = legs
        self._unused = unused
        self._axis_change = axis_change
        self._said: list[str] = []
        self._frames: Array = np.zeros((0, 3, 3))

    def alignment(self) -> Alignment:
        """Of all sensors, leg by leg; those of a leg without an axis are not aligned."""
        count = 2 * len(self._legs)
        frames, quality = np.tile(np.eye(3), (count, 1, 1)), np.zeros(count)
        aligned = np.zeros(count, dtype=np.bool_)
        for k, leg in enumerate(self._legs):
            if leg.estimator.is_fitted:
                fitting = leg.fitting()
                frames[2 * k : 2 * k + 2], quality[2 * k : 2 * k + 2] = fitting.R_segment_from_sensor, fitting.quality
                aligned[2 * k : 2 * k + 2] = leg.is_settled
        return Alignment(frames, quality, aligned)

    def news(self) -> Calibration | None:
        """The calibration, when what it says has changed: a leg, a zero, a misplacement, an axis by far."""
        fitted = [leg for leg in self._legs if leg.estimator.is_fitted and (leg.is_settled or leg.is_swapped)]
        if not fitted:
            return None
        fittings = [leg.fitting() for leg in fitted]
        frames = np.concatenate([fitting.R_segment_from_sensor for fitting in fittings])
        pairs = zip(fitted, fittings, strict=True)
        said = [f"{leg.worn.side} {fitting.datum} {leg.misplaced}" for leg, fitting in pairs]
        if said == self._said and _largest_turn(self._frames, frames) < self._axis_change:
            return None
        self._said, self._frames = said, frames
        return self._message(fitted)

    def _message(self, fitted: Sequence[Leg]) -> Calibration:
        sensors, data = [], {}
        for leg in fitted:
            fitting = leg.fitting()
            data[leg.worn.side] = fitting.datum
            for sensor, R, bias in zip(leg.worn.sensors, fitting.R_segment_from_sensor, fitting.gyro_bias, strict=True):
                sensors.append(
                    SensorAlignment(
                        sensor=sensor.name,
                        segment=sensor.segment,
                        quat_segment_from_sensor=quaternion_from_matrix(R).tolist(),
                        gyro_bias=bias.tolist(),
                        quality=0.0 if leg.is_swapped else fitting.quality,
                    )
                )
        one = len(set(data.values())) == 1
        datum = next(iter(data.values())) if one else "; ".join(f"{side} knee: {words}" for side, words in data.items())
        return Calibration(
            model=MODEL,
            estimator=self._description.estimator,
            method=fitted[0].fitting().method,
            datum=datum,
            quality=min(sensor.quality for sensor in sensors),
            sensors=sensors,
            events_from=event_sources(frozenset(segment for leg in self._legs for segment in leg.worn.segments)),
            unused=self._unused,
            misplaced={leg.worn.side: leg.misplaced for leg in self._legs if leg.misplaced},
            lengths={},
            absolute=True,
        )

    def snapshot(self) -> State:
        """What was said last."""
        return {"said": list(self._said), "frames": pack_array(self._frames)}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._said, self._frames = list(state["said"]), unpack_array(state["frames"])


def _largest_turn(before: Array, now: Array) -> float:
    """rad between frames (n, 3, 3): 2 sin(a / 2) = |R1 - R2| / sqrt 2 in the Frobenius norm."""
    if before.shape != now.shape:
        return np.inf
    apart = np.linalg.norm(now - before, axis=(1, 2)) / np.sqrt(2.0)
    return float(2.0 * np.arcsin(np.minimum(apart.max() / 2.0, 1.0)))
