"""Skeletons of depth cameras in the axes of the room. Pure, shared by recordings and live cameras.

    view = view_of(CameraKind.AZURE_KINECT, up=up_in_camera)     # once per camera; refuses what cannot be
    frames = frames_in_room(view, positions, codes)              # n x joints x 3 and n x joints, as the vendor delivers
    batch = skeleton_batch(captured_ns, body, people, frames)    # the message; positions null where not tracked

`view.joints` are the joints as the camera orders them, `view.room_joints` those of `frames` and of the camera's
description: the fifteen centres that there are, then the others. What a camera lacks of the centres is interpolated.
"""

from services.ingest.skeleton.message import skeleton_batch
from services.ingest.skeleton.room import RoomFrames, frames_in_room
from services.ingest.skeleton.vendors import AZURE_KINECT_JOINTS, KINECT_V2_JOINTS
from services.ingest.skeleton.view import CameraView, plane_of_floor, view_of

__all__ = [
    "AZURE_KINECT_JOINTS",
    "KINECT_V2_JOINTS",
    "CameraView",
    "RoomFrames",
    "frames_in_room",
    "plane_of_floor",
    "skeleton_batch",
    "view_of",
]  # fmt: skip
