"""Where the joint centres are, and how they move with angles and lengths."""

import numpy as np

from services.biomech.whole_body.compiled import compiled
from services.biomech.whole_body.kernels.tables import COORDINATES, Array, Pose, Tree


@compiled
def place(q: Array, lengths: Array, tree: Tree, pose: Pose) -> None:
    """Fill `pose` for coordinates q (25,) and lengths (12,)."""
    R, origin = pose.rotation, pose.origin
    for j in range(tree.parent.size):
        p, k, sign = tree.parent[j], tree.axis[j], tree.sign[j]
        s, c = np.sin(sign * q[3 + j]), np.cos(sign * q[3 + j])
        k1, k2 = (k + 1) % 3, (k + 2) % 3
        offset = 0.0 if tree.length[j] < 0 else tree.share[j] * lengths[tree.length[j]]
        for i in range(3):
            if p < 0:
                along, u, v = 1.0 * (i == k), 1.0 * (i == k1), 1.0 * (i == k2)
                origin[j, i] = q[i]
            else:
                along, u, v = R[p, i, k], R[p, i, k1], R[p, i, k2]
                origin[j, i] = origin[p, i] + offset * R[p, i, tree.along[j]]
            pose.axis[j, i] = sign * along
            R[j, i, k] = along
            R[j, i, k1] = c * u + s * v
            R[j, i, k2] = c * v - s * u
    for m in range(tree.carrier.size):
        j = tree.carrier[m]
        offset = 0.0 if tree.centre_length[m] < 0 else tree.centre_share[m] * lengths[tree.centre_length[m]]
        for i in range(3):
            pose.centre[m, i] = origin[j, i] + offset * R[j, i, tree.centre_along[m]]


@compiled
def differentiate(tree: Tree, pose: Pose, H: Array) -> None:
    """H (45, 40): d(centre) / d[translations, angles, lengths] at a placed pose; three columns stay zero."""
    H[:] = 0.0
    for m in range(tree.carrier.size):
        x, y, z = pose.centre[m, 0], pose.centre[m, 1], pose.centre[m, 2]
        j = tree.carrier[m]
        length, along, share = tree.centre_length[m], tree.centre_along[m], tree.centre_share[m]
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
            p, length = tree.parent[j], tree.length[j]
            if length >= 0:
                for i in range(3):
                    H[3 * m + i, COORDINATES + length] += tree.share[j] * pose.rotation[p, i, tree.along[j]]
            j = p
