"""Where the joint centres are, and how they move with angles and lengths."""

import numpy as np

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.tables import COORDINATES, Array, Record, Table


@compiled
def place(q: Array, lengths: Array, body: Record, pose: Record) -> None:
    """Fill `pose` for coordinates q (25,) and lengths (12,)."""
    R, origin = pose.rotation, pose.origin
    for j in range(body.parent.size):
        p, k, sign = body.parent[j], body.axis[j], body.sign[j]
        s, c = np.sin(sign * q[3 + j]), np.cos(sign * q[3 + j])
        k1, k2 = (k + 1) % 3, (k + 2) % 3
        offset = 0.0 if body.length[j] < 0 else body.share[j] * lengths[body.length[j]]
        for i in range(3):
            if p < 0:
                along, u, v = 1.0 * (i == k), 1.0 * (i == k1), 1.0 * (i == k2)
                origin[j, i] = q[i]
            else:
                along, u, v = R[p, i, k], R[p, i, k1], R[p, i, k2]
                origin[j, i] = origin[p, i] + offset * R[p, i, body.along[j]]
            pose.axis[j, i] = sign * along
            R[j, i, k] = along
            R[j, i, k1] = c * u + s * v
            R[j, i, k2] = c * v - s * u
    for m in range(body.carrier.size):
        j = body.carrier[m]
        offset = 0.0 if body.centre_length[m] < 0 else body.centre_share[m] * lengths[body.centre_length[m]]
        for i in range(3):
            pose.centre[m, i] = origin[j, i] + offset * R[j, i, body.centre_along[m]]


@compiled
def place_alone(q: Array, lengths: Array, body: Table, posed: Table) -> None:
    """`place` on tables (1,)."""
    place(q, lengths, body[0], posed[0])


@compiled
def differentiate(body: Record, pose: Record, H: Array) -> None:
    """H (45, 40): d(centre) / d[translations, angles, lengths] at a placed pose; three columns stay zero."""
    for m in range(body.carrier.size):
        for i in range(3):
            line = H[3 * m + i]
            for k in range(line.size):
                line[k] = 0.0
        x, y, z = pose.centre[m, 0], pose.centre[m, 1], pose.centre[m, 2]
        j = body.carrier[m]
        length, along, share = body.centre_length[m], body.centre_along[m], body.centre_share[m]
        for i in range(3):
            H[3 * m + i, i] = 1.0
            if length >= 0:
                H[3 * m + i, COORDINATES + length] = share * pose.rotation[j, i, along]
        while j >= 0:
            a, b, c = pose.axis[j, 0], pose.axis[j, 1], pose.axis[j, 2]
            u, v, w = x - pose.origin[j, 0], y - pose.origin[j, 1], z - pose.origin[j, 2]
            H[3 * m, 3 + j] = b * w - c * v
            H[3 * m + 1, 3 + j] = c * u - a * w
            H[3 * m + 2, 3 + j] = a * v - b * u
            p, length = body.parent[j], body.length[j]
            if length >= 0:
                for i in range(3):
                    H[3 * m + i, COORDINATES + length] += body.share[j] * pose.rotation[p, i, body.along[j]]
            j = p


@compiled
def differentiate_alone(body: Table, posed: Table, H: Array) -> None:
    """`differentiate` on tables (1,)."""
    differentiate(body[0], posed[0], H)
