"""Constant acceleration, driven by white jerk (Colombel eq. 2, 3 and 6)."""

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.tables import COORDINATES, SEEN, Array, Record


@compiled
def predict(x: Array, P: Array, velocity: int, dt: float, belief: Record) -> None:
    """x = F x, P = F P F' + Q over dt >= 0; `velocity` is the column of the first velocity.

    With q, v, a the coordinates and their derivatives, c all that is constant, and h = dt^2/2:
    P_qc += dt P_vc + h P_ac, P_vc += dt P_ac, and the nine blocks among q, v and a.
    """
    h = dt * dt / 2.0
    acceleration = velocity + COORDINATES
    for i in range(COORDINATES):
        x[i] += dt * x[velocity + i] + h * x[acceleration + i]
        x[velocity + i] += dt * x[acceleration + i]
    mirror_rates(P, velocity)
    carry_rows(P, velocity, dt, h)
    carry_coordinates(P, velocity, dt, h)
    carry_rates(P, velocity, dt)
    drive(P, velocity, dt, belief.density, belief.held > 0.0)


@compiled
def mirror_rates(P: Array, velocity: int) -> None:
    """Fill what is left of the diagonal in P_vv, P_aa and P_av, which is not kept from frame to frame."""
    for i in range(COORDINATES):
        line, below = P[velocity + i], P[velocity + COORDINATES + i]
        for k in range(i):
            line[velocity + k] = P[velocity + k, velocity + i]
            below[velocity + COORDINATES + k] = P[velocity + COORDINATES + k, velocity + COORDINATES + i]
        for k in range(COORDINATES):
            below[velocity + k] = P[velocity + k, velocity + COORDINATES + i]


@compiled
def carry_rows(P: Array, velocity: int, dt: float, h: float) -> None:
    """P F' of the rows of coordinates, and F P F' of those of constants."""
    acceleration = velocity + COORDINATES
    for i in range(velocity):
        q, v, a = P[i, :COORDINATES], P[i, velocity:acceleration], P[i, acceleration : acceleration + COORDINATES]
        if i < SEEN:
            for k in range(q.size):
                q[k] += dt * v[k] + h * a[k]
        if i >= SEEN:
            for k in range(q.size):
                P[k, i] += dt * v[k] + h * a[k]
        elif i >= COORDINATES:
            for k in range(q.size):
                P[k, i] = q[k]
        for k in range(v.size):
            v[k] += dt * a[k]


@compiled
def carry_coordinates(P: Array, velocity: int, dt: float, h: float) -> None:
    """F (P F') of the rows of coordinates: P_qv and P_qa, and P_qq from both.

    Before the call P_qq[k, i] is the covariance of i as it will be with k as it was.
    """
    acceleration, c = velocity + COORDINATES, h - dt * dt
    end = acceleration + COORDINATES
    for i in range(COORDINATES):
        v, a = P[i, velocity:acceleration], P[i, acceleration:end]
        vv, va = P[velocity + i, velocity:acceleration], P[velocity + i, acceleration:end]
        av, aa = P[acceleration + i, velocity:acceleration], P[acceleration + i, acceleration:end]
        for k in range(v.size):
            v[k] += dt * (vv[k] + dt * va[k]) + h * (av[k] + dt * aa[k])
            a[k] += dt * va[k] + h * aa[k]
        for k in range(i, COORDINATES):
            P[i, k] = P[k, i] + dt * v[k] + c * a[k]
            P[k, i] = P[i, k]


@compiled
def carry_rates(P: Array, velocity: int, dt: float) -> None:
    """P_vv and P_va."""
    acceleration = velocity + COORDINATES
    end = acceleration + COORDINATES
    for i in range(COORDINATES):
        vv, va = P[velocity + i, velocity:acceleration], P[velocity + i, acceleration:end]
        av, aa = P[acceleration + i, velocity:acceleration], P[acceleration + i, acceleration:end]
        for k in range(vv.size):
            vv[k] += dt * (av[k] + va[k] + dt * aa[k])
            va[k] += dt * aa[k]


@compiled
def drive(P: Array, velocity: int, dt: float, density: Array, held: bool) -> None:
    """Add Q. density (25,): white jerk of each coordinate in rad^2/s^5 or m^2/s^5.

    With `held` it is the variance of a jerk that is constant over the interval, Q = s^2 G'G with
    G = (dt^3/6, dt^2/2, dt) (eq. 6, rad^2/s^6), which has rank one.
    """
    h, c = dt * dt / 2.0, dt * dt * dt / 6.0
    if held:
        pp, pv, pa, vv, va, aa = c * c, c * h, c * dt, h * h, h * dt, dt * dt
    else:
        d2, d3 = dt * dt, dt * dt * dt
        pp, pv, pa, vv, va, aa = d2 * d3 / 20.0, d2 * d2 / 8.0, d3 / 6.0, d3 / 3.0, d2 / 2.0, dt
    for i in range(COORDINATES):
        v, a, s = velocity + i, velocity + COORDINATES + i, density[i]
        P[i, i] += s * pp
        P[i, v] += s * pv
        P[i, a] += s * pa
        P[v, v] += s * vv
        P[v, a] += s * va
        P[a, a] += s * aa
