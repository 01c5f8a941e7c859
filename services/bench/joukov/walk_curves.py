"""The whole filter over the process noise S on synthetic walks: plain, rhythmic, as published.

S is the variance of the jerk of one sample at 100 Hz, (rad/s^3)^2. Position errors hardly depend on it; the filters are
compared at the same S and each at its own best.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.study import QUANTITIES, UNITS
from services.bench.joukov.walk_recordings import INSTANTANEOUS, WalkRecording, with_noise
from services.bench.scoreboard import Row, at_most, informative
from services.biomech.rhythm.parameters import TrustedParameters
from services.estimation.parameters import FilterParameters

FloatArray = NDArray[np.float64]

GRID = 10.0 ** np.arange(1.0, 6.01, 0.5)
"""(rad/s^3)^2."""
DEFAULT = 7
"""Index of the S in the grid that the filter has by default."""
PLAIN, OURS, PUBLISHED = "plain", "rhythmic", "published oscillator"
FILTERS: dict[str, tuple[str, FilterParameters]] = {
    PLAIN: ("ekf", INSTANTANEOUS),
    OURS: ("rhythmic_ekf", INSTANTANEOUS),
    "two states": ("rhythmic_ekf", replace(INSTANTANEOUS, calm_share=1.0)),
    "10 harmonics": ("rhythmic_ekf", replace(INSTANTANEOUS, rhythm=TrustedParameters(harmonics=10))),
    PUBLISHED: ("rhythmic_ekf_joukov", INSTANTANEOUS),
}
"""Estimator and parameters. "two states" is the rhythmic filter without the state that has less process noise."""
PAIRS = ("hip", "knee")
ACCELERATION = 2


@dataclass(frozen=True)
class WalkCurves:
    """RMSE of every filter on some walks of one kind."""

    kind: str
    errors: dict[str, FloatArray]
    """(walks, GRID, 3, 2): position rad, velocity rad/s, acceleration rad/s^2 of hips and knees."""

    def mean(self, name: str) -> FloatArray:
        """Mean over the walks, (GRID, 3, 2)."""
        return np.asarray(self.errors[name].mean(axis=0))

    def same_S(self, name: str) -> FloatArray:
        """Mean error over that of the plain filter at every S, (GRID, 3, 2)."""
        return self.mean(name) / self.mean(PLAIN)

    def best(self, name: str) -> FloatArray:
        """Smallest mean error over the plain filter's smallest, each at its own S, (3, 2)."""
        return np.asarray(self.mean(name).min(axis=0) / self.mean(PLAIN).min(axis=0))


def pair_rmse(recording: WalkRecording, state: FloatArray, when: NDArray[np.bool_]) -> FloatArray:
    """RMSE (3, 2) of hips and knees at the samples `when` (n,) that were estimated."""
    error = (state - recording.truth)[:, when & np.isfinite(state[0, :, 0])]
    return np.asarray(np.sqrt(np.mean(error.reshape(3, error.shape[1], 2, 2) ** 2, axis=(1, 3))))


def trace(recording: WalkRecording, name: str, when: NDArray[np.bool_]) -> FloatArray:
    """Errors of one filter at every S of the grid, (GRID, 3, 2)."""
    estimator, parameters = FILTERS[name]
    runs = (recording.estimate(estimator, with_noise(parameters, S)) for S in GRID)
    return np.array([pair_rmse(recording, run.state, when) for run in runs])


def curve_rows(curves: WalkCurves, limit: float | None = None) -> list[Row]:
    """Same S and best against best of hips and knees; `limit` of the mean acceleration, best against best."""
    rows = []
    best = {name: curves.best(name)[ACCELERATION] for name in FILTERS}
    title = f"{curves.kind}: acceleration, each at its own best S"
    ours, theirs = float(best[OURS].mean()), float(best[PUBLISHED].mean())
    rows.append(
        informative(title, ours, "of plain", theirs)
        if limit is None
        else at_most(title, ours, "of plain", limit, theirs)
    )
    for p, pair in enumerate(PAIRS):
        for name in FILTERS:
            if name != PLAIN:
                rows += _pair_rows(curves, name, p, pair)
        rows += _curve_detail(curves, p, pair)
    return rows


def _pair_rows(curves: WalkCurves, name: str, p: int, pair: str) -> list[Row]:
    rows = []
    for q, quantity in enumerate(QUANTITIES):
        ours, plain = (np.degrees(curves.mean(n)[:, q, p]) for n in (name, PLAIN))
        detail = name != OURS or q != ACCELERATION
        title = f"{curves.kind}, {pair}, {name}: {quantity}"
        rows.append(
            informative(f"{title} at its own best S", float(ours.min()), UNITS[q], float(plain.min()), detail=detail)
        )
        rows.append(
            informative(f"{title} by default", float(ours[DEFAULT]), UNITS[q], float(plain[DEFAULT]), detail=detail)
        )
    return rows


def _curve_detail(curves: WalkCurves, p: int, pair: str) -> list[Row]:
    rows = []
    for k, S in enumerate(GRID):
        for q, quantity in enumerate(QUANTITIES):
            plain = float(np.degrees(curves.mean(PLAIN)[k, q, p]))
            for name in FILTERS:
                if name != PLAIN:
                    value = float(np.degrees(curves.mean(name)[k, q, p]))
                    title = f"{curves.kind}, {pair}, {name} at S = 10^{np.log10(S):.1f}: {quantity}"
                    rows.append(informative(title, value, UNITS[q], plain, detail=True))
    return rows


def mean_of_walks(kind: str, parts: Sequence[dict[str, FloatArray]]) -> WalkCurves:
    """From the traces of single walks, (GRID, 3, 2) by filter."""
    return WalkCurves(kind, {name: np.stack([part[name] for part in parts]) for name in parts[0]})
