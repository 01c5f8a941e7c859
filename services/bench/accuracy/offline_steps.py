"""Estimates of a recording that starts in motion and is known as a whole: from its quietest instant to both ends.

The live node cannot do this. It is for recordings of single steps, whose first sample lies in swing, where the
accelerometers are wrong about the vertical by up to 60 degrees.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription, SessionDescription
from services.biomech.lower_body_ekf import NoiseModel
from services.estimation.lower_body.lower_body_filter import Calibrated, LowerBodyFilter
from services.estimation.parameters import FilterParameters
from services.estimation.samples import Tick

Array = NDArray[np.float64]

NOISE = NoiseModel(accel_std=14.0, start_position_std=0.05)
"""A step lasts one second: the gyroscopes are trusted over it, and the pose of the quietest instant is the start."""
GRAVITY = 9.81
RATE_WEIGHT = 3.0  # m/s^2 of unrest for each rad/s
AVERAGED = 9
"""Samples over which unrest is averaged, and the start's accelerometers."""


def quietest(samples: Array) -> int:
    """Index in samples (n, S, 6) where the smoothed sum of | |f| - g | + 3 |w| over the sensors is smallest."""
    force = np.abs(np.linalg.norm(samples[:, :, 3:], axis=2) - GRAVITY)
    unrest = np.sum(force + RATE_WEIGHT * np.linalg.norm(samples[:, :, :3], axis=2), axis=1)
    smooth = np.convolve(unrest, np.full(AVERAGED, 1.0 / AVERAGED), mode="valid")
    return int(np.argmin(smooth)) + AVERAGED // 2


def both_ways(
    description: SessionDescription,
    sensors: Sequence[SensorDescription],
    calibrated: Calibrated,
    samples: Array,
    start: int,
    noise: NoiseModel = NOISE,
) -> Array:
    """Joint positions (n, 15), rad, from samples (n, S, 6) at one rate: onward from `start`, and back in time.

    Backwards the angular velocities change their sign, and a sample's meaning is later than its stamp.
    """
    parameters = FilterParameters(noise=noise)
    pose = _pose_at(
        description, sensors, calibrated, samples[max(start - AVERAGED // 2, 0) : start + AVERAGED // 2 + 1]
    )
    onward = _run(description, sensors, calibrated, parameters, pose, samples[start:])
    reversed_samples = samples[start::-1].copy()
    reversed_samples[:, :, :3] *= -1.0
    back = replace(parameters, sample_delay=-parameters.sample_delay)
    mirrored = Calibrated(calibrated.alignment, -calibrated.gyro_bias)
    before = _run(description, sensors, mirrored, back, pose, reversed_samples)
    return np.vstack([before[:0:-1], onward])


def _pose_at(
    description: SessionDescription, sensors: Sequence[SensorDescription], calibrated: Calibrated, samples: Array
) -> Array:
    """(n joints,) rad: the pose whose segments' verticals are those of the mean accelerometers."""
    running = LowerBodyFilter(description, list(sensors), calibrated, FilterParameters())
    tick = Tick(0, samples.mean(axis=0), np.ones(len(sensors), dtype=np.bool_))
    for _ in range(20):
        running.fuse(tick)
        running.ekf.settle()
    return np.array(running.ekf.x[0])


def _run(
    description: SessionDescription,
    sensors: Sequence[SensorDescription],
    calibrated: Calibrated,
    parameters: FilterParameters,
    pose: Array,
    samples: Array,
) -> Array:
    running = LowerBodyFilter(description, list(sensors), calibrated, parameters)
    running.ekf.x[0] = pose
    period_ns = 1e9 / sensors[0].rate_hz
    everyone = np.ones(len(sensors), dtype=np.bool_)
    ticks = [Tick(round(k * period_ns), row, everyone) for k, row in enumerate(samples)]
    return np.array([running.fuse(tick).position for tick in ticks])
