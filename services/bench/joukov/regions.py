"""Errors of joint estimates where the acceleration is high and where it is low, and of predicted samples."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Mask = NDArray[np.bool_]

REGIONS = ("everywhere", "top 25 %", "bottom 75 %", "quarter of the samples", "other three quarters")
WHOLE, TOP, BOTTOM, QUARTER, REST = range(len(REGIONS))
"""The published tables say "top 25 % acceleration regions" and explain: where the absolute acceleration exceeds 75 % of
its maximum. That is TOP; the quarter of the samples with the highest acceleration is another reading."""
SHARE_OF_MAXIMUM = 0.75
JOINT_NAMES = ("hip", "knee")
QUANTITIES = ("position", "velocity", "acceleration")


class RegionErrors(NamedTuple):
    """Errors by region, quantity (rad, rad/s, rad/s^2) and joint, (5, 3, 2): mean of right and left of each."""

    rmse: FloatArray
    sd: FloatArray
    """Standard deviation of the error, so without its mean."""


def regions(acceleration: FloatArray) -> FloatArray:
    """(5, n) True where samples of one joint's true acceleration (n,) belong to REGIONS."""
    size = np.abs(acceleration)
    top = size > SHARE_OF_MAXIMUM * np.max(size)
    quarter = size > np.quantile(size, 0.75)
    return np.array([np.ones_like(top), top, ~top, quarter, ~quarter])


def region_errors(estimate: FloatArray, truth: FloatArray) -> RegionErrors:
    """Compare states (3, n, 4): position, velocity, acceleration of right hip, left hip, right knee, left knee."""
    rmse, sd = np.zeros((len(REGIONS), 3, 4)), np.zeros((len(REGIONS), 3, 4))
    error = estimate - truth
    for joint in range(truth.shape[2]):
        for region, mask in enumerate(regions(truth[2, :, joint])):
            part = error[:, mask, joint]
            rmse[region, :, joint] = np.sqrt(np.mean(part**2, axis=1))
            sd[region, :, joint] = np.std(part, axis=1)
    return RegionErrors(_both_sides(rmse), _both_sides(sd))


def _both_sides(values: FloatArray) -> FloatArray:
    return np.asarray(values.reshape(*values.shape[:-1], 2, 2).mean(axis=-1))


def prediction_errors(surprise: FloatArray, places: list[list[int]]) -> FloatArray:
    """RMSE per axis of predicted samples by kind and place, (2, places): rad/s, then m/s^2.

    Args:
        surprise: sample minus prediction, (n, S, 6), NaN where there was no sample.
        places: sensors that sit at each place, e.g. on both thighs. Their errors are averaged.
    """
    rmse = np.sqrt(np.nanmean(surprise.reshape(len(surprise), -1, 2, 3) ** 2, axis=(0, 3)))
    return np.array([[float(np.mean(rmse[sensors, kind])) for sensors in places] for kind in range(2)])
