"""A person who stands before a camera with the right arm raised sideways, in the room and as each camera sees it."""

import math

import numpy as np

from schemas.vocabulary import SkeletonJoint

J = SkeletonJoint

STANDING = {
    # m in the room: 2.5 m from the camera, which is 0.9 m above the floor; right arm raised sideways
    J.SPINE_BASE: (-2.5, 0.05, 0.0), J.SPINE_MID: (-2.5, 0.3365, 0.0), J.SPINE_SHOULDER: (-2.5, 0.55, 0.0),
    J.SPINE_NAVEL: (-2.5, 0.2, 0.0), J.SPINE_CHEST: (-2.5, 0.4, 0.0),
    J.CLAVICLE_RIGHT: (-2.5, 0.55, 0.03), J.CLAVICLE_LEFT: (-2.5, 0.55, -0.03),
    J.NECK: (-2.5, 0.6, 0.0), J.HEAD: (-2.5, 0.78, 0.0), J.NOSE: (-2.4, 0.75, 0.0),
    J.SHOULDER_RIGHT: (-2.5, 0.5, 0.18), J.ELBOW_RIGHT: (-2.5, 0.5, 0.46), J.WRIST_RIGHT: (-2.5, 0.5, 0.7),
    J.HAND_RIGHT: (-2.45, 0.5, 0.78),
    J.SHOULDER_LEFT: (-2.5, 0.5, -0.18), J.ELBOW_LEFT: (-2.5, 0.22, -0.2), J.WRIST_LEFT: (-2.45, -0.02, -0.2),
    J.HAND_LEFT: (-2.4, -0.1, -0.2),
    J.HIP_RIGHT: (-2.5, 0.0, 0.09), J.KNEE_RIGHT: (-2.45, -0.42, 0.1), J.ANKLE_RIGHT: (-2.5, -0.82, 0.1),
    J.FOOT_RIGHT: (-2.35, -0.88, 0.1),
    J.HIP_LEFT: (-2.5, 0.0, -0.09), J.KNEE_LEFT: (-2.45, -0.42, -0.1), J.ANKLE_LEFT: (-2.5, -0.82, -0.1),
    J.FOOT_LEFT: (-2.35, -0.88, -0.1),
}  # fmt: skip
"""Joints not named stay at the head: nobody looks at them here."""


def in_room(joint):
    return np.array(STANDING.get(joint, STANDING[J.HEAD]))


def seen_by_kinect_v2(point):
    """x to the camera's left (the right of who faces it), y up, z away from it; m."""
    x, y, z = point
    return [z, y, -x]


def seen_by_azure(point):
    """x to the camera's right, y down, z forward, all turned down by 6 deg; mm."""
    x, y, z = point
    pitch = math.radians(6.0)
    forward, up = -x, y
    along_view = forward * math.cos(pitch) - up * math.sin(pitch)
    below_view = -(up * math.cos(pitch) + forward * math.sin(pitch))
    return [-1000 * z, 1000 * below_view, 1000 * along_view]
