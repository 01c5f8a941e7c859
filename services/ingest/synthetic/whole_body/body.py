"""Where joint centres are over many frames at once, on a body whose trunk also bends aside and twists."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from schemas.vocabulary import WHOLE_BODY, JointCentre
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, WholeBodyModel
from services.ingest.synthetic.rigid import rotation_about

Array = NDArray[np.float64]

TRUNK = DOF["trunk_flexion"]


class Placed(NamedTuple):
    """Joint centres over n frames, in the order of JointCentre."""

    centres: Array  # (n, 15, 3) m
    carriers: Array  # (n, 15, 3, 3) R_world_from_segment of what carries each centre


def place(body: WholeBodyModel, q: Array, lengths: Array, bends: Array) -> Placed:
    """q (n, 25): translations of spine_base m, then 22 angles rad; lengths (12,) m; bends (n, 2) rad, of the trunk
    aside (about x) and its twist (about y), after its flexion, which WholeBodyModel does not know."""
    tree, n = body.tree, len(q)
    rotations = np.zeros((len(WHOLE_BODY), n, 3, 3))
    origins = np.zeros((len(WHOLE_BODY), n, 3))
    for j, dof in enumerate(WHOLE_BODY):
        parent = tree.parent[j]
        before = np.broadcast_to(np.eye(3), (n, 3, 3)) if parent < 0 else rotations[parent]
        start = q[:, :3] if parent < 0 else origins[parent]
        origins[j] = start + before @ _along(tree.length[j], tree.along[j], tree.share[j], lengths)
        x, y, z = (float(component) for component in dof.axis)
        rotations[j] = before @ rotation_about((x, y, z), q[:, 3 + j])
        if j == TRUNK:
            aside, twist = rotation_about((1.0, 0.0, 0.0), bends[:, 0]), rotation_about((0.0, 1.0, 0.0), bends[:, 1])
            rotations[j] = rotations[j] @ aside @ twist
    centres = np.zeros((n, len(CENTRE_NAMES), 3))
    for m, carrier in enumerate(tree.carrier):
        lever = _along(tree.centre_length[m], tree.centre_along[m], tree.centre_share[m], lengths)
        centres[:, m] = origins[carrier] + rotations[carrier] @ lever
    return Placed(centres, np.moveaxis(rotations[tree.carrier], 0, 1))


def foothold(centres: Array, *, lowest: bool) -> Array:
    """(n, 3) the point that stays on its place: the middle of the ankles or, with `lowest`, the lower one's track."""
    right, left = (centres[:, CENTRE_NAMES.index(name)] for name in (JointCentre.ANKLE_RIGHT, JointCentre.ANKLE_LEFT))
    if not lowest:
        return np.asarray((right + left) / 2.0)
    higher = np.clip((right[:, 1] - left[:, 1]) / 0.02, -30.0, 30.0)
    share = uniform_filter1d(1.0 / (1.0 + np.exp(higher)), 5)[:, None]
    return np.asarray(share * (right - right[0]) + (1.0 - share) * (left - left[0]) + (right[0] + left[0]) / 2.0)


def _along(length: int, axis: int, share: float, lengths: Array) -> Array:
    offset = np.zeros(3)
    if length >= 0:
        offset[axis] = share * lengths[length]
    return offset
