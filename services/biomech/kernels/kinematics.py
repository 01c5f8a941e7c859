"""Recursion over the joints, root to foot, in world axes."""

import numpy as np

from services.biomech.kernels.compiled import kernel
from services.biomech.kernels.tables import Array, Body, Motion
from services.biomech.kernels.vectors import add, cross, load, rotate, scale, store


@kernel
def turn(R: Array, parent: int, j: int, k: int, angle: float) -> None:
    """R[j] = R[parent] * rotation by angle about coordinate axis k; parent -1 is the world."""
    s, c = np.sin(angle), np.cos(angle)
    k1, k2 = (k + 1) % 3, (k + 2) % 3
    for i in range(3):
        if parent < 0:
            along, u, v = 1.0 * (i == k), 1.0 * (i == k1), 1.0 * (i == k2)
        else:
            along, u, v = R[parent, i, k], R[parent, i, k1], R[parent, i, k2]
        R[j, i, k] = along
        R[j, i, k1] = c * u + s * v
        R[j, i, k2] = c * v - s * u


@kernel
def place(position: Array, body: Body, rotation: Array, origin: Array) -> None:
    """Where the bodies behind the joints are: R_world_from_segment (n, 3, 3) and origins (n, 3) m, no motion."""
    for j in range(body.parent.size):
        p, k = body.parent[j], body.axis[j]
        turned = 0.0 if j < body.translations else body.sign[j] * position[j]
        turn(rotation, p, j, k, turned)
        at = load(body.offset, j)
        if p >= 0:
            at = add(load(origin, p), rotate(rotation, p, at))
        store(origin, j, at)
        if j < body.translations:
            origin[j, k] += body.sign[j] * position[j]


@kernel
def orient(x: Array, body: Body, motion: Motion) -> None:
    """Rotations, joint axes and angular velocities of all segments: all that gyroscopes and gravity need.

    a_j = R_parent e_j,  R_j = R_parent Rot(e_j, q_j),  w_j = w_parent + a_j dq_j,  da_j/dt = w_parent x a_j.
    """
    for j in range(body.parent.size):
        p, k, sign = body.parent[j], body.axis[j], body.sign[j]
        if p < 0:
            a = (sign * (k == 0), sign * (k == 1), sign * (k == 2))
            w = (0.0, 0.0, 0.0)
        else:
            a = (sign * motion.rotation[p, 0, k], sign * motion.rotation[p, 1, k], sign * motion.rotation[p, 2, k])
            w = load(motion.rate, p)
        store(motion.axis, j, a)
        store(motion.axis_rate, j, cross(w, a))
        if j < body.translations:
            turn(motion.rotation, p, j, k, 0.0)
            store(motion.rate, j, w)
        else:
            turn(motion.rotation, p, j, k, sign * x[0, j])
            store(motion.rate, j, add(w, scale(x[1, j], a)))


@kernel
def accelerate(x: Array, body: Body, motion: Motion) -> None:
    """Origins with their velocity and acceleration, angular accelerations, second derivative of the axes.

    Needs `orient` before. For a joint at offset r from its parent's origin:
    V = V_p + w x r,  A = A_p + al x r + w x (w x r),  al_j = al_p + (da/dt) dq + a ddq,
    d2a/dt2 = al x a + w x da/dt.
    """
    zero = (0.0, 0.0, 0.0)
    for j in range(body.parent.size):
        p = body.parent[j]
        a, a_rate = load(motion.axis, j), load(motion.axis_rate, j)
        if p < 0:
            w, al, origin, V, A = zero, zero, zero, zero, zero
            r = load(body.offset, j)
        else:
            w, al = load(motion.rate, p), load(motion.angular_acceleration, p)
            origin, V, A = load(motion.origin, p), load(motion.origin_velocity, p), load(motion.origin_acceleration, p)
            r = rotate(motion.rotation, p, load(body.offset, j))
        swing = cross(w, r)
        origin, V = add(origin, r), add(V, swing)
        A = add(A, add(cross(al, r), cross(w, swing)))
        store(motion.axis_acceleration, j, add(cross(al, a), cross(w, a_rate)))
        if j < body.translations:
            # Only at the root, where the parent does not turn: no Coriolis term.
            origin, V, A = add(origin, scale(x[0, j], a)), add(V, scale(x[1, j], a)), add(A, scale(x[2, j], a))
        else:
            al = add(al, add(scale(x[1, j], a_rate), scale(x[2, j], a)))
        store(motion.angular_acceleration, j, al)
        store(motion.origin, j, origin)
        store(motion.origin_velocity, j, V)
        store(motion.origin_acceleration, j, A)
