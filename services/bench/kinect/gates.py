"""What is asked of ours on the simulated tasks, and how far it is from that."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from schemas.vocabulary import WHOLE_BODY
from services.bench.kinect.cells import KNEES, PUBLISHED, Cell, mean_cells, summary
from services.bench.kinect.contenders import Result
from services.bench.kinect.motions import TASK_NAMES
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.biomech.whole_body.kernels.projection import project_alone
from services.biomech.whole_body.kernels.tables import ACTIVE, table

Array = NDArray[np.float64]

PARTLY = {(1, 4, 8): 6.0, (2, 4, 8): 7.0, (3, 4, 8): 10.0, (4, 5, 9): 3.0, (1, 15, 20): 6.5, (3, 12): 6.5}
"""(Task, angles) -> deg."""
PAPER_GATE = 7.7
LEAST_GAIN = 45.0


def our_gates(kind: str, results: Sequence[Result]) -> list[Row]:
    """Ours under `clinic` noise against every gate, under `paper` noise against its one."""
    cells = mean_cells([result.cells for result in results])
    rmsd, zero_mean, correlation = summary(cells)
    outside = at_most(f"{kind}: ours, frames beyond limits or not finite", sum(r.outside for r in results), "", 0)
    if kind != "clinic":
        return [
            at_most(f"{kind}: ours, 34 cells", rmsd, "deg", PAPER_GATE),
            informative(f"{kind}: ours, 34 cells, zero-mean", zero_mean, "deg"),
            informative(f"{kind}: ours, 34 cells, correlation", correlation, ""),
            outside,
        ]
    moving, knees = [c for c in cells if c.moves], [c for c in cells if c.angle in KNEES and c.task in (1, 2)]
    return [
        at_most("clinic: ours, 34 cells", rmsd, "deg", 7.0, 9.67),
        at_most("clinic: ours, 34 cells, zero-mean", zero_mean, "deg", 4.6),
        at_least("clinic: ours, 34 cells, correlation", correlation, "", 0.68, 0.857),
        informative("clinic: cells that move by 20 deg and are no rotation", len(moving), "", 15),
        at_most("clinic: ours, those cells", summary(moving)[0], "deg", 6.8, 10.2),
        at_least("clinic: ours, those cells, correlation", summary(moving)[2], "", 0.94, 0.933),
        at_most("clinic: ours, knees", summary(knees)[0], "deg", 8.5, 7.6),
        at_least("clinic: ours, knees, correlation", summary(knees)[2], "", 0.96, 0.98),
        *_partly(cells),
        outside,
    ]


def _partly(cells: Sequence[Cell]) -> list[Row]:
    rows = []
    for (task, *angles), limit in PARTLY.items():
        chosen = [c for c in cells if c.task == task and c.angle in angles]
        published = float(np.mean([PUBLISHED[task][angle][0] for angle in angles]))
        name = angle_name(angles[0]).removesuffix(" right")
        rows.append(at_most(f"clinic: ours, {TASK_NAMES[task]}, {name}", summary(chosen)[0], "deg", limit, published))
    return rows


def angle_name(angle: int) -> str:
    """Of an angle numbered from 1, for people."""
    return WHOLE_BODY[angle - 1].name.replace("_", " ")


def gain_row(name: str, ours: float, other: float) -> Row:
    """How much lower ours is than the paper's way with Q by eq. 8, on the same trials."""
    gain = 100.0 * (1.0 - ours / other)
    return at_least(f"{name}: ours below corrected, Q eq. 8 on one person", gain, "%", LEAST_GAIN)


def cell_rows(cells: Sequence[Cell]) -> list[Row]:
    """Every cell; correlation only where the movement is large enough to have one."""
    rows = []
    for cell in cells:
        name = f"table 1: task {cell.task}, angle {cell.angle}, {angle_name(cell.angle)}"
        published = PUBLISHED[cell.task][cell.angle]
        rows.append(informative(f"{name}, RMSD", cell.rmsd_deg, "deg", published[0], detail=True))
        rows.append(informative(f"{name}, zero-mean RMSD", cell.zero_mean_deg, "deg", detail=True))
        if cell.range_deg >= 20.0:
            rows.append(informative(f"{name}, correlation", cell.correlation, "", published[1], detail=True))
    return rows


def projection_row(problems: int = 50) -> Row:
    """Largest distance of our projection from the optimum of the quadratic programme, found by other means."""
    gap = max(projection_gap(seed) for seed in range(problems))
    return at_most(f"projection within bounds: distance from the optimum, {problems} problems", gap, "", 1e-9)


def projection_gap(seed: int, states: int = 40, first: int = 3, count: int = 30) -> float:
    """Distance for one random problem: min |L^-1 (z - x)|, L L' = P, by bounded-variable least squares."""
    generator = np.random.default_rng(seed)
    A, x = generator.normal(size=(states, states)), generator.normal(size=states)
    P = A @ A.T / states + 0.1 * np.eye(states)
    centre = x[first : first + count] + generator.normal(size=count)
    low, high = np.full(states, -np.inf), np.full(states, np.inf)
    low[first : first + count], high[first : first + count] = centre - 0.5, centre + 0.5
    root = np.linalg.inv(np.linalg.cholesky(P))
    optimum = lsq_linear(root, root @ x, (low, high), method="bvls", tol=1e-15, max_iter=500).x
    project_alone(x, P, centre - 0.5, centre + 0.5, table(ACTIVE))
    return float(np.abs(x - optimum).max())
