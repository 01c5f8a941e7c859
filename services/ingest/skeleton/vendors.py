"""What each depth camera delivers: joints in the order of its SDK, axes, unit, and how it says what it knows.

Kinect v2: JointType, TrackingState and CameraSpacePoint of the Kinect for Windows SDK 2.0. x grows to the sensor's
left, y up, z where the sensor looks; m. States 0 not tracked, 1 inferred, 2 tracked.

Azure Kinect: k4abt_joint_id_t, k4abt_joint_confidence_level_t and the coordinate systems page of Microsoft's
documentation. x right, y down, z forward from the depth camera; mm. Confidence 0 none: out of range, 1 low: not
observed but predicted, 2 medium, 3 high, which no SDK has delivered yet.

Both look along z, so a person who faces the camera has the right hand on the camera's left: our z is Kinect's x and
Azure's minus x.
"""

import math
from dataclasses import dataclass

from schemas.vocabulary import CameraKind, SkeletonJoint, TrackingState

_J = SkeletonJoint

KINECT_V2_JOINTS: tuple[SkeletonJoint, ...] = (
    _J.SPINE_BASE, _J.SPINE_MID, _J.NECK, _J.HEAD,
    _J.SHOULDER_LEFT, _J.ELBOW_LEFT, _J.WRIST_LEFT, _J.HAND_LEFT,
    _J.SHOULDER_RIGHT, _J.ELBOW_RIGHT, _J.WRIST_RIGHT, _J.HAND_RIGHT,
    _J.HIP_LEFT, _J.KNEE_LEFT, _J.ANKLE_LEFT, _J.FOOT_LEFT,
    _J.HIP_RIGHT, _J.KNEE_RIGHT, _J.ANKLE_RIGHT, _J.FOOT_RIGHT,
    _J.SPINE_SHOULDER, _J.HAND_TIP_LEFT, _J.THUMB_LEFT, _J.HAND_TIP_RIGHT, _J.THUMB_RIGHT,
)  # fmt: skip
"""The 25 joints of a Kinect v2 by number."""

AZURE_KINECT_JOINTS: tuple[SkeletonJoint, ...] = (
    _J.SPINE_BASE, _J.SPINE_NAVEL, _J.SPINE_CHEST, _J.NECK,
    _J.CLAVICLE_LEFT, _J.SHOULDER_LEFT, _J.ELBOW_LEFT, _J.WRIST_LEFT, _J.HAND_LEFT, _J.HAND_TIP_LEFT, _J.THUMB_LEFT,
    _J.CLAVICLE_RIGHT, _J.SHOULDER_RIGHT, _J.ELBOW_RIGHT, _J.WRIST_RIGHT, _J.HAND_RIGHT, _J.HAND_TIP_RIGHT,
    _J.THUMB_RIGHT,
    _J.HIP_LEFT, _J.KNEE_LEFT, _J.ANKLE_LEFT, _J.FOOT_LEFT,
    _J.HIP_RIGHT, _J.KNEE_RIGHT, _J.ANKLE_RIGHT, _J.FOOT_RIGHT,
    _J.HEAD, _J.NOSE, _J.EYE_LEFT, _J.EAR_LEFT, _J.EYE_RIGHT, _J.EAR_RIGHT,
)  # fmt: skip
"""The 32 joints of an Azure Kinect by number. Its PELVIS, the root of the spine, is our spine_base."""

_LOST, _GUESSED, _SEEN = TrackingState.NOT_TRACKED, TrackingState.INFERRED, TrackingState.TRACKED

STATES: tuple[TrackingState, ...] = (_LOST, _GUESSED, _SEEN)
"""A state's number inside this package, and for the filter: 0 not tracked, 1 inferred, 2 tracked."""


@dataclass(frozen=True, slots=True)
class Vendor:
    """One kind of camera."""

    joints: tuple[SkeletonJoint, ...]
    axes: tuple[str, str, str]  # the room's x, y, z among the camera's axes, the camera being level
    unit: str  # of length, as in units.py
    states: tuple[TrackingState, ...]  # by the vendor's number
    pitch: float  # rad by which the camera looks down while its case is level


VENDORS: dict[CameraKind, Vendor] = {
    CameraKind.KINECT_V2: Vendor(
        KINECT_V2_JOINTS, axes=("-z", "y", "x"), unit="m", states=(_LOST, _GUESSED, _SEEN), pitch=0.0
    ),
    CameraKind.AZURE_KINECT: Vendor(
        AZURE_KINECT_JOINTS,
        axes=("-z", "-y", "-x"),
        unit="mm",
        states=(_LOST, _GUESSED, _SEEN, _SEEN),
        pitch=math.radians(6.0),  # the depth camera is tilted against the colour camera (coordinate systems page)
    ),
}
"""Cameras whose skeletons need no further description."""
