"""One frame fitted to joint centres within bounds: Gauss and Newton with Levenberg's damping.

Each step is the exact optimum of its quadratic model within bounds, by the projection that the filter uses too.
"""

import numpy as np

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.kinematics import differentiate, place
from services.biomech.whole_body.kernels.projection import project
from services.biomech.whole_body.kernels.tables import COORDINATES, SEEN, Array, Record, Table

TOLERANCE = 1e-7
"""rad, m. A smaller step ends the fit."""


@compiled
def cost(u: Array, centres: Array, weight: Array, value: Array, stiffness: Array, body: Record, work: Record) -> float:
    """Half the weighted squared distances of the centres and of u from what it is drawn to; leaves the innovations."""
    place(u[:COORDINATES], u[COORDINATES:SEEN], body, work.pose)
    total = 0.0
    for m in range(centres.shape[0]):
        for i in range(3):
            e = centres[m, i] - work.pose.centre[m, i] if weight[m] > 0.0 else 0.0
            work.innovation[m, i] = e
            total += weight[m] * e * e
    for k in range(SEEN):
        total += stiffness[k] * (u[k] - value[k]) ** 2
    return total / 2.0


@compiled
def normal_equations(
    u: Array, free: int, weight: Array, value: Array, stiffness: Array, body: Record, work: Record
) -> tuple[Array, Array]:
    """Curvature (free, free) and descent (free,) of `cost` by the first `free` unknowns."""
    differentiate(body, work.pose, work.H)
    A, descent = np.zeros((free, free)), np.zeros(free)
    for r in range(work.H.shape[0]):
        w = weight[r // 3]
        if w <= 0.0:
            continue
        e, row = work.innovation[r // 3, r % 3], work.H[r]
        for a in range(free):
            h = w * row[a]
            if h == 0.0:
                continue
            descent[a] += h * e
            for b in range(free):
                A[a, b] += h * row[b]
    for a in range(free):
        A[a, a] += stiffness[a]
        descent[a] += stiffness[a] * (value[a] - u[a])
    return A, descent


@compiled
def fit(
    u: Array, free: int, centres: Array, weight: Array, value: Array, stiffness: Array, most: int,
    low: Array, high: Array, bodies: Table, works: Table,
) -> tuple[float, int]:  # fmt: skip
    """Move the first `free` of u (37,) = [q, lengths] to the least `cost` within bounds; that cost and the steps.

    centres (15, 3) m with weight (15,) 1/m^2, 0 for none; each unknown is drawn to value (37,) with stiffness (37,).
    All bounds must lie among the free unknowns.
    """
    body, work = bodies[0], works[0]
    now = cost(u, centres, weight, value, stiffness, body, work)
    damping = 1e-6
    for step in range(most):
        A, descent = normal_equations(u, free, weight, value, stiffness, body, work)
        while True:
            damped = A.copy()
            for a in range(free):
                damped[a, a] += damping * (A[a, a] + 1.0)
            P: Array = np.linalg.inv(damped).astype(np.float64)
            tried = u.copy()
            for a in range(free):
                for b in range(free):
                    tried[a] += P[a, b] * descent[b]
            part = tried[:free].copy()
            project(part, P, low, high, work.bounds)
            tried[:free] = part
            better = cost(tried, centres, weight, value, stiffness, body, work)
            if better <= now or damping > 1e6:
                break
            damping *= 10.0
        moved = np.abs(tried - u).max()
        if better > now:
            break
        u[:], now, damping = tried, better, max(damping / 10.0, 1e-9)
        if moved < TOLERANCE:
            return now, step + 1
    return cost(u, centres, weight, value, stiffness, body, work), most
