"""The published simulation (section IV-A, figures 4-6) over many motions: errors, lock, error against jerk."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.motions import JointMotion, sweep
from services.bench.joukov.study import (
    DECADE,
    GRID,
    QUANTITIES,
    SWEEP_CURVES,
    UNITS,
    Study,
    best_index,
    locks_on_fundamental,
    rmse,
    trace_curve,
    track_errors,
)
from services.bench.scoreboard import Row, informative

FloatArray = NDArray[np.float64]

CONVERGED_S = 20.0
"""s after which the sweep is scored, when both had time to converge; with a hold of 40 s before the ramp, 60 s."""
PUBLISHED_DEG = (2.03, 1.48)
"""Figure 4: position RMSE of EKF and Rhythmic-EKF on one motion."""
JERK_EDGES = (0.0, 50.0, 100.0, 200.0, 400.0, 800.0, np.inf)
"""rad/s^3, bins of figure 6."""


@dataclass(frozen=True)
class JerkBins:
    """Acceleration errors by the jerk they were made at. Sums, so that motions can be added up."""

    count: FloatArray
    """Samples per bin of |jerk|, (bins,)."""
    lag: FloatArray
    """Sum of the error against the jerk's direction, rad/s^2, (bins,): positive = behind."""
    square: FloatArray
    """Sum of squared errors, (rad/s^2)^2, (bins,)."""
    product: float
    """Sum of error times jerk."""
    jerk_square: float
    """Sum of jerk squared."""


@dataclass(frozen=True)
class SweepStudy:
    """One simulated motion."""

    study: Study
    """Errors once converged."""
    whole: dict[str, FloatArray]
    """RMSE (3,) at S* with the time before convergence."""
    locked: dict[str, bool]
    """Whether the true fundamental was locked at S*."""
    bins: dict[str, tuple[JerkBins, JerkBins]]
    """At S* and at S*/10, once converged."""


def study_sweep(seed: int, hold_s: float = 0.0) -> SweepStudy:
    """All filters on one simulated motion."""
    motion, from_s = sweep(seed, hold_s), CONVERGED_S + hold_s
    curves = {name: trace_curve(motion, run, from_s) for name, run in SWEEP_CURVES.items()}
    best = best_index(curves["plain"])
    whole, locked, bins = {}, {}, {}
    for name, run in SWEEP_CURVES.items():
        track, late = run(motion, GRID[best]), run(motion, GRID[best - DECADE])
        whole[name] = rmse(motion, track)
        locked[name] = locks_on_fundamental(motion, track)
        bins[name] = tuple(_sort_by_jerk(motion, track_errors(motion, t, from_s)[:, 2]) for t in (track, late))
    return SweepStudy(Study(curves, {}), whole, locked, bins)  # type: ignore[arg-type]


def _sort_by_jerk(motion: JointMotion, error: FloatArray) -> JerkBins:
    jerk = motion.jerk[-error.size :]
    behind = -error * np.sign(jerk)
    which = np.digitize(np.abs(jerk), JERK_EDGES) - 1

    def total(values: FloatArray) -> FloatArray:
        return np.bincount(which, weights=values, minlength=len(JERK_EDGES) - 1).astype(np.float64)

    return JerkBins(total(np.ones(error.size)), total(behind), total(error**2), float(error @ jerk), float(jerk @ jerk))


def add_bins(parts: Sequence[JerkBins]) -> JerkBins:
    """The bins of all motions together."""
    return JerkBins(
        np.sum([part.count for part in parts], axis=0),
        np.sum([part.lag for part in parts], axis=0),
        np.sum([part.square for part in parts], axis=0),
        sum(part.product for part in parts),
        sum(part.jerk_square for part in parts),
    )


def lag_ms(bins: JerkBins) -> float:
    """Slope of the acceleration error over the jerk: by how much the acceleration is late, ms."""
    return -bins.product / bins.jerk_square * 1e3


def simulation_rows(case: str, studies: Sequence[SweepStudy], *, detail: bool = False) -> list[Row]:
    """Rows of one reading of the simulation; baseline: the plain EKF. `detail`: none of them is a main row."""
    rows = [
        *_error_rows(case, studies),
        *_lock_rows(case, studies),
        *_lag_rows(case, studies),
        *_jerk_rows(case, studies),
    ]
    return [replace(row, detail=True) for row in rows] if detail else rows


def median_error(studies: Sequence[SweepStudy], name: str, tenth: bool = False) -> FloatArray:
    """Median over the motions of the RMSE at S* or S*/10: (3,), deg, deg/s, deg/s^2."""
    errors = [item.study.curves[name][item.study.best - (DECADE if tenth else 0)] for item in studies]
    return np.asarray(np.degrees(np.median(errors, axis=0)))


def _error_rows(case: str, studies: Sequence[SweepStudy]) -> list[Row]:
    rows = []
    for name in ("trusted", "published", "adaptive noise", "unchanged"):
        for tenth in (False, True):
            ours, theirs = median_error(studies, name, tenth), median_error(studies, "plain", tenth)
            for i, unit in enumerate(UNITS):
                title = f"{case}, {name} at {'S*/10' if tenth else 'S*'}: {QUANTITIES[i]}"
                rows.append(
                    informative(title, float(ours[i]), unit, float(theirs[i]), detail=name == "unchanged" or i == 1)
                )
        whole = np.degrees(np.median([item.whole[name] for item in studies], axis=0))
        plain = np.degrees(np.median([item.whole["plain"] for item in studies], axis=0))
        rows.append(
            informative(
                f"{case}, {name} at S*: position, whole run", float(whole[0]), "deg", float(plain[0]), detail=True
            )
        )
    return rows + _published_tuning_rows(case, studies)


def _published_tuning_rows(case: str, studies: Sequence[SweepStudy]) -> list[Row]:
    """What the S is at which the plain filter has the published error, and what the others make of it."""
    position = {
        name: np.degrees(np.median([item.study.curves[name][:, 0] for item in studies], axis=0))
        for name in SWEEP_CURVES
    }
    falling = position["plain"][: int(np.argmin(position["plain"])) + 1]
    if not falling[-1] < PUBLISHED_DEG[0] < falling[0]:
        return []
    power = np.log10(GRID[: falling.size])
    at = float(np.interp(PUBLISHED_DEG[0], falling[::-1], power[::-1]))
    rows = [informative(f"{case}: S where the EKF has the published {PUBLISHED_DEG[0]} deg", 10.0**at, "(rad/s3)2")]
    for name in ("trusted", "published"):
        there = float(np.interp(at, power, position[name][: falling.size]))
        rows.append(informative(f"{case}, {name}: position there (published 1.48)", there, "deg", PUBLISHED_DEG[0]))
    ratio = position["trusted"] / position["plain"]
    wanted = PUBLISHED_DEG[1] / PUBLISHED_DEG[0]
    reached = np.flatnonzero(ratio <= wanted)
    if reached.size:
        largest = float(GRID[reached[-1]])
        rows.append(informative(f"{case}: largest S with the published gain of 27 % or more", largest, "(rad/s3)2"))
    return rows


def _lock_rows(case: str, studies: Sequence[SweepStudy]) -> list[Row]:
    def share(name: str) -> float:
        return 100.0 * float(np.mean([item.locked[name] for item in studies]))

    return [
        informative(f"{case}, {name}: ends on the true fundamental", share(name), "%", detail=name == "unchanged")
        for name in ("trusted", "published", "unchanged")
    ]


def _lag_rows(case: str, studies: Sequence[SweepStudy]) -> list[Row]:
    rows = []
    for tenth, at in ((0, "S*"), (1, "S*/10")):
        lag = {name: lag_ms(add_bins([item.bins[name][tenth] for item in studies])) for name in SWEEP_CURVES}
        for name in ("trusted", "published"):
            rows.append(informative(f"{case}, {name} at {at}: lag of acceleration", lag[name], "ms", lag["plain"]))
    return rows


def _jerk_rows(case: str, studies: Sequence[SweepStudy]) -> list[Row]:
    """Figure 6 at S*/10: mean error against the direction of the jerk, and its RMS, per bin."""
    total = {name: add_bins([item.bins[name][1] for item in studies]) for name in SWEEP_CURVES}
    rows = []
    for i, low in enumerate(JERK_EDGES[:-1]):
        if total["plain"].count[i] == 0.0:
            continue
        for name in ("trusted", "published"):
            title = f"{case}, {name} at S*/10: acceleration, |jerk| from {low:g} rad/s3"
            for what in ("behind by", "RMS"):
                ours, theirs = (_bin_deg(total[key], i, what) for key in (name, "plain"))
                rows.append(informative(f"{title}, {what}", ours, "deg/s2", theirs, detail=True))
    return rows


def _bin_deg(bins: JerkBins, i: int, what: str) -> float:
    mean = bins.lag[i] / bins.count[i] if what == "behind by" else np.sqrt(bins.square[i] / bins.count[i])
    return float(np.degrees(mean))
