"""Whether the published deviations are true: how often the truth is within twice of them.

The synthetic walker's soft tissue is known, so the filter is told it. Its share of the wobble's amplitude, and what
gravity_thigh and gravity_shank are, were chosen on seeds 300-309, where every case then holds 95 to 99 %. Errors differ
from walker to walker, so every case has several of them for each seed.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.walk_curves import PAIRS
from services.bench.joukov.walk_recordings import INSTANTANEOUS, WalkRecording
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.estimation.parameters import FilterParameters, UnmodelledErrors
from services.ingest.synthetic import SyntheticWalk, WalkParameters
from services.ingest.synthetic.sensors import SHANK_WOBBLE_SHARE

FloatArray = NDArray[np.float64]

CASES = {
    "100 Hz": "rate=100",
    "50 Hz": "rate=50",
    "100 Hz, soft tissue": "rate=100&soft_tissue=0.035",
    "50 Hz, soft tissue": "rate=50&soft_tissue=0.035",
    "100 Hz, soft tissue, turns": "rate=100&soft_tissue=0.035&turn_every=10",
}
LOWEST_PERCENT, HIGHEST_PERCENT = 90.0, 99.0
WALKS_PER_SEED = 5
SPAN_S = (10.0, 54.0)
TISSUE_SHARE = 0.4
"""Deviation of an inclination over the wobble's amplitude: its RMS is 0.8 of that, about an axis of any direction."""


@dataclass(frozen=True)
class Band:
    """One walk. Per cent of its samples within two deviations, of hips and knees, (2,)."""

    case: str
    absolute: FloatArray
    offset_removed: FloatArray
    velocity: FloatArray
    claimed: FloatArray
    """rad, mean deviation of the position."""


def told(soft_tissue: float) -> FilterParameters:
    """The filter that knows how much the walker's soft tissue moves, rad of the thigh sensor's wobble."""
    thigh = TISSUE_SHARE * soft_tissue
    errors = UnmodelledErrors(0.0, thigh, SHANK_WOBBLE_SHARE * thigh)
    return replace(INSTANTANEOUS, unmodelled=errors)


def band_seeds(seeds: Sequence[int]) -> list[int]:
    """The walks that belong to the seeds of the other benchmarks."""
    return [seed + 100_000 * walk for seed in seeds for walk in range(1, WALKS_PER_SEED + 1)]


def study_band(case: str, seed: int) -> Band:
    """The rhythmic filter on the walk of a seed."""
    speed = np.random.default_rng([13, seed]).uniform(0.6, 1.4)
    parameters = WalkParameters.parse(f"seed={seed}&duration=60&speed={speed:.3f}&{CASES[case]}")
    recording = WalkRecording(SyntheticWalk(parameters))
    estimates = recording.estimate("rhythmic_ekf", told(parameters.soft_tissue))
    when = (recording.time_s > SPAN_S[0]) & (recording.time_s < SPAN_S[1])
    error, std = (estimates.state - recording.truth)[:2, when], estimates.std[:, when]
    shape = error[0] - error[0].mean(axis=0)
    return Band(case, within(error[0], std[0]), within(shape, std[0]), within(error[1], std[1]), _pairs(std[0]))


def within(error: FloatArray, std: FloatArray) -> FloatArray:
    """Per cent of errors (n, 4) within twice their deviations, of hips and knees: (2,)."""
    return _pairs(np.where(np.abs(error) < 2.0 * std, 100.0, 0.0))


def _pairs(values: FloatArray) -> FloatArray:
    return np.asarray(np.mean(np.reshape(values, (-1, 2, 2)), axis=(0, 2)))


def band_rows(bands: Sequence[Band]) -> list[Row]:
    """Lowest and highest case, hip and knee, absolute and with the offset removed; every case in detail."""
    rows, means = [], {}
    for what in ("absolute", "offset_removed", "velocity"):
        table = {case: np.mean([getattr(b, what) for b in bands if b.case == case], axis=0) for case in CASES}
        means[what] = np.array(list(table.values()))
        for case, value in table.items():
            for p, pair in enumerate(PAIRS):
                title = f"truth within 2 std, {case}, {pair}, {what.replace('_', ' ')}"
                rows.append(informative(title, float(value[p]), "%", detail=True))
    for what in ("absolute", "offset_removed"):
        for p, pair in enumerate(PAIRS):
            title = f"truth within 2 std, {pair}, {what.replace('_', ' ')}"
            rows.append(at_least(f"{title}: lowest case", float(means[what][:, p].min()), "%", LOWEST_PERCENT))
            rows.append(at_most(f"{title}: highest case", float(means[what][:, p].max()), "%", HIGHEST_PERCENT))
    lowest = float(means["velocity"].min())
    rows.append(informative("truth within 2 std, velocity: lowest case", lowest, "%"))
    claimed = np.degrees(np.mean([band.claimed for band in bands], axis=0))
    rows += [informative(f"claimed deviation, {pair}", float(claimed[p]), "deg") for p, pair in enumerate(PAIRS)]
    return rows
