"""Prediction of state and covariance, and the blockwise measurement update."""

import numpy as np

from services.biomech.kernels.compiled import kernel
from services.biomech.kernels.tables import Array, Indices, Update


@kernel
def predict_state(x: Array, dt: float, jerk: Array) -> None:
    """Constant acceleration plus the jerk that is fed in (Joukov eq. 10-15)."""
    h, c = dt * dt / 2.0, dt * dt * dt / 6.0
    for j in range(x.shape[1]):
        x[0, j] += dt * x[1, j] + h * x[2, j] + c * jerk[j]
        x[1, j] += dt * x[2, j] + h * jerk[j]
        x[2, j] += dt * jerk[j]


@kernel
def predict_covariance(P: Array, dt: float, jerk_density: Array, translations: int) -> None:
    """P = F P F' + Q. F acts on rows, then on columns; Q = G G' S / dt with G = (dt^3/6, dt^2/2, dt) per rotation."""
    N, M = P.shape
    r = jerk_density.size - translations
    h = dt * dt / 2.0
    for i in range(r):
        for k in range(M):
            P[i, k] += dt * P[r + i, k] + h * P[2 * r + i, k]
            P[r + i, k] += dt * P[2 * r + i, k]
    for i in range(N):
        for k in range(r):
            P[i, k] += dt * P[i, r + k] + h * P[i, 2 * r + k]
            P[i, r + k] += dt * P[i, 2 * r + k]
    g0, g1, g2 = dt * dt * dt / 6.0, h, dt
    for i in range(r):
        S = jerk_density[translations + i] / dt
        P[i, i] += g0 * g0 * S
        P[r + i, r + i] += g1 * g1 * S
        P[2 * r + i, 2 * r + i] += g2 * g2 * S
        P[i, r + i] += g0 * g1 * S
        P[r + i, i] += g0 * g1 * S
        P[i, 2 * r + i] += g0 * g2 * S
        P[2 * r + i, i] += g0 * g2 * S
        P[r + i, 2 * r + i] += g1 * g2 * S
        P[2 * r + i, r + i] += g1 * g2 * S
    for k in range(translations):
        P[3 * r + k, 3 * r + k] += jerk_density[k] * dt
    # The updates leave an unsymmetric rounding error as it is, and F lets it grow: within 20 s it turned P indefinite.
    for i in range(N):
        for k in range(i):
            P[i, k] = P[k, i]


@kernel
def project(P: Array, H: Array, first: int, last: int, columns: Indices, count: int, W: Array) -> None:
    """W[first:last] = H[first:last] P, using only the columns that H touches."""
    M = P.shape[1]
    for row in range(first, last):
        for k in range(M):
            W[row, k] = 0.0
    for i in range(count):
        c = columns[i]
        for row in range(first, last):
            h = H[row, c]
            for k in range(M):
                W[row, k] += h * P[c, k]


@kernel
def whiten(rows: int, update: Update) -> None:
    """Cholesky of the innovation covariance in L, and W and y multiplied by its inverse, in place."""
    L, W, y = update.L, update.W, update.y
    N = W.shape[1]
    for i in range(rows):
        for j in range(i):
            v = L[i, j]
            for k in range(j):
                v -= L[i, k] * L[j, k]
            L[i, j] = v * L[j, j]
        v = L[i, i]
        for k in range(i):
            v -= L[i, k] * L[i, k]
        L[i, i] = 1.0 / np.sqrt(v)
        for j in range(i):
            y[i] -= L[i, j] * y[j]
            for k in range(N):
                W[i, k] -= L[i, j] * W[j, k]
        y[i] *= L[i, i]
        for k in range(N):
            W[i, k] *= L[i, i]


@kernel
def subtract_gain(P: Array, rows: int, update: Update) -> None:
    """dx += W' y and P -= W' W. Six rows at once are what the compiler turns into the fewest loads of P."""
    W, y, dx = update.W, update.y, update.dx
    N, M = P.shape
    for i in range(rows):
        for k in range(M):
            dx[k] += W[i, k] * y[i]
    if rows == 6:
        for i in range(N):
            a, b, c, d, e, f = W[0, i], W[1, i], W[2, i], W[3, i], W[4, i], W[5, i]
            for k in range(M):
                P[i, k] -= a * W[0, k] + b * W[1, k] + c * W[2, k] + d * W[3, k] + e * W[4, k] + f * W[5, k]
    else:
        for row in range(rows):
            for i in range(N):
                a = W[row, i]
                for k in range(M):
                    P[i, k] -= a * W[row, k]


@kernel
def innovation_covariance(H: Array, innovation: Array, rows: int, update: Update) -> None:
    """L = H W' (lower triangle), y = innovation - H dx: what the blocks before have left of it.

    Over all columns, although many of H are zero: contiguous sums are several times faster than picking columns.
    """
    W, L, dx = update.W, update.L, update.dx
    N = W.shape[1]
    for i in range(rows):
        y = innovation[i]
        for k in range(N):
            y -= H[i, k] * dx[k]
        update.y[i] = y
        for j in range(i + 1):
            v = 0.0
            for k in range(N):
                v += H[i, k] * W[j, k]
            L[i, j] = v
