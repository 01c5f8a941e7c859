"""Frames of a camera on the axes of the room, with what cannot be a joint taken out."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import SkeletonJoint
from services.ingest.skeleton.spine import interpolated
from services.ingest.skeleton.view import CameraView

Array = NDArray[np.float64]

FARTHEST_M = 20.0
"""m from the camera. Depth cameras end at 8; beyond this is damage or another unit."""


ABSURD_M = 1e6
"""m. No unit mistaken for another leads here; larger numbers are damage, and their squares may overflow."""


class RoomFrames(NamedTuple):
    """n frames of one person in the room."""

    joints: tuple[SkeletonJoint, ...]
    position: Array  # n x joints x 3, m: x to the camera, y up, z right of who faces it; NaN where not tracked
    state: NDArray[np.int64]  # n x joints: 0 not tracked, 1 inferred, 2 tracked
    not_finite: int
    """Joints said to be known whose numbers are none; taken as not tracked."""
    out_of_range: int
    """Joints said to be known at the camera itself or beyond 20 m; taken as not tracked."""


def frames_in_room(view: CameraView, positions: Array, codes: NDArray[np.int64] | None = None) -> RoomFrames:
    """Positions n x joints x 3 in the camera's order, axes and unit; codes n x joints, its own numbers of tracking.

    Without codes all is tracked. One frame is n = 1. Joint orientations have no place here: the body's angles come from
    the centres alone.
    """
    metres = placed(view, positions)
    said = np.full(metres.shape[:2], 2) if codes is None else view.state_numbers(np.asarray(codes, dtype=np.int64))
    finite = np.asarray(np.isfinite(metres).all(axis=2))
    distance = np.linalg.norm(np.clip(np.nan_to_num(metres), -ABSURD_M, ABSURD_M), axis=2)
    # A skeleton without a body comes as zeros: nobody's joint is inside the lens.
    in_range = (distance > 0.0) & (distance <= FARTHEST_M)
    state = np.where(finite & in_range, said, 0)
    position, state = interpolated(view.joints, np.where((state > 0)[:, :, None], metres, np.nan), state)
    known = said > 0
    return RoomFrames(
        view.room_joints, position, state, int((known & ~finite).sum()), int((known & finite & ~in_range).sum())
    )


def placed(view: CameraView, positions: Array) -> Array:
    """The same positions in m on the axes of the room, whatever they are."""
    with np.errstate(invalid="ignore", over="ignore"):  # inf times 0 is no number, as it should be
        return np.asarray(positions, dtype=np.float64) @ view.R_room_from_camera.T * view.metres
