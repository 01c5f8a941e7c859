"""The band's own claims: simplified against conventional filter, bias by window (figures 5 and 6)."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.bench.knee.legs import Motion, Sensors, cycling, record, seated_flexion, still, walking
from services.biomech.two_sensor_knee.grover import (
    ConventionalKnee,
    GroverParameters,
    PlanarSample,
    SimplifiedKnee,
    bias_by_window,
    tilt,
    wrapped,
)
from services.biomech.two_sensor_knee.knee_band import KneeBand

Array = NDArray[np.float64]

LITERAL = GroverParameters()
PAPER_BIAS = np.radians([[0.0, 0.0, -0.83], [0.0, 0.0, 0.5]])
"""rad/s about z: 0.83 and -0.5 deg/s about the flexion axis, which is -z (section 4)."""
WINDOWS = np.array([50, 100, 200, 400, 600, 800, 1000, 1200, 1600, 2000])
DURATION_S = 110.0
NOISY = Sensors(gyro_bias=PAPER_BIAS, rate_noise=0.003, force_noise=0.1, soft_tissue=0.02)
FLEXION_AXES = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, -1.0]])
UP = np.array([[0.0, 1.0, 0.0], [0.0, 1.0, 0.0]])


def motions(cadence: float = 1.0, *, is_planar: bool = True) -> dict[str, Motion]:
    """The paper's three activities, under way from the start; `cadence` scales their frequencies.

    The paper has the leg move in one plane. Otherwise the leg also sways: turning while leaning gives the rate about
    the flexion axis a mean that is no bias.
    """
    activities = {
        "walking": walking(0.9 * cadence, start_s=-2.0),
        "flexion": seated_flexion(0.4 * cadence, start_s=-2.0),
        "cycling": cycling(1.0 * cadence, start_s=-2.0),
    }
    if not is_planar:
        return activities
    return {name: motion._replace(heading=still(), lean=still()) for name, motion in activities.items()}


def planar(rate: Array, force: Array, axes: Array, up: Array) -> list[PlanarSample]:
    """Samples in the plane across the flexion axis: rate and force (n, 2, 3), axes and up (2, 3) in either sensor.

    Raises:
        ValueError: `up` is parallel to its axis.
    """
    columns = []
    for s in range(2):
        along = up[s] - (up[s] @ axes[s]) * axes[s]
        if np.linalg.norm(along) < 1e-6:
            raise ValueError("the reference direction is parallel to the axis")
        across = np.cross(axes[s], along)
        tilts = [tilt(-float(f @ across), float(f @ along)) for f in force[:, s]]
        columns += [rate[:, s] @ axes[s], np.array(tilts)]
    return [PlanarSample(*row) for row in np.stack(columns, axis=1).tolist()]


def run_conventional(samples: Sequence[PlanarSample], parameters: GroverParameters = LITERAL) -> Array:
    """Knee angle (n,), rad."""
    step, dt_s = ConventionalKnee(parameters).step, 1.0 / parameters.rate_hz
    return np.array([step(sample, dt_s) for sample in samples])


def run_simplified(samples: Sequence[PlanarSample], parameters: GroverParameters = LITERAL) -> Array:
    """Knee angle (n,), rad; NaN while the biases are being learned."""
    step, dt_s = SimplifiedKnee(parameters).step, 1.0 / parameters.rate_hz
    angles = [step(sample, dt_s) for sample in samples]
    return np.array([np.nan if angle is None else angle for angle in angles])


def largest_difference(samples: Sequence[PlanarSample]) -> float:
    """Largest difference, rad, of both filters once the simplified one has run for 1 s (figure 6).

    Raises:
        ValueError: the recording is not longer than the samples that the biases need.
    """
    first = LITERAL.debias_samples + int(LITERAL.rate_hz)
    if len(samples) <= first:
        raise ValueError(f"{len(samples)} samples are not more than the {first} that the simplified filter needs")
    difference = run_simplified(samples)[first:] - run_conventional(samples)[first:]
    return max(abs(wrapped(value)) for value in difference.tolist())


def synthetic(motion: Motion, seed: int) -> list[PlanarSample]:
    """A noisy leg at the paper's 20 Hz with the paper's biases."""
    leg = record(motion, DURATION_S, LITERAL.rate_hz, NOISY, seed)
    return planar(leg.rate, leg.force, FLEXION_AXES, UP)


class Traces(NamedTuple):
    """Knee angles (n,), rad, at the paper's rate; NaN while a filter does not answer."""

    truth: Array
    conventional: Array
    simplified: Array
    ours: Array
    ours_std: Array


def traces(motion: Motion, seed: int) -> Traces:
    """Both published filters and our band on the same samples (figure 6)."""
    leg = record(motion, DURATION_S, LITERAL.rate_hz, NOISY, seed)
    samples, band = planar(leg.rate, leg.force, FLEXION_AXES, UP), KneeBand(FLEXION_AXES, UP)
    readings = [band.step(rate, force, 1.0 / LITERAL.rate_hz) for rate, force in zip(leg.rate, leg.force, strict=True)]
    ours = np.array([[reading.flexion, reading.flexion_std] for reading in readings])
    return Traces(leg.flexion, run_conventional(samples), run_simplified(samples), ours[:, 0], ours[:, 1])


def bias_curves(seed: int = 0) -> dict[str, Array]:
    """Thigh bias, rad/s, by window for each activity: (len(WINDOWS),) each (figure 5)."""
    curves = {}
    for name, motion in motions().items():
        rates = np.array([sample.thigh_rate for sample in synthetic(motion, seed)])
        curves[name] = bias_by_window(rates, WINDOWS)
    return curves


def bias_errors(motion: Motion, seed: int) -> tuple[float, float]:
    """Relative errors of the thigh's bias after 1000 samples: published mean, and ours while it runs."""
    leg = record(motion, LITERAL.debias_samples / LITERAL.rate_hz, LITERAL.rate_hz, NOISY, seed)
    true = float(PAPER_BIAS[0] @ FLEXION_AXES[0])
    mean = float(bias_by_window(leg.rate[:, 0] @ FLEXION_AXES[0], np.array([LITERAL.debias_samples]))[0])
    band = KneeBand(FLEXION_AXES, UP)
    for rate, force in zip(leg.rate, leg.force, strict=True):
        band.step(rate, force, 1.0 / LITERAL.rate_hz)
    return abs(mean - true) / abs(true), abs(band.thigh.bias - true) / abs(true)
