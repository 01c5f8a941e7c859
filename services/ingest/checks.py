"""Are these samples in the unit that was declared? Judged by gravity and by how little a standing person turns."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.ingest.errors import WrongUnits
from services.ingest.tracks import ImuTrack
from services.ingest.units import LOCAL_GRAVITY, SCALES

Values = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PlausibilityLimits:
    """Bounds of the check; R10 of the reliability matrix unless stated."""

    gravity_tolerance: float = 0.5  # m/s^2
    still_spread: float = 0.05  # of the mean: specific force may vary by this within the quietest second
    motionless_spread: float = 0.015  # of the mean: below it a body part hardly turns either
    turning_when_still: float = 0.1  # rad/s, mean norm within the calmest motionless second
    fastest_turn: float = 45.0  # rad/s; gait sensors end at 35 (2000 deg/s), feet reach 33
    tilt_to_explain: float = 0.35  # rad: gravity must have turned by this before a gyro can be called too small
    explained_share: float = 0.33  # of that angle that the gyro must account for, dimensionless


LIMITS = PlausibilityLimits()


class DeclaredUnits(NamedTuple):
    """What the manifest says the file is in."""

    specific_force: str = "m/s^2"
    angular_velocity: str = "rad/s"


def check_units(
    where: str, samples: ImuTrack, rate_hz: float, units: DeclaredUnits, limits: PlausibilityLimits = LIMITS
) -> None:
    """Raises WrongUnits, naming the unit that would fit. Silent when the sensor is never still for a second."""
    width = max(2, round(rate_hz))
    if len(samples.captured_ns) < width:
        return
    _check_turning_speed(where, samples.angular_velocity, units.angular_velocity, limits)
    mean, spread = _moving_mean_and_spread(samples.specific_force, width)
    quietest = int(np.argmin(spread))
    gravity = float(np.linalg.norm(mean[quietest]))
    if spread[quietest] > limits.still_spread * gravity:
        return
    _check_gravity(where, gravity, units.specific_force, limits)
    motionless = spread < limits.motionless_spread * gravity
    if motionless.any():
        turning = _moving_mean(np.linalg.norm(samples.angular_velocity, axis=1), width)
        _check_stillness(where, float(turning[motionless].min()), units.angular_velocity, limits)
    _check_tilt_explained(where, mean, samples.angular_velocity, rate_hz, units.angular_velocity, limits)


def _moving_mean_and_spread(vectors: Values, width: int) -> tuple[Values, Values]:
    """Over windows of `width` rows: mean (m x 3) and standard deviation (m), all three axes together."""
    centred = vectors - vectors.mean(axis=0)
    sums = np.cumsum(np.vstack([np.zeros(3), centred]), axis=0)
    squares = np.cumsum(np.concatenate([[0.0], (centred**2).sum(axis=1)]))
    mean = (sums[width:] - sums[:-width]) / width
    variance = (squares[width:] - squares[:-width]) / width - (mean**2).sum(axis=1)
    return mean + vectors.mean(axis=0), np.sqrt(np.maximum(variance, 0.0))


def _moving_mean(values: Values, width: int) -> Values:
    sums = np.cumsum(np.concatenate([[0.0], values]))
    return np.asarray((sums[width:] - sums[:-width]) / width)


def _check_gravity(where: str, gravity: float, unit: str, limits: PlausibilityLimits) -> None:
    if abs(gravity - LOCAL_GRAVITY) <= limits.gravity_tolerance:
        return
    declared = SCALES["specific force"][unit]
    advice = "check unit and columns of specific_force, and that gravity was not removed from it"
    for other, scale in SCALES["specific force"].items():
        if abs(gravity / LOCAL_GRAVITY * scale / declared - 1) < 0.1:
            advice = f'the file is rather in {other}: write unit = "{other}" for specific_force'
    raise WrongUnits(
        f"{where}: {gravity:.4g} m/s^2 at rest instead of {LOCAL_GRAVITY} +- {limits.gravity_tolerance}; {advice}"
    )


def _check_stillness(where: str, turning: float, unit: str, limits: PlausibilityLimits) -> None:
    if turning <= limits.turning_when_still:
        return
    raise WrongUnits(
        f"{where}: turns at {turning:.3g} rad/s while it lies still (at most {limits.turning_when_still}); "
        + _slower_unit(unit)
    )


def _check_turning_speed(where: str, angular_velocity: Values, unit: str, limits: PlausibilityLimits) -> None:
    # A share of the samples and not the largest one: single spikes are a sensor fault, not a unit.
    fastest = float(np.quantile(np.linalg.norm(angular_velocity, axis=1), 0.999))
    if fastest > limits.fastest_turn:
        raise WrongUnits(
            f"{where}: turns at up to {fastest:.4g} rad/s, faster than a body part can; " + _slower_unit(unit)
        )


def _slower_unit(unit: str) -> str:
    if unit == "rad/s":
        return 'the file is rather in deg/s: write unit = "deg/s" for angular_velocity'
    return "check unit and columns of angular_velocity"


def _check_tilt_explained(
    where: str, gravity: Values, angular_velocity: Values, rate_hz: float, unit: str, limits: PlausibilityLimits
) -> None:
    """Gravity cannot turn in the sensor frame by more than the gyro's own path; a lot more means too small a unit."""
    directions = gravity / np.maximum(np.linalg.norm(gravity, axis=1, keepdims=True), 1e-9)
    tilt = float(np.arccos(np.clip(directions @ directions[0], -1.0, 1.0)).max())
    path = float(np.linalg.norm(angular_velocity, axis=1).sum() / rate_hz)
    if tilt > limits.tilt_to_explain and path < limits.explained_share * tilt:
        likely = 'write unit = "rad/s" for angular_velocity' if unit != "rad/s" else "check the columns"
        raise WrongUnits(f"{where}: tilts by {tilt:.2g} rad while its gyro adds up to {path:.2g} rad; {likely}")
