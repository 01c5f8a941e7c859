"""Prediction of state and covariance, and the measurement update in blocks of six rows.

Six rows of W are what fits the vector registers; a block with fewer has empty ones: W = 0, unit variance.
"""

import numpy as np

from services.biomech.kernels.compiled import inlined, kernel
from services.biomech.kernels.fixed import Width, fixed
from services.biomech.kernels.tables import REGISTER, Array, Indices, Update
from services.biomech.kernels.vectors import Vector


@kernel
def predict_state(x: Array, dt: float, jerk: Array) -> None:
    """Constant acceleration plus the jerk that is fed in (Joukov eq. 10-15)."""
    h, c = dt * dt / 2.0, dt * dt * dt / 6.0
    for j in range(x.shape[1]):
        x[0, j] += dt * x[1, j] + h * x[2, j] + c * jerk[j]
        x[1, j] += dt * x[2, j] + h * jerk[j]
        x[2, j] += dt * jerk[j]


@kernel
def predict_covariance(
    P: Array, dt: float, jerk_density: Array, least: float, translations: int, complete: int, width: Width
) -> None:
    """P = F P F' + Q. F acts on rows, then on columns; Q = G G' S / dt with G = (dt^3/6, dt^2/2, dt) per rotation,
    whose S is `least` or more.

    Rows from `complete` on are left stale before the diagonal block, see `subtract_gain`.
    """
    P = fixed(P, width)
    M = P.shape[1]
    r = jerk_density.size - translations
    h = dt * dt / 2.0
    for i in range(r):
        for k in range(M):
            P[i, k] += dt * P[r + i, k] + h * P[2 * r + i, k]
            P[r + i, k] += dt * P[2 * r + i, k]
    for i in range(complete):
        for k in range(r):
            P[i, k] += dt * P[i, r + k] + h * P[i, 2 * r + k]
            P[i, r + k] += dt * P[i, 2 * r + k]
    g0, g1, g2 = dt * dt * dt / 6.0, h, dt
    for i in range(r):
        S = max(jerk_density[translations + i], least) / dt
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


@kernel
def mirror(P: Array) -> None:
    """The lower triangle becomes the upper one.

    Rounding makes P unsymmetric and F lets that grow: without mirroring, P is indefinite within 20 s.
    """
    for i in range(P.shape[0]):
        for k in range(i):
            P[i, k] = P[k, i]


@kernel
def project(P: Array, H: Array, first: int, columns: Indices, count: int, update: Update) -> None:
    """Three rows: W[first:first+3] = H[first:first+3] P, from the columns that H touches, three at a time.

    `count` is a multiple of three; what fills the last three up are columns that these rows do not touch.
    """
    P, W = fixed(P, update.width), fixed(update.W, update.width)[first:]
    M = P.shape[1]
    for k in range(M):
        W[0, k], W[1, k], W[2, k] = 0.0, 0.0, 0.0
    for i in range(0, count, 3):
        a, b, c = columns[i], columns[i + 1], columns[i + 2]
        h0, h1, h2 = load_picked(H, first, a, b, c)
        h3, h4, h5 = load_picked(H, first + 1, a, b, c)
        h6, h7, h8 = load_picked(H, first + 2, a, b, c)
        for k in range(M):
            u, v, w = P[a, k], P[b, k], P[c, k]
            W[0, k] += h0 * u + h1 * v + h2 * w
            W[1, k] += h3 * u + h4 * v + h5 * w
            W[2, k] += h6 * u + h7 * v + h8 * w


@inlined
def load_picked(H: Array, row: int, a: int, b: int, c: int) -> Vector:
    """Three entries of a row."""
    return H[row, a], H[row, b], H[row, c]


@kernel
def innovation_covariance(H: Array, innovation: Array, variance: Array, update: Update) -> None:
    """L = H W' + R (lower triangle), y = innovation - H dx: what the blocks before have left of it.

    Over all columns, although many of H are zero: contiguous sums are several times faster than picking columns.
    """
    H, W, L, dx = fixed(H, update.width), fixed(update.W, update.width), update.L, update.dx
    for i in range(6):
        y, a, b, c, d, e, f = innovation[i], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(W.shape[1]):
            h = H[i, k]
            y -= h * dx[k]
            a += h * W[0, k]
            b += h * W[1, k]
            c += h * W[2, k]
            d += h * W[3, k]
            e += h * W[4, k]
            f += h * W[5, k]
        update.y[i] = y
        L[i, 0], L[i, 1], L[i, 2], L[i, 3], L[i, 4], L[i, 5] = a, b, c, d, e, f
        L[i, i] += variance[i]


@kernel
def whiten(update: Update) -> None:
    """W and y multiplied by the inverse of the Cholesky factor of L, in place; dx += W' y.

    Written out so that the factor stays in registers; it is left in L, the diagonal as its reciprocal.
    """
    L, W, y, dx = update.L, fixed(update.W, update.width), update.y, update.dx
    l00 = 1.0 / np.sqrt(L[0, 0])
    l10, l20, l30, l40, l50 = L[1, 0] * l00, L[2, 0] * l00, L[3, 0] * l00, L[4, 0] * l00, L[5, 0] * l00
    l11 = 1.0 / np.sqrt(L[1, 1] - l10 * l10)
    l21, l31 = (L[2, 1] - l20 * l10) * l11, (L[3, 1] - l30 * l10) * l11
    l41, l51 = (L[4, 1] - l40 * l10) * l11, (L[5, 1] - l50 * l10) * l11
    l22 = 1.0 / np.sqrt(L[2, 2] - l20 * l20 - l21 * l21)
    l32 = (L[3, 2] - l30 * l20 - l31 * l21) * l22
    l42 = (L[4, 2] - l40 * l20 - l41 * l21) * l22
    l52 = (L[5, 2] - l50 * l20 - l51 * l21) * l22
    l33 = 1.0 / np.sqrt(L[3, 3] - l30 * l30 - l31 * l31 - l32 * l32)
    l43 = (L[4, 3] - l40 * l30 - l41 * l31 - l42 * l32) * l33
    l53 = (L[5, 3] - l50 * l30 - l51 * l31 - l52 * l32) * l33
    l44 = 1.0 / np.sqrt(L[4, 4] - l40 * l40 - l41 * l41 - l42 * l42 - l43 * l43)
    l54 = (L[5, 4] - l50 * l40 - l51 * l41 - l52 * l42 - l53 * l43) * l44
    l55 = 1.0 / np.sqrt(L[5, 5] - l50 * l50 - l51 * l51 - l52 * l52 - l53 * l53 - l54 * l54)
    y0 = y[0] * l00
    y1 = (y[1] - l10 * y0) * l11
    y2 = (y[2] - l20 * y0 - l21 * y1) * l22
    y3 = (y[3] - l30 * y0 - l31 * y1 - l32 * y2) * l33
    y4 = (y[4] - l40 * y0 - l41 * y1 - l42 * y2 - l43 * y3) * l44
    y5 = (y[5] - l50 * y0 - l51 * y1 - l52 * y2 - l53 * y3 - l54 * y4) * l55
    y[0], y[1], y[2], y[3], y[4], y[5] = y0, y1, y2, y3, y4, y5
    L[0, 0], L[1, 0], L[1, 1], L[2, 0], L[2, 1], L[2, 2] = l00, l10, l11, l20, l21, l22
    L[3, 0], L[3, 1], L[3, 2], L[3, 3] = l30, l31, l32, l33
    L[4, 0], L[4, 1], L[4, 2], L[4, 3], L[4, 4] = l40, l41, l42, l43, l44
    L[5, 0], L[5, 1], L[5, 2], L[5, 3], L[5, 4], L[5, 5] = l50, l51, l52, l53, l54, l55
    for k in range(W.shape[1]):
        a = W[0, k] * l00
        b = (W[1, k] - l10 * a) * l11
        c = (W[2, k] - l20 * a - l21 * b) * l22
        d = (W[3, k] - l30 * a - l31 * b - l32 * c) * l33
        e = (W[4, k] - l40 * a - l41 * b - l42 * c - l43 * d) * l44
        f = (W[5, k] - l50 * a - l51 * b - l52 * c - l53 * d - l54 * e) * l55
        W[0, k], W[1, k], W[2, k], W[3, k], W[4, k], W[5, k] = a, b, c, d, e, f
        dx[k] += a * y0 + b * y1 + c * y2 + d * y3 + e * y4 + f * y5


@kernel
def subtract_gain(P: Array, complete: int, update: Update) -> None:
    """P -= W' W.

    Rows from `complete` on are read by no later block: of them only the diagonal block is brought up to date,
    what stands before it follows from `mirror` at the end of the step.
    """
    P, W = fixed(P, update.width), fixed(update.W, update.width)
    for i in range(complete):
        a, b, c, d, e, f = W[0, i], W[1, i], W[2, i], W[3, i], W[4, i], W[5, i]
        for k in range(P.shape[1]):
            P[i, k] -= a * W[0, k] + b * W[1, k] + c * W[2, k] + d * W[3, k] + e * W[4, k] + f * W[5, k]
    start = complete // REGISTER * REGISTER
    P, W = P[complete:, start:], W[:, start:]
    for i in range(P.shape[0]):
        n = i + complete - start
        a, b, c, d, e, f = W[0, n], W[1, n], W[2, n], W[3, n], W[4, n], W[5, n]
        for k in range(P.shape[1]):
            P[i, k] -= a * W[0, k] + b * W[1, k] + c * W[2, k] + d * W[3, k] + e * W[4, k] + f * W[5, k]
