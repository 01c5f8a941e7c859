"""Table I, segmentation, and the curve over S of the virtual participants."""

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.marching import (
    BEAT,
    BEAT_HZ,
    ESTIMATORS,
    GRID,
    LITERAL,
    OURS,
    OWN_PACE,
    PLAIN,
    TITLES,
    TRIALS,
    Score,
    Scores,
    Setting,
    Tuning,
)
from services.bench.joukov.regions import QUANTITIES, WHOLE
from services.bench.joukov.sections import change, power
from services.bench.joukov.segmentation import percent_error
from services.bench.report import Table, number

FloatArray = NDArray[np.float64]

Trials = Mapping[str, Mapping[str, Scores]]
"""Scores by trial and participant."""
PUBLISHED_FREQUENCY_PERCENT = (0.30, 1.08, 0.18)
PUBLISHED_SEGMENTED_PERCENT = (96.4, 97.1)
"""Hips and knees."""
PUBLISHED_VELOCITY, PUBLISHED_ACCELERATION = 1.0 - 0.37, 1.0 - 0.40
"""Ratios to the plain filter, from the paper's abstract."""


def frequency_error(score: Score) -> float:
    """Percent of the metronome's."""
    return percent_error(score.frequency / (2 * np.pi), BEAT_HZ)


def frequency_table(trials: Trials, at: str, S: float) -> Table:
    """Table I."""
    rows = []
    for person, scores in trials[BEAT].items():
        cells = []
        for estimator in (LITERAL, OURS):
            score = scores[Setting("gravity", estimator, S)]
            cells += [f"{score.frequency / (2 * np.pi):.3f}", f"{frequency_error(score):+.2f}"]
        rows.append([person, f"{BEAT_HZ:.3f}", *cells])
    header = ["", "metronome, Hz", *chain(*((f"{TITLES[e]}, Hz", "error, %") for e in (LITERAL, OURS)))]
    return Table(
        f"Table I at {at}: mean frequency after the first 15 s (published errors: 0.30, 1.08, 0.18 %)", header, rows
    )


def segmented_percent(scores: Sequence[Score]) -> float:
    """Share of all repetitions that were segmented right."""
    return 100.0 * float(np.mean(np.concatenate([score.segmented for score in scores])))


def segmentation_table(trials: Trials, tuning: Tuning) -> Table:
    """Repetitions segmented right, by trial and S."""
    rows = []
    for trial in TRIALS:
        for at, S in tuning.named.items():
            cells = []
            for estimator in (LITERAL, OURS):
                found = [scores[Setting("gravity", estimator, S)] for scores in trials[trial].values()]
                right = np.concatenate([score.segmented for score in found])
                cells.append(f"{right.sum():.0f} of {len(right)}, {segmented_percent(found):.1f} %")
            rows.append([f"{trial}, {at}", *cells])
    return Table(
        "Repetitions of the right leg with both boundaries within 10 % of truth (published: 96.4 % hip, 97.1 % knee)",
        ["", TITLES[LITERAL], TITLES[OURS]],
        rows,
    )


def mean_ratio(people: Mapping[str, Scores], setting: Setting, region: int = WHOLE) -> FloatArray:
    """RMSE over that of the plain filter at the same S, (3,): mean over people, hips and knees."""
    plain = Setting(setting.model, PLAIN, setting.S)
    ratios = [scores[setting].errors.rmse[region] / scores[plain].errors.rmse[region] for scores in people.values()]
    return np.asarray(np.mean(ratios, axis=(0, 2)))


def best_ratio(people: Mapping[str, Scores], tuning: Tuning) -> FloatArray:
    """Ours over plain, (3,), each at the S that gives the first participant's accelerations best."""
    ours, plain = Setting("gravity", OURS, tuning.agile_ours), Setting("gravity", PLAIN, tuning.agile)
    ratios = [scores[ours].errors.rmse[WHOLE] / scores[plain].errors.rmse[WHOLE] for scores in people.values()]
    return np.asarray(np.mean(ratios, axis=(0, 2)))


def curve(people: Mapping[str, Scores], estimator: str) -> FloatArray:
    """`mean_ratio` over GRID, (GRID, 3)."""
    return np.array([mean_ratio(people, Setting("gravity", estimator, S)) for S in GRID.tolist()])


def largest_S(ratios: FloatArray, wanted: float) -> float | None:
    """The largest S of GRID at which a ratio (GRID,) is as small as wanted."""
    reached = np.flatnonzero(ratios <= wanted)
    return float(GRID[reached[-1]]) if reached.size else None


def curve_table(people: Mapping[str, Scores]) -> Table:
    """Change against the plain filter over S."""
    curves = {estimator: curve(people, estimator) for estimator in (LITERAL, OURS)}
    header = ["S, (rad/s3)²", *(f"{TITLES[e]}: {quantity}" for e in curves for quantity in QUANTITIES)]
    rows = [
        [power(S), *(change(float(ratios[k, q])) for ratios in curves.values() for q in range(3))]
        for k, S in enumerate(GRID.tolist())
    ]
    return Table("RMSE against the plain EKF at the same S: hips and knees, mean over participants", header, rows)


def absolute_table(people: Mapping[str, Scores]) -> Table:
    """Errors over S themselves."""
    header = [
        "S, (rad/s3)²",
        *(f"{TITLES[e]}: {q}, {u}" for e in ESTIMATORS for q, u in (("velocity", "deg/s"), ("acceleration", "deg/s2"))),
    ]
    rows = []
    for S in GRID.tolist():
        cells = []
        for estimator in ESTIMATORS:
            rmse = np.mean(
                [s[Setting("gravity", estimator, S)].errors.rmse[WHOLE] for s in people.values()], axis=(0, 2)
            )
            cells += [number(float(np.degrees(rmse[q]))) for q in (1, 2)]
        rows.append([power(S), *cells])
    return Table("RMSE over S: hips and knees, mean over participants", header, rows)


def people_of(trials: Trials) -> Mapping[str, Scores]:
    """The participants at their own pace."""
    return trials[OWN_PACE]
