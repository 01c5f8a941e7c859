"""Projection within bounds against a quadratic programme solved by other means."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from services.biomech.whole_body.kernels.projection import project_alone
from services.biomech.whole_body.kernels.tables import ACTIVE, table

STATES, FIRST, COUNT = 40, 3, 30


def project(x: np.ndarray, P: np.ndarray, low: np.ndarray, high: np.ndarray) -> int:
    return project_alone(x, P, low, high, table(ACTIVE))


def problem(seed: int, tightness: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    generator = np.random.default_rng(seed)
    A = generator.normal(size=(STATES, STATES))
    P = A @ A.T / STATES + 0.1 * np.eye(STATES)
    x = generator.normal(size=STATES)
    centre = x[FIRST : FIRST + COUNT] + generator.normal(size=COUNT)
    return x, P, centre - tightness, centre + tightness


def optimum(x: np.ndarray, P: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """min |L^-1 (z - x)| with L L' = P by bounded-variable least squares, an active set of its own."""
    inverse = np.linalg.inv(np.linalg.cholesky(P))
    lower, upper = np.full(STATES, -np.inf), np.full(STATES, np.inf)
    lower[FIRST : FIRST + COUNT], upper[FIRST : FIRST + COUNT] = low, high
    return lsq_linear(inverse, inverse @ x, (lower, upper), method="bvls", tol=1e-15, max_iter=500).x


@pytest.mark.parametrize("tightness", [0.05, 0.5, 1.5])
@pytest.mark.parametrize("seed", range(8))
def test_projection_is_the_optimum(seed: int, tightness: float) -> None:
    x, P, low, high = problem(seed, tightness)
    expected = optimum(x, P, low, high)
    moved = x.copy()
    active = project(moved, P, low, high)
    assert moved == pytest.approx(expected, abs=1e-9)
    assert active > 0
    inside = moved[FIRST : FIRST + COUNT]
    assert (inside >= low).all()
    assert (inside <= high).all()


def test_one_bound_after_the_other_would_not_be() -> None:
    x, P, low, high = problem(3, 0.5)
    moved = x.copy()
    for i in range(COUNT):
        c = FIRST + i
        excess = moved[c] - np.clip(moved[c], low[i], high[i])
        moved -= P[:, c] * excess / P[c, c]
    assert np.abs(moved - optimum(x, P, low, high)).max() > 1e-3


def test_within_bounds_nothing_moves() -> None:
    x, P, _, _ = problem(1, 1.0)
    moved = x.copy()
    wide = np.full(COUNT, 100.0)
    assert project(moved, P, -wide, wide) == 0
    assert (moved == x).all()
