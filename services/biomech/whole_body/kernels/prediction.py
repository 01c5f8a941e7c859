"""Constant acceleration, driven by white jerk (Colombel eq. 2, 3 and 6)."""

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.tables import COORDINATES, Array


@compiled
def predict(x: Array, P: Array, velocity: int, dt: float, density: Array, held: bool) -> None:
    """x = F x, P = F P F' + Q over dt >= 0.

    x (n,), P (n, M) with M >= n; `velocity` is the column of the first velocity. density (25,): white jerk of each
    coordinate in rad^2/s^5 or m^2/s^5. With `held` it is the variance of a jerk that is constant over the interval,
    Q = s^2 G'G with G = (dt^3/6, dt^2/2, dt) (eq. 6, rad^2/s^6), which has rank one.
    """
    n, M = P.shape
    h, c = dt * dt / 2.0, dt * dt * dt / 6.0
    acceleration = velocity + COORDINATES
    for i in range(COORDINATES):
        v, a = velocity + i, acceleration + i
        x[i] += dt * x[v] + h * x[a]
        x[v] += dt * x[a]
        for k in range(M):
            P[i, k] += dt * P[v, k] + h * P[a, k]
            P[v, k] += dt * P[a, k]
    for i in range(n):
        for k in range(COORDINATES):
            P[i, k] += dt * P[i, velocity + k] + h * P[i, acceleration + k]
            P[i, velocity + k] += dt * P[i, acceleration + k]
    if held:
        pp, pv, pa, vv, va, aa = c * c, c * h, c * dt, h * h, h * dt, dt * dt
    else:
        d2, d3 = dt * dt, dt * dt * dt
        pp, pv, pa, vv, va, aa = d2 * d3 / 20.0, d2 * d2 / 8.0, d3 / 6.0, d3 / 3.0, d2 / 2.0, dt
    for i in range(COORDINATES):
        v, a, s = velocity + i, acceleration + i, density[i]
        P[i, i] += s * pp
        P[v, v] += s * vv
        P[a, a] += s * aa
        P[i, v] += s * pv
        P[v, i] += s * pv
        P[i, a] += s * pa
        P[a, i] += s * pa
        P[v, a] += s * va
        P[a, v] += s * va
