"""The closest state within bounds, in the metric of the covariance.

min (x - x+)' P^-1 (x - x+) subject to low <= x[3:3+b] <= high. With D the active rows, signed outwards, and d their
bounds: x = x+ - P D' m, D P D' m = D x+ - d, m >= 0 (Gupta and Hauser 2007, at the updated estimate). The active set
is that of Lawson and Hanson 1974 on the multipliers m: one bound enters at a time, the most violated, and those
whose multiplier would turn negative leave on the way. It ends, at the optimum.
"""

import numpy as np

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.tables import FIRST_BOUNDED, Array, Record, Table

TOLERANCE = 1e-12
"""rad, m. A bound exceeded by less is met."""


@compiled
def solve(x: Array, P: Array, count: int, low: Array, high: Array, bounds: Record) -> None:
    """trial = (D P D')^-1 (D x - d) of the first `count` active bounds, by Cholesky."""
    A, active, sign, trial = bounds.factor, bounds.active, bounds.sign, bounds.trial
    for i in range(count):
        c = FIRST_BOUNDED + active[i]
        edge = high[active[i]] if sign[i] > 0.0 else low[active[i]]
        left = sign[i] * (x[c] - edge)
        for k in range(i + 1):
            total = sign[i] * sign[k] * P[c, FIRST_BOUNDED + active[k]]
            for l in range(k):  # noqa: E741
                total -= A[i, l] * A[k, l]
            if k < i:
                A[i, k] = total / A[k, k]
                left -= A[i, k] * trial[k]
            else:
                A[i, i] = np.sqrt(max(total, 1e-18))
        trial[i] = left / A[i, i]
    for i in range(count - 1, -1, -1):
        for k in range(i + 1, count):
            trial[i] -= A[k, i] * trial[k]
        trial[i] /= A[i, i]


@compiled
def worst(x: Array, P: Array, count: int, low: Array, high: Array, bounds: Record) -> tuple[int, float]:
    """The bound most violated by x - P D' m, and its side: +1 high, -1 low; -1 if there is none."""
    found, side, most = -1, 0.0, TOLERANCE
    for b in range(low.size):
        value, held = x[FIRST_BOUNDED + b], False
        for i in range(count):
            held = held or bounds.active[i] == b
            pull = bounds.sign[i] * bounds.multiplier[i]
            value -= P[FIRST_BOUNDED + b, FIRST_BOUNDED + bounds.active[i]] * pull
        over, under = value - high[b], low[b] - value
        if not held and max(over, under) > most:
            found, most = b, max(over, under)
            side = 1.0 if over > under else -1.0
    return found, side


@compiled
def some_turned(count: int, bounds: Record) -> bool:
    """Whether one of the tried multipliers is not positive."""
    turned = False
    for i in range(count):
        turned = turned or bounds.trial[i] <= 0.0
    return turned


@compiled
def step_towards(count: int, bounds: Record) -> int:
    """Move the multipliers towards the trial as far as none turns negative; drop those that became zero."""
    m, trial = bounds.multiplier, bounds.trial
    share = 1.0
    for i in range(count):
        if trial[i] <= 0.0:
            share = min(share, m[i] / (m[i] - trial[i]))
    left = 0
    for i in range(count):
        moved = m[i] + share * (trial[i] - m[i])
        if moved > 1e-15 or trial[i] > 0.0:
            bounds.active[left], bounds.sign[left], m[left] = bounds.active[i], bounds.sign[i], moved
            left += 1
    return left


@compiled
def project(x: Array, P: Array, low: Array, high: Array, bounds: Record) -> int:
    """Move x (n,) within bounds (b,); how many are active. P (n, M) stays that of the unconstrained estimate."""
    count = 0
    for _ in range(4 * low.size):
        b, side = worst(x, P, count, low, high, bounds)
        if b < 0:
            break
        bounds.active[count], bounds.sign[count], bounds.multiplier[count] = b, side, 0.0
        count += 1
        solve(x, P, count, low, high, bounds)
        while some_turned(count, bounds):
            count = step_towards(count, bounds)
            solve(x, P, count, low, high, bounds)
        for i in range(count):
            bounds.multiplier[i] = bounds.trial[i]
    for i in range(count):
        row, pull = P[FIRST_BOUNDED + bounds.active[i]], bounds.sign[i] * bounds.multiplier[i]
        for k in range(x.size):
            x[k] -= row[k] * pull
    for b in range(low.size):
        # What is left is rounding.
        x[FIRST_BOUNDED + b] = min(max(x[FIRST_BOUNDED + b], low[b]), high[b])
    return count


@compiled
def project_alone(x: Array, P: Array, low: Array, high: Array, bounds: Table) -> int:
    """`project` with a table (1,)."""
    return project(x, P, low, high, bounds[0])
