"""The 34 cells of table 1 of Colombel et al.: angles of interest of each task, and what was published for them."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SKIPPED_FRAMES = 60
LARGE_DEG = 20.0
"""Range from which a correlation means anything: CC = s / sqrt(s^2 + e^2) cannot be large where s is small."""

PUBLISHED: dict[int, dict[int, tuple[float, float]]] = {
    1: {4: (11.3, 0.98), 5: (3.0, 0.85), 6: (8.6, 0.93), 7: (6.5, 0.99), 8: (12.2, 0.98), 9: (3.9, 0.85),
        10: (13.4, 0.76), 11: (7.2, 0.98), 14: (7.5, 0.78), 15: (25.6, 0.78), 16: (15.3, 0.94), 17: (9.8, 0.66),
        19: (8.3, 0.80), 20: (20.0, 0.70), 21: (17.5, 0.93), 22: (10.2, 0.62)},
    2: {4: (8.1, 0.98), 5: (4.0, 0.54), 6: (17.9, 0.81), 7: (8.3, 0.98), 8: (9.7, 0.97), 9: (3.7, 0.76),
        10: (20.4, 0.69), 11: (8.2, 0.97)},
    3: {4: (9.1, 0.97), 5: (4.7, 0.86), 8: (9.7, 0.97), 9: (4.3, 0.86), 12: (6.7, 0.79)},
    4: {4: (8.7, 0.88), 5: (5.6, 0.98), 8: (8.9, 0.85), 9: (5.0, 0.98), 12: (5.4, 0.77)},
}  # fmt: skip
"""Task -> angle, numbered from 1 as in the paper and in WHOLE_BODY -> RMSD in deg and correlation."""

ROTATIONS = (6, 10, 16, 21)
KNEES = (7, 11)


class Cell(NamedTuple):
    """Agreement of one angle in one task."""

    task: int
    angle: int  # from 1
    rmsd_deg: float
    zero_mean_deg: float
    correlation: float
    range_deg: float

    @property
    def moves(self) -> bool:
        """Whether it is one of those that move and can be seen."""
        return self.range_deg >= LARGE_DEG and self.angle not in ROTATIONS


def score(task: int, estimate: Array, truth: Array) -> list[Cell]:
    """Cells of one trial: angles (n, 22) rad, from 2 s on."""
    return [
        agreement(task, k, estimate[SKIPPED_FRAMES:, k - 1], truth[SKIPPED_FRAMES:, k - 1]) for k in PUBLISHED[task]
    ]


def agreement(task: int, angle: int, estimate: Array, truth: Array) -> Cell:
    """Cell of one angle, (n,) rad; not finite counts as wrong by half a turn."""
    error = np.degrees(np.mod(estimate - truth + np.pi, 2.0 * np.pi) - np.pi)
    error = np.where(np.isfinite(error), error, 180.0)
    degrees = np.degrees(truth)
    s = (degrees + error).std() * degrees.std()
    correlation = float(
        np.mean((degrees + error - (degrees + error).mean()) * (degrees - degrees.mean())) / max(s, 1e-9)
    )
    return Cell(task, angle, float(np.sqrt(np.mean(error**2))), float(error.std()), correlation, float(np.ptp(degrees)))


def mean_cells(trials: list[list[Cell]]) -> list[Cell]:
    """Mean over people of each cell, for trials of any tasks."""
    grouped: dict[tuple[int, int], list[Cell]] = {}
    for cells in trials:
        for cell in cells:
            grouped.setdefault((cell.task, cell.angle), []).append(cell)
    return [Cell(*key, *np.mean([cell[2:] for cell in cells], axis=0).tolist()) for key, cells in grouped.items()]


def summary(cells: Sequence[Cell]) -> tuple[float, float, float]:
    """Mean RMSD and zero-mean RMSD, deg, and correlation."""
    rmsd, zero_mean, correlation = (float(np.mean([cell[i] for cell in cells])) for i in (2, 3, 4))
    return rmsd, zero_mean, correlation
