"""Rhythmic against plain over the process noise S: rows from studies of many motions."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.study import DECADE, FIRST, GRID, QUANTITIES, UNITS, Study
from services.bench.scoreboard import Row, at_most, informative

FloatArray = NDArray[np.float64]

POSITION, VELOCITY, ACCELERATION = range(3)
TENTH_LIMITS: dict[str, tuple[float, float, float]] = {"random": (0.97, 0.92, 0.45), "knee": (0.97, 0.92, 0.60)}
"""Largest median ratios at S*/10 of position, velocity, acceleration."""
BEST_LIMIT = 0.96
"""Largest median ratio of acceleration at S*, of the same motions."""
WORST_LIMIT = 1.02
"""Largest ratio of any quantity in any run, for what is not periodic throughout."""
MAIN_OPTION = "adaptive noise"
APERIODIC = ("smooth", "reaches", "knee, stops", "knee, stumbles")


def median_ratio(studies: Sequence[Study], name: str, tenth: bool) -> FloatArray:
    """Median over the motions of filter over plain: (3,)."""
    return np.asarray(np.median([study.ratio(name, tenth) for study in studies], axis=0))


def worst_ratio(studies: Sequence[Study], name: str) -> float:
    """Largest ratio of any quantity in any run, at S* or S*/10."""
    return float(np.max([study.ratio(name, tenth) for study in studies for tenth in (False, True)]))


def worse_percent(studies: Sequence[Study], name: str, tenth: bool) -> float:
    """Share of the runs in which any quantity is more than 2 % worse than plain."""
    return 100.0 * float(np.mean([bool(np.any(study.ratio(name, tenth) > WORST_LIMIT)) for study in studies]))


def curve_ratio(studies: Sequence[Study], name: str) -> FloatArray:
    """Median ratio at each S from 1e2 on: (GRID - 2, 3)."""
    ratios = [study.curves[name][FIRST:] / study.curves["plain"][FIRST:] for study in studies]
    return np.asarray(np.median(ratios, axis=0))


def own_best_ratio(studies: Sequence[Study], name: str) -> FloatArray:
    """Median ratio when each filter and quantity has the S that is best for it: (3,)."""
    ratios = [
        np.min(study.curves[name][FIRST:], axis=0) / np.min(study.curves["plain"][FIRST:], axis=0) for study in studies
    ]
    return np.asarray(np.median(ratios, axis=0))


def curve_rows(kind: str, studies: Sequence[Study]) -> list[Row]:
    """All rows of one kind of motion; baseline: the published estimator on the same motions."""
    return [
        *_tuned_rows(kind, studies),
        *_worst_rows(kind, studies),
        *_option_rows(kind, studies),
        *_detailed_rows(kind, studies),
    ]


def _tuned_rows(kind: str, studies: Sequence[Study]) -> list[Row]:
    rows = []
    for tenth, at in ((True, "S*/10"), (False, "S*")):
        ours, theirs = median_ratio(studies, "trusted", tenth), median_ratio(studies, "published", tenth)
        for i, quantity in enumerate(QUANTITIES):
            title, limit = f"{kind} at {at}: {quantity}", _limit(kind, tenth, i)
            if limit is None:
                rows.append(informative(title, float(ours[i]), "of plain", float(theirs[i]), detail=kind in APERIODIC))
            else:
                rows.append(at_most(title, float(ours[i]), "of plain", limit, float(theirs[i])))
    return rows


def _limit(kind: str, tenth: bool, quantity: int) -> float | None:
    if kind not in TENTH_LIMITS:
        return None
    if tenth:
        return TENTH_LIMITS[kind][quantity]
    return BEST_LIMIT if quantity == ACCELERATION else None


def _worst_rows(kind: str, studies: Sequence[Study]) -> list[Row]:
    title, ours, theirs = f"{kind}: worst run", worst_ratio(studies, "trusted"), worst_ratio(studies, "published")
    if kind in APERIODIC:
        return [at_most(title, ours, "of plain", WORST_LIMIT, theirs)]
    return [informative(title, ours, "of plain", theirs)]


def _option_rows(kind: str, studies: Sequence[Study]) -> list[Row]:
    """What each option makes of it, beside the filter as it is by default as baseline."""
    rows = []
    for name in ("7 harmonics", *studies[0].options):
        for tenth, at in ((True, "S*/10"), (False, "S*")):
            ours, default = median_ratio(studies, name, tenth), median_ratio(studies, "trusted", tenth)
            for i, quantity in enumerate(QUANTITIES):
                title = f"{kind} at {at}, {name}: {quantity} (default)"
                is_main = name == MAIN_OPTION and i == ACCELERATION and kind in TENTH_LIMITS
                rows.append(informative(title, float(ours[i]), "of plain", float(default[i]), detail=not is_main))
            share = worse_percent(studies, name, tenth)
            rows.append(informative(f"{kind} at {at}, {name}: runs over 2 % worse", share, "%", detail=True))
        title = f"{kind}, {name}: worst run (default)"
        worst, default_worst = worst_ratio(studies, name), worst_ratio(studies, "trusted")
        rows.append(informative(title, worst, "of plain", default_worst, detail=name != MAIN_OPTION))
    return rows


def _detailed_rows(kind: str, studies: Sequence[Study]) -> list[Row]:
    """The tuning, best against best, and the whole curve."""
    star = float(np.median([GRID[study.best] for study in studies]))
    rows = [informative(f"{kind}: S*, median", star, "(rad/s3)2", detail=True)]
    for tenth, at in ((True, "S*/10"), (False, "S*")):
        plain = [study.curves["plain"][study.best - DECADE * tenth] for study in studies]
        for i, error in enumerate(np.degrees(np.median(plain, axis=0)).tolist()):
            rows.append(informative(f"{kind} at {at}, plain EKF: {QUANTITIES[i]}", error, UNITS[i], detail=True))
    own, theirs = own_best_ratio(studies, "trusted"), own_best_ratio(studies, "published")
    for i, quantity in enumerate(QUANTITIES):
        title = f"{kind}, each at its own best S: {quantity}"
        rows.append(informative(title, float(own[i]), "of plain", float(theirs[i]), detail=True))
    ours, published = curve_ratio(studies, "trusted"), curve_ratio(studies, "published")
    for k, S in enumerate(GRID[FIRST:]):
        for i, quantity in enumerate(QUANTITIES):
            title = f"{kind} at S = 10^{np.log10(S):.1f}: {quantity}"
            rows.append(informative(title, float(ours[k, i]), "of plain", float(published[k, i]), detail=True))
    return rows
