"""Scores of a causal knee angle against a truth with its own clock."""

from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.bench.knee.agreement import Errors, unwrapped_error
from services.bench.knee.recordings import KneeRecording
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.biomech.two_sensor_knee.memory import OUTPUTS
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

SHIFTS = np.arange(-2.0, 2.01, 0.25)
"""Samples of one constant shift between the clocks."""
FLEXION, STD, VALID, AXIS_STD, FROM_SENSORS = (
    OUTPUTS.index(name) for name in ("flexion", "flexion_std", "is_valid", "axis_std", "flexion_from_sensor_axes")
)


class KneeScore(NamedTuple):
    """Errors in rad."""

    unshifted: Errors
    shifted: Errors
    shift: float  # samples; positive: the estimate comes later than the truth
    coverage: float  # share of the asked samples that had a valid estimate
    within_two_std: float  # share of the errors, offset removed, within twice their claimed deviation


class Pass(StrEnum):
    """What the estimator has seen before the samples that are scored."""

    COLD = "cold"  # nothing: causal from the first sample
    SECOND = "second pass"  # these samples, taken once more with what was found in them
    WARM = "warm"  # the same sensors in the same motion at another time


def run_knee(
    recording: KneeRecording, parameters: KneeAxisParameters, seen: Pass = Pass.COLD
) -> tuple[Array, KneeAxis]:
    """Our outputs (n, 8) and the estimator at the end."""
    estimator, dt_s = KneeAxis(parameters), 1.0 / recording.rate_hz
    if seen is not Pass.COLD:
        estimator.run(recording.rate, recording.force, dt_s)
    if seen is Pass.SECOND and estimator.has_angle:
        estimator.rewind(recording.rate, recording.force, dt_s)
    return estimator.run(recording.rate, recording.force, dt_s), estimator


def score(
    estimate: Array, truth: Array, asked: Mask, valid: Mask, std: Array | None = None, *, absolute: bool = False
) -> KneeScore:
    """Compare estimate and truth (n,), rad, at the asked samples; the best shift is that of the absolute error or not.

    Raises:
        ValueError: none of the asked samples has a valid estimate.
    """
    used = np.flatnonzero(asked & valid & np.isfinite(estimate))
    if len(used) == 0:
        raise ValueError("no valid estimate where the truth was asked")
    frames, smooth = np.arange(len(truth)), np.unwrap(truth)
    candidates = {s: _errors(estimate[used] - np.interp(used - s, frames, smooth)) for s in SHIFTS}
    best = min(candidates, key=lambda s: candidates[s].absolute_rmse if absolute else candidates[s].zero_mean_rmse)
    error = unwrapped_error(estimate[used], np.interp(used - best, frames, smooth))
    within = float(np.mean(np.abs(error - _mean_angle(error)) < 2.0 * std[used])) if std is not None else np.nan
    return KneeScore(candidates[0.0], candidates[best], float(best), len(used) / int(asked.sum()), within)


def _errors(difference: Array) -> Errors:
    error = unwrapped_error(difference, np.zeros_like(difference))
    bias = _mean_angle(error)
    spread = unwrapped_error(error, np.full_like(error, bias))
    return Errors(float(np.sqrt(np.mean(error**2))), float(np.sqrt(np.mean(spread**2))), bias, len(error))


def _mean_angle(error: Array) -> float:
    return float(np.angle(np.mean(np.exp(1j * error))))


def axis_errors(found: Array, true: Array) -> Array:
    """Angle, rad, between lines (2, 3): a common turn round of both axes is no error, of one alone it is."""
    sense = 1.0 if np.sum(found * true) >= 0.0 else -1.0
    return np.asarray(np.arccos(np.clip(sense * np.sum(found * true, axis=1), -1.0, 1.0)))


def axis_history(recording: KneeRecording, parameters: KneeAxisParameters, every_s: float = 0.5) -> tuple[Array, Array]:
    """Times (k,) in s and larger error (k,) in rad of both axes while they are being found; NaN before.

    Raises:
        ValueError: the true axes are not known.
    """
    if recording.axes is None:
        raise ValueError(f"{recording.name} has no true axis")
    estimator, stride = KneeAxis(parameters), round(every_s * recording.rate_hz)
    times, worst = [], []
    for begin in range(0, len(recording.rate) - stride + 1, stride):
        part = slice(begin, begin + stride)
        estimator.run(recording.rate[part], recording.force[part], 1.0 / recording.rate_hz)
        axes = estimator.axes
        times.append((begin + stride) / recording.rate_hz)
        worst.append(float(axis_errors(axes, recording.axes).max()) if np.any(axes) else np.nan)
    return np.array(times), np.array(worst)
