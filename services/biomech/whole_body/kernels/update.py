"""One frame's joint centres and the soft priors, six rows at a time.

W = H P, S = H W' + R = L L', and with W and y multiplied by L^-1: dx = W' y, P - W' W. That is the covariance of
Joseph's form for the optimal gain, symmetric by construction. Noise of different centres is independent and all rows
are linearised where the frame found the state, so that one group after the other gives what all rows at once would:
only the innovation must know what the groups before have moved.
"""

import numpy as np

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.kinematics import differentiate
from services.biomech.whole_body.kernels.tables import CENTRES, GROUP, SEEN, Array, Indices, Record
from services.biomech.whole_body.kernels.weighing import believe, doubt_bones


@compiled
def fuse(
    x: Array, P: Array, biased: bool, centres: Array, state: Indices, share: float,
    body: Record, belief: Record, work: Record,
) -> None:  # fmt: skip
    """Update x (n,) and P (n, M) with centres (15, 3) m whose state (15,) is 0 not tracked, 1 inferred, 2 tracked.

    `work` holds the pose and what is expected there. share: of a nominal frame's time in this one, inverted: priors
    tell the same per second at every rate.
    """
    differentiate(body, work.pose, work.H)
    doubt_bones(centres, state, body, belief.stretch, work)
    count = 0
    for m in range(CENTRES):
        if state[m] != 0:
            for i in range(3):
                work.innovation[m, i] = centres[m, i] - work.expected[m, i]
            believe(m, state[m] == 1, biased, P, body, belief, work)
            work.used[count] = m
            count += 1
    work.in_use, work.squares, work.log_determinant = count, 0.0, 0.0
    for k in range(work.dx.size):
        work.dx[k] = 0.0
    for a in range(0, count, 2):
        rows = take_centres(P, biased, a, min(count - a, 2), body, work)
        whiten(rows, P.shape[1], work)
        for r in range(rows):
            work.squares += work.y[r] ** 2
            work.log_determinant += 2.0 * np.log(work.S[r, r])
        subtract_gain(P, work)
    for p in range(0, belief.priors, GROUP):
        rows = take_priors(x, P, p, min(belief.priors - p, GROUP), share, belief, work)
        whiten(rows, P.shape[1], work)
        subtract_gain(P, work)
    for k in range(x.size):
        x[k] += work.dx[k]


@compiled
def take_centres(P: Array, biased: bool, first: int, count: int, body: Record, work: Record) -> int:
    """W, S and y of one or two of the centres in use, from place `first`; how many rows they are."""
    for a in range(count):
        m = work.used[first + a]
        project_rows(P, biased, m, 3 * a, body, work)
        for i in range(3):
            r, H = 3 * a + i, work.H[3 * m + i]
            moved = work.dx[i] + (work.dx[SEEN + 3 * m + i] if biased else 0.0)
            for c in range(3, body.moving[m]):
                moved += H[body.columns[m, c]] * work.dx[body.columns[m, c]]
            work.y[r] = work.innovation[m, i] - moved
    for a in range(count):
        m = work.used[first + a]
        for i in range(3):
            r, own, H = 3 * a + i, SEEN + 3 * m + i, work.H[3 * m + i]
            for s in range(r + 1):
                W = work.W[s]
                total = W[i] + (W[own] if biased else 0.0)
                for c in range(3, body.moving[m]):
                    total += H[body.columns[m, c]] * W[body.columns[m, c]]
                work.S[r, s] = total + (work.R[m, i, s - 3 * a] if s >= 3 * a else 0.0)
    return 3 * count


@compiled
def project_rows(P: Array, biased: bool, m: int, first: int, body: Record, work: Record) -> None:
    """W = H P of a centre: one translation each, the columns that move it, and its own bias."""
    M = P.shape[1]
    w0, w1, w2 = work.W[first, :M], work.W[first + 1, :M], work.W[first + 2, :M]
    p0, p1, p2 = P[0], P[1], P[2]
    for k in range(w0.size):
        w0[k], w1[k], w2[k] = p0[k], p1[k], p2[k]
    for c in range(3, body.moving[m]):
        j = body.columns[m, c]
        h0, h1, h2, row = work.H[3 * m, j], work.H[3 * m + 1, j], work.H[3 * m + 2, j], P[j]
        for k in range(w0.size):
            p = row[k]
            w0[k] += h0 * p
            w1[k] += h1 * p
            w2[k] += h2 * p
    if not biased:
        return
    own = SEEN + 3 * m
    for k in range(own):
        w0[k] += P[k, own]
        w1[k] += P[k, own + 1]
        w2[k] += P[k, own + 2]
    w1[own] += P[own, own + 1]
    w2[own] += P[own, own + 2]
    w2[own + 1] += P[own + 1, own + 2]
    for i in range(3):
        line, row = work.W[first + i, own + i : M], P[own + i, own + i : M]
        for k in range(line.size):
            line[k] += row[k]


@compiled
def take_priors(x: Array, P: Array, first: int, count: int, share: float, belief: Record, work: Record) -> int:
    """W, S and y of `count` soft priors, their variance times `share`."""
    for r in range(count):
        column = belief.prior_column[first + r]
        line, row = work.W[r, : P.shape[1]], P[column]
        for k in range(line.size):
            line[k] = row[k]
        for s in range(r + 1):
            work.S[r, s] = row[belief.prior_column[first + s]]
        work.S[r, r] += share * belief.prior_variance[first + r]
        work.y[r] = belief.prior_value[first + r] - x[column] - work.dx[column]
    return count


@compiled
def whiten(rows: int, M: int, work: Record) -> None:
    """Factor S = L L' in place; W = L^-1 W, y = L^-1 y, and dx += W' y. Rows of the group without use are emptied."""
    S, y, dx = work.S, work.y, work.dx[:M]
    for r in range(rows):
        for s in range(r + 1):
            total = S[r, s]
            for l in range(s):  # noqa: E741
                total -= S[r, l] * S[s, l]
            S[r, s] = np.sqrt(total) if s == r else total / S[s, s]
        left = y[r]
        for s in range(r):
            left -= S[r, s] * y[s]
        y[r] = left / S[r, r]
    for r in range(rows):
        line = work.W[r, :M]
        for s in range(r):
            f, before = S[r, s], work.W[s, :M]
            for k in range(line.size):
                line[k] -= f * before[k]
        f, g = 1.0 / S[r, r], y[r]
        for k in range(line.size):
            line[k] *= f
            dx[k] += g * line[k]
    for r in range(rows, GROUP):
        line = work.W[r]
        for k in range(line.size):
            line[k] = 0.0


@compiled
def subtract_gain(P: Array, work: Record) -> None:
    """P -= W' W, as far as P is kept: six rows of W stay in the first cache while P passes once."""
    n, M, W = P.shape[0], P.shape[1], work.W
    for i in range(n):
        first = 0 if i < SEEN else i - i % 8
        a, b, c, d, e, f = W[0, i], W[1, i], W[2, i], W[3, i], W[4, i], W[5, i]
        line, s, t, u = P[i, first:], W[0, first:M], W[1, first:M], W[2, first:M]
        v, w, z = W[3, first:M], W[4, first:M], W[5, first:M]
        for k in range(line.size):
            line[k] -= a * s[k] + b * t[k] + c * u[k] + d * v[k] + e * w[k] + f * z[k]
