"""Centres of the spine that a camera does not deliver, from those that it does.

Microsoft documents names, parents and a drawing of the joints of both cameras, no anatomical positions, and we found
none published to rest on. So the body is that of the Kinect v2, on which the filter and its paper rest, and what can be
told of it:

- spine_shoulder is the top of the spine at the height of the shoulders, where the arms begin. An Azure Kinect's arms
  begin at its two clavicles, children of spine_chest that stay with the chest: the middle between them. Without
  clavicles it is the middle of the shoulders.
- spine_mid lies at 0.573 of the way from spine_base to spine_shoulder: the mean of each of four recordings with a
  Kinect v2. An Azure Kinect has two joints in between; it is taken along the bones.
- spine_base lies between the hips.

What is then still a constant offset between two cameras, the filter learns as bias.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre, SkeletonJoint

Array = NDArray[np.float64]
States = NDArray[np.int64]

SPINE_MID_SHARE = 0.573
"""Of the spine's length above spine_base, along its bones; dimensionless."""

_J = SkeletonJoint
_MIDDLE_OF: dict[SkeletonJoint, tuple[tuple[SkeletonJoint, SkeletonJoint], ...]] = {
    _J.SPINE_BASE: ((_J.HIP_LEFT, _J.HIP_RIGHT),),
    _J.SPINE_SHOULDER: ((_J.CLAVICLE_LEFT, _J.CLAVICLE_RIGHT), (_J.SHOULDER_LEFT, _J.SHOULDER_RIGHT)),
}
_SPINE = (_J.SPINE_BASE, _J.SPINE_NAVEL, _J.SPINE_CHEST, _J.SPINE_SHOULDER)

_CENTRES = [SkeletonJoint(centre) for centre in JointCentre]


def with_interpolated(joints: Sequence[SkeletonJoint]) -> tuple[SkeletonJoint, ...]:
    """The joints of a camera and what can be interpolated: first the centres in their order, then the others."""
    there = set(joints)
    there |= {joint for joint, pairs in _MIDDLE_OF.items() if any(there.issuperset(pair) for pair in pairs)}
    if {_SPINE[0], _SPINE[-1]} <= there:
        there.add(_J.SPINE_MID)
    return tuple(joint for joint in SkeletonJoint if joint in there)


def interpolated(joints: Sequence[SkeletonJoint], position: Array, state: States) -> tuple[Array, States]:
    """Frames in the order of `with_interpolated(joints)`: position n x joints x 3, state n x joints.

    What is interpolated is as well known as the worst of what it comes from; NaN stays NaN.
    """
    place = {joint: i for i, joint in enumerate(joints)}
    columns = {joint: (position[:, i], state[:, i]) for joint, i in place.items()}
    for joint, pairs in _MIDDLE_OF.items():
        pair = next((pair for pair in pairs if all(end in columns for end in pair)), None)
        if joint not in columns and pair is not None:
            (a, state_of_a), (b, state_of_b) = (columns[end] for end in pair)
            columns[joint] = 0.5 * (a + b), np.minimum(state_of_a, state_of_b)
    if _J.SPINE_MID not in columns and {_SPINE[0], _SPINE[-1]} <= set(columns):
        spine = [columns[joint] for joint in _SPINE if joint in columns]
        middle = along(np.stack([at for at, _ in spine], axis=1), SPINE_MID_SHARE)
        columns[_J.SPINE_MID] = middle, np.min([known for _, known in spine], axis=0)
    order = with_interpolated(joints)
    return np.stack([columns[joint][0] for joint in order], axis=1), np.stack(
        [columns[joint][1] for joint in order], axis=1
    )


def along(chain: Array, share: float) -> Array:
    """n x 3, the point of each frame at a share (0 to 1) of the way along a chain of points n x points x 3."""
    bones = np.diff(chain, axis=1)
    lengths = np.linalg.norm(bones, axis=2)
    ends = np.cumsum(lengths, axis=1)
    way = share * ends[:, -1:]
    bone = np.minimum((ends < way).sum(axis=1), lengths.shape[1] - 1)
    frame = np.arange(len(chain))
    begun = ends[frame, bone] - lengths[frame, bone]
    within = (way[:, 0] - begun) / np.maximum(lengths[frame, bone], 1e-9)
    return np.asarray(chain[frame, bone] + within[:, None] * bones[frame, bone])
