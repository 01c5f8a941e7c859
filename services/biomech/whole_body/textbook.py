"""The filter's equations in plain numpy: oracle of the tests and baseline of the bench.

The state is ordered as that of `WholeBodyEkf`. No soft priors, no gate, no bounds.
"""

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.kernels.tables import BIASES, CENTRES, COORDINATES, SEEN
from services.biomech.whole_body.model import WholeBodyModel

Array = NDArray[np.float64]


def transition(states: int, dt_s: float) -> Array:
    """F (n, n) of eq. 2."""
    F = np.eye(states)
    i = np.arange(COORDINATES)
    velocity, acceleration = states - 2 * COORDINATES + i, states - COORDINATES + i
    F[i, velocity], F[i, acceleration], F[velocity, acceleration] = dt_s, dt_s**2 / 2.0, dt_s
    return F


def process_noise(states: int, dt_s: float, density: Array, *, held: bool) -> Array:
    """Q (n, n): white jerk of `density` (25,), or, held, eq. 6 with its variance."""
    if held:
        G = np.array([dt_s**3 / 6.0, dt_s**2 / 2.0, dt_s])
        block = np.outer(G, G)
    else:
        block = np.array([
            [dt_s**5 / 20.0, dt_s**4 / 8.0, dt_s**3 / 6.0],
            [dt_s**4 / 8.0, dt_s**3 / 3.0, dt_s**2 / 2.0],
            [dt_s**3 / 6.0, dt_s**2 / 2.0, dt_s],
        ])  # fmt: skip
    Q, i = np.zeros((states, states)), np.arange(COORDINATES)
    place = (i, states - 2 * COORDINATES + i, states - COORDINATES + i)
    for a in range(3):
        for b in range(3):
            Q[place[a], place[b]] = density * block[a, b]
    return Q


def measurement(model: WholeBodyModel, x: Array) -> tuple[Array, Array]:
    """h(x) (45,) m and H (45, n)."""
    states = len(x)
    H = np.zeros((3 * CENTRES, states))
    H[:, :SEEN] = model.jacobian(x[:COORDINATES], x[COORDINATES:SEEN]).reshape(3 * CENTRES, SEEN)
    expected = model.centres(x[:COORDINATES], x[COORDINATES:SEEN]).ravel()
    if states == SEEN + BIASES + 2 * COORDINATES:
        H[:, SEEN : SEEN + BIASES] = np.eye(BIASES)
        expected = expected + x[SEEN : SEEN + BIASES]
    return expected, H


def joseph(P: Array, K: Array, H: Array, R: Array) -> Array:
    """(I - K H) P (I - K H)' + K R K', right for any gain."""
    left = np.eye(len(P)) - K @ H
    return np.asarray(left @ P @ left.T + K @ R @ K.T)


def update(model: WholeBodyModel, x: Array, P: Array, centres: Array, variance: Array) -> tuple[Array, Array]:
    """Updated x and P for centres (15, 3), of which those that are finite have rows, with variance (15,) m^2."""
    expected, H = measurement(model, x)
    there = np.isfinite(centres).all(axis=1).repeat(3)
    y = (centres.ravel() - expected)[there]
    H, R = H[there], np.diag(variance.repeat(3)[there])
    K: Array = np.asarray(np.linalg.solve(H @ P @ H.T + R, H @ P).T, dtype=np.float64)
    return x + K @ y, joseph(P, K, H, R)
