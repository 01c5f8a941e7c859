"""How much each centre is believed: by tracking state, along its bone, at bones of wrong length, beyond the gate."""

import numpy as np

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.tables import KINEMATIC, SEEN, Array, Indices, Record


@compiled
def doubt_bones(centres: Array, state: Indices, body: Record, stretch: float, work: Record) -> None:
    """Factor 1 + (error / stretch)^2 for both ends of each bone that is seen longer or shorter than it is.

    A length says so in every posture and without delay, where an innovation may also be a fast movement.
    """
    centre, doubt = work.pose.centre, work.doubt
    for m in range(doubt.size):
        doubt[m] = 1.0
    for m in range(centres.shape[0]):
        b = body.before[m]
        if b < 0 or state[m] == 0 or state[b] == 0 or stretch <= 0.0:
            continue
        seen, known = 0.0, 0.0
        for i in range(3):
            seen += (centres[m, i] - centres[b, i]) ** 2
            known += (centre[m, i] - centre[b, i]) ** 2
        e = (np.sqrt(seen) - np.sqrt(known)) / stretch
        doubt[m] += e * e
        doubt[b] += e * e


@compiled
def believe(m: int, inferred: bool, biased: bool, P: Array, body: Record, belief: Record, work: Record) -> None:
    """R of a centre, larger along the bone that leads to it; beyond the gate it grows with the square of the distance.

    The distance is that from the prediction, whatever other centres of the frame say.
    """
    R, centre, before, gate = work.R[m], work.pose.centre, body.before[m], belief.gate
    factor = work.doubt[m] * (belief.inferred if inferred else 1.0)
    for i in range(3):
        for k in range(3):
            R[i, k] = factor * belief.variance[m] if i == k else 0.0
            if before >= 0:
                bone = (centre[m, i] - centre[before, i]) * (centre[m, k] - centre[before, k])
                R[i, k] += factor * belief.along[m] * bone
    expected_covariance(m, biased, P, body, work)
    for i in range(3):
        for k in range(3):
            work.own[i, k] += R[i, k]
    e = work.innovation[m]
    work.distance[m] = squared_length(work.own, e[0], e[1], e[2])
    if gate > 0.0 and work.distance[m] > gate:
        for i in range(3):
            for k in range(3):
                R[i, k] *= (work.distance[m] / gate) ** 2


@compiled
def expected_covariance(m: int, biased: bool, P: Array, body: Record, work: Record) -> None:
    """H P H' of one centre, (3, 3), left in `work.own`."""
    near, own, columns, moving = work.near, work.own, body.columns[m], body.moving[m]
    first = SEEN + 3 * m
    for i in range(3):
        for k in range(3):
            own[i, k] = 0.0
        line, row = near[i], P[i, :KINEMATIC]
        for k in range(line.size):
            line[k] = row[k]
    for c in range(3, moving):
        j, row = columns[c], P[columns[c], :KINEMATIC]
        for i in range(3):
            h, line = work.H[3 * m + i, j], near[i]
            for k in range(line.size):
                line[k] += h * row[k]
    if biased:
        for i in range(3):
            for k in range(3):
                total = P[i, first + k]
                for c in range(3, moving):
                    total += work.H[3 * m + i, columns[c]] * P[columns[c], first + k]
                own[i, k] += total
                own[k, i] += total
                own[i, k] += P[first + min(i, k), first + max(i, k)]
    for i in range(3):
        for k in range(3):
            total = near[i, k]
            for c in range(3, moving):
                total += near[i, columns[c]] * work.H[3 * m + k, columns[c]]
            own[i, k] += total


@compiled
def squared_length(A: Array, x: float, y: float, z: float) -> float:
    """v' A^-1 v for symmetric A (3, 3)."""
    p, s, w = A[1, 1] * A[2, 2] - A[1, 2] ** 2, A[0, 0] * A[2, 2] - A[0, 2] ** 2, A[0, 0] * A[1, 1] - A[0, 1] ** 2
    q, r = A[0, 2] * A[1, 2] - A[0, 1] * A[2, 2], A[0, 1] * A[1, 2] - A[0, 2] * A[1, 1]
    t = A[0, 1] * A[0, 2] - A[0, 0] * A[1, 2]
    determinant = A[0, 0] * p + A[0, 1] * q + A[0, 2] * r
    return (p * x * x + s * y * y + w * z * z + 2.0 * (q * x * y + r * x * z + t * y * z)) / determinant  # type: ignore[no-any-return]
