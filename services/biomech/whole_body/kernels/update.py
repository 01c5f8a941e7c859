"""One frame's joint centres, all at once: at most 45 rows and the soft priors.

W = H P, S = H W' + R = L L', and with W and y multiplied by L^-1: dx = W' y, P - W' W. That is the covariance of
Joseph's form for the optimal gain, symmetric by construction.
"""

import numpy as np

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.kinematics import differentiate, place
from services.biomech.whole_body.kernels.tables import (
    COORDINATES,
    KINEMATIC,
    SEEN,
    Array,
    Columns,
    Indices,
    Noise,
    Priors,
    Tree,
    Update,
)


@compiled
def linearise(x: Array, biased: bool, centres: Array, state: Indices, tree: Tree, update: Update) -> None:
    """Innovations (15, 3), Jacobian, and the rows of the centres that are there: state (15,) 0 none, 1 inferred, 2."""
    place(x[:COORDINATES], x[COORDINATES:SEEN], tree, update.pose)
    differentiate(tree, update.pose, update.H)
    count = 0
    for m in range(centres.shape[0]):
        if state[m] == 0:
            continue
        for i in range(3):
            bias = x[SEEN + 3 * m + i] if biased else 0.0
            e = centres[m, i] - update.pose.centre[m, i] - bias
            update.innovation[m, i] = e
            update.y[3 * count + i] = e
            for k in range(KINEMATIC):
                update.rows[3 * count + i, k] = update.H[3 * m + i, k]
        update.used[count] = m
        count += 1
    update.in_use[0] = count


@compiled
def doubt_bones(centres: Array, state: Indices, tree: Tree, stretch: float, update: Update) -> None:
    """Factor 1 + (error / stretch)^2 for both ends of each bone that is seen longer or shorter than it is.

    A length says so in every posture and without delay, where an innovation may also be a fast movement.
    """
    update.doubt[:] = 1.0
    for m in range(centres.shape[0]):
        b = tree.before[m]
        if b < 0 or state[m] == 0 or state[b] == 0 or stretch <= 0.0:
            continue
        seen, known = 0.0, 0.0
        for i in range(3):
            seen += (centres[m, i] - centres[b, i]) ** 2
            known += (update.pose.centre[m, i] - update.pose.centre[b, i]) ** 2
        e = (np.sqrt(seen) - np.sqrt(known)) / stretch
        update.doubt[m] += e * e
        update.doubt[b] += e * e


@compiled
def project_rows(P: Array, biased: bool, columns: Columns, update: Update) -> None:
    """W = H P: of each row, one translation, the columns that move its centre, and its own bias."""
    W, M = update.W, P.shape[1]
    for a in range(update.in_use[0]):
        m = update.used[a]
        for i in range(3):
            own = SEEN + 3 * m + i
            for k in range(M):
                W[3 * a + i, k] = P[i, k]
            if biased:
                for k in range(M):
                    W[3 * a + i, k] += P[own, k]
        for c in range(3, columns.used[m]):
            j = columns.table[m, c]
            h0, h1, h2 = update.rows[3 * a, j], update.rows[3 * a + 1, j], update.rows[3 * a + 2, j]
            for k in range(M):
                p = P[j, k]
                W[3 * a, k] += h0 * p
                W[3 * a + 1, k] += h1 * p
                W[3 * a + 2, k] += h2 * p


@compiled
def innovation_covariance(
    biased: bool, state: Indices, tree: Tree, columns: Columns, noise: Noise, update: Update
) -> None:
    """S = H P H' + R. R is larger along the bone that leads to a centre, and where it is inferred."""
    W, S, rows, turned = update.W, update.S, update.rows, update.turned
    count = 3 * update.in_use[0]
    for r in range(count):
        for k in range(SEEN):
            turned[k, r] = W[r, k]
    for s in range(count):
        m, line = update.used[s // 3], S[s, :count]
        own = SEEN + 3 * m + s % 3
        first = turned[s % 3, :count]
        for r in range(count):
            line[r] = first[r]
        for c in range(3, columns.used[m]):
            j = columns.table[m, c]
            h, part = rows[s, j], turned[j, :count]
            for r in range(count):
                line[r] += h * part[r]
        if biased:
            for r in range(count):
                line[r] += W[r, own]
    for a in range(update.in_use[0]):
        m = update.used[a]
        factor = update.doubt[m] * (noise.inferred if state[m] == 1 else 1.0)
        believe(a, m, tree.before[m], factor, noise, update)


@compiled
def believe(a: int, m: int, before: int, factor: float, noise: Noise, update: Update) -> None:
    """Add R to the block of the a-th centre in use; beyond the gate, R grows with the square of the distance."""
    S, centre = update.S, update.pose.centre
    u = np.zeros(3)
    if before >= 0:
        u[:] = centre[m] - centre[before]
    b = 3 * a
    block, R = np.empty((3, 3)), np.empty((3, 3))
    for i in range(3):
        for k in range(3):
            R[i, k] = factor * (noise.along[m] * u[i] * u[k] + (noise.variance[m] if i == k else 0.0))
            block[i, k] = S[b + i, b + k]
    e = update.innovation[m]
    update.distance[m] = squared_length(block + R, e[0], e[1], e[2])
    if noise.gate > 0.0 and update.distance[m] > noise.gate:
        R *= (update.distance[m] / noise.gate) ** 2
    for i in range(3):
        for k in range(3):
            S[b + i, b + k] += R[i, k]


@compiled
def squared_length(A: Array, x: float, y: float, z: float) -> float:
    """v' A^-1 v for symmetric A (3, 3)."""
    p, s, w = A[1, 1] * A[2, 2] - A[1, 2] ** 2, A[0, 0] * A[2, 2] - A[0, 2] ** 2, A[0, 0] * A[1, 1] - A[0, 1] ** 2
    q, r = A[0, 2] * A[1, 2] - A[0, 1] * A[2, 2], A[0, 1] * A[1, 2] - A[0, 2] * A[1, 1]
    t = A[0, 1] * A[0, 2] - A[0, 0] * A[1, 2]
    determinant = A[0, 0] * p + A[0, 1] * q + A[0, 2] * r
    return (p * x * x + s * y * y + w * z * z + 2.0 * (q * x * y + r * x * z + t * y * z)) / determinant  # type: ignore[no-any-return]


@compiled
def append_priors(x: Array, P: Array, priors: Priors, share: float, update: Update) -> int:
    """Rows of the soft priors, their variance times `share`, behind those of the centres; how many there are then."""
    W, S, first = update.W, update.S, 3 * update.in_use[0]
    for p in range(priors.column.size):
        c, r = priors.column[p], first + p
        for k in range(P.shape[1]):
            W[r, k] = P[c, k]
        for s in range(first):
            S[s, r] = W[s, c]
        for s in range(p + 1):
            S[first + s, r] = P[c, priors.column[s]]
        S[r, r] += share * priors.variance[p]
        update.y[r] = priors.value[p] - x[c]
    return int(first + priors.column.size)


@compiled
def whiten(rows: int, update: Update) -> None:
    """Factor S = U' U in the upper triangle; W = U'^-1 W, y = U'^-1 y. Rows up to the next multiple of six are emptied.

    Along rows throughout, so that the compiler fills its registers.
    """
    S, W, y, pivot = update.S, update.W, update.y, update.pivot
    M = W.shape[1]
    for r in range(rows):
        inverse = 1.0 / np.sqrt(S[r, r])
        pivot[r] = inverse
        head = S[r, r:rows]
        for k in range(head.size):
            head[k] *= inverse
        for i in range(r + 1, rows):
            f, line, upper = S[r, i], S[i, i:rows], S[r, i:rows]
            for k in range(line.size):
                line[k] -= f * upper[k]
        left = y[r]
        for k in range(r):
            left -= S[k, r] * y[k]
        y[r] = left * inverse
        for s in range(r - r % 6, r):
            f, target, w = S[s, r], W[r], W[s]
            for k in range(M):
                target[k] -= f * w[k]
        for k in range(M):
            W[r, k] *= inverse
        if r % 6 == 5:
            subtract_six(r - 5, rows, S, W)
    for r in range(rows, rows + (-rows) % 6):
        y[r] = 0.0
        for k in range(M):
            W[r, k] = 0.0


@compiled
def subtract_six(first: int, rows: int, S: Array, W: Array) -> None:
    """Take six finished rows of W out of all later ones, while they are in the first cache."""
    t, u, v, w, x, z = W[first], W[first + 1], W[first + 2], W[first + 3], W[first + 4], W[first + 5]
    for r in range(first + 6, rows):
        a, b, c = S[first, r], S[first + 1, r], S[first + 2, r]
        d, e, f = S[first + 3, r], S[first + 4, r], S[first + 5, r]
        target = W[r]
        for k in range(target.size):
            target[k] -= a * t[k] + b * u[k] + c * v[k] + d * w[k] + e * x[k] + f * z[k]


@compiled
def subtract_gain(rows: int, x: Array, P: Array, update: Update) -> None:
    """x += W' y, P -= W' W: the upper triangle, mirrored below."""
    W, y, dx = update.W, update.y, update.dx
    n = P.shape[0]
    dx[:] = 0.0
    for r in range(rows):
        g, row = y[r], W[r]
        for k in range(dx.size):
            dx[k] += g * row[k]
    for i in range(n):
        x[i] += dx[i]
    for r in range(0, rows, 6):
        # Six rows of W stay in the first cache while all of P passes.
        for i in range(n):
            first = i - i % 8
            a, b, c, d, e, f = W[r, i], W[r + 1, i], W[r + 2, i], W[r + 3, i], W[r + 4, i], W[r + 5, i]
            line, s, t, u = P[i, first:], W[r, first:], W[r + 1, first:], W[r + 2, first:]
            v, w, z = W[r + 3, first:], W[r + 4, first:], W[r + 5, first:]
            for k in range(line.size):
                line[k] -= a * s[k] + b * t[k] + c * u[k] + d * v[k] + e * w[k] + f * z[k]
    for i in range(n):
        for k in range(i):
            P[i, k] = P[k, i]


@compiled
def fuse(
    x: Array, P: Array, biased: bool, centres: Array, state: Indices, share: float,
    tree: Tree, columns: Columns, noise: Noise, priors: Priors, update: Update,
) -> None:  # fmt: skip
    """Update x (n,) and P (n, M) with centres (15, 3) m whose state (15,) is 0 not tracked, 1 inferred, 2 tracked.

    share: of a nominal frame's time in this one, inverted: priors tell the same per second at every rate.
    """
    linearise(x, biased, centres, state, tree, update)
    doubt_bones(centres, state, tree, noise.stretch, update)
    project_rows(P, biased, columns, update)
    innovation_covariance(biased, state, tree, columns, noise, update)
    rows = append_priors(x, P, priors, share, update)
    whiten(rows, update)
    squares, log_determinant = 0.0, 0.0
    for r in range(3 * update.in_use[0]):
        squares += update.y[r] ** 2
        log_determinant -= 2.0 * np.log(update.pivot[r])
    update.evidence[0], update.evidence[1] = squares, log_determinant
    subtract_gain(rows, x, P, update)
