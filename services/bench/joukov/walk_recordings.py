"""Synthetic walks as the filter meets them: calibrated by the node's own calibrator, with the truth at every sample.

A synthetic sensor says what it measures at the instant of its time stamp, not the mean over the interval before it,
so the filter runs without `sample_delay` here and estimate and truth belong to the same instant.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from schemas.session import SessionDescription
from services.bench.joukov.recordings import COLUMNS, JOINTS
from services.estimation.lower_body.calibrator import Calibrator
from services.estimation.lower_body.lower_body_filter import Calibrated, LowerBodyFilter
from services.estimation.parameters import EstimationParameters, FilterParameters
from services.estimation.samples import Tick, TickBatch
from services.estimation.sensor_checks import SensorChecks
from services.ingest.synthetic.session import SyntheticSession
from services.ingest.tracks import ImuTrack

FloatArray = NDArray[np.float64]

EVERYONE = np.ones(5, dtype=np.bool_)
INSTANTANEOUS = FilterParameters(sample_delay=0.0)


@dataclass(frozen=True)
class Estimates:
    """What a filter made of a recording, n samples of JOINTS; NaN before the calibration."""

    state: FloatArray
    """rad, rad/s, rad/s^2, shape (3, n, 4)."""
    std: FloatArray
    """Of position rad and velocity rad/s, shape (2, n, 4)."""


class WalkRecording:
    """What the sensors of one synthetic session say, and the truth."""

    def __init__(self, walk: SyntheticSession) -> None:
        self.walk = walk
        self.rate_hz = self.walk.parameters.rate
        blocks = list(self.walk.samples())
        tracks = [[block.sensors[s] for block in blocks] for s in range(len(blocks[0].sensors))]
        samples = [np.hstack([_joined(t, "angular_velocity"), _joined(t, "specific_force")]) for t in tracks]
        self.samples: FloatArray = np.stack(samples, axis=1)
        """(n, S, 6) rad/s and m/s^2."""
        self.time_s: FloatArray = np.arange(len(self.samples)) / self.rate_hz
        self.ticks = [
            Tick(round(t * 1e9), row, EVERYONE) for t, row in zip(self.time_s.tolist(), self.samples, strict=True)
        ]

    @cached_property
    def truth(self) -> FloatArray:
        """rad, rad/s, rad/s^2 of JOINTS, shape (3, n, 4)."""
        angles = self.walk.gait.angles(self.walk.strides(self.time_s))
        jets = [angles[name] for name in JOINTS]
        orders = ("value", "rate", "acceleration")
        return np.array([np.column_stack([getattr(jet, order) for jet in jets]) for order in orders])

    def description(self, estimator: str) -> SessionDescription:
        """The session, to be estimated by `estimator`."""
        return self.walk.description().model_copy(update={"estimator": estimator})

    @cached_property
    def calibrated(self) -> tuple[Calibrated, int]:
        """What the node's calibrator finds, and the first sample it would estimate from.

        Raises:
            ValueError: it finds nothing.
        """
        description, parameters = self.description("ekf"), EstimationParameters()
        sensors = description.hubs[0].sensors
        calibrator = Calibrator(description, sensors, parameters)
        checks = SensorChecks([sensor.name for sensor in sensors], parameters.checks)
        for tick in self.ticks:
            calibrated = calibrator.add(TickBatch(tick.captured_ns, (tick,)), checks)
            if calibrated is not None:
                return calibrated, round(calibrator.batches[0].captured_ns * 1e-9 * self.rate_hz)
        raise ValueError("this walk cannot be calibrated; give it standing and some strides")

    def estimate(self, estimator: str, parameters: FilterParameters = INSTANTANEOUS) -> Estimates:
        """Run one estimator over the recording."""
        calibrated, first = self.calibrated
        description = self.description(estimator)
        running = LowerBodyFilter(description, description.hubs[0].sensors, calibrated, parameters)
        state, std = np.full((3, len(self.ticks), 4), np.nan), np.full((2, len(self.ticks), 4), np.nan)
        rows = [running.fuse(tick) for tick in self.ticks[first:]]
        for order, name in enumerate(("position", "velocity", "acceleration")):
            state[order, first:] = np.array([getattr(row, name) for row in rows])[:, COLUMNS]
        std[0, first:] = np.array([row.position_std for row in rows])[:, COLUMNS]
        std[1, first:] = np.array([row.velocity_std for row in rows])[:, COLUMNS]
        return Estimates(state, std)


def _joined(tracks: list[ImuTrack], name: str) -> FloatArray:
    return np.concatenate([getattr(track, name) for track in tracks])


def with_noise(parameters: FilterParameters, S: float) -> FilterParameters:
    """The same filter with jerk variance S per sample of 10 ms, (rad/s^3)^2."""
    return replace(parameters, noise=replace(parameters.noise, jerk_density=S * 0.01))
