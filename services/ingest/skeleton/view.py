"""How one camera looks into the room: what turns its numbers into metres on the room's axes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import CameraKind, SkeletonJoint, TrackingState
from services.ingest.axes import Axes, rotation_from_axes
from services.ingest.errors import WrongAxes
from services.ingest.skeleton.spine import with_interpolated
from services.ingest.skeleton.vendors import STATES, VENDORS
from services.ingest.units import scale_to_si

Array = NDArray[np.float64]

LARGEST_TILT = math.radians(60.0)
"""rad. Nobody sets up a camera for a standing person steeper; beyond it the direction is that of something else."""


@dataclass(frozen=True, slots=True)
class CameraView:
    """One camera: its joints in its own order, and the way from its numbers to the room."""

    kind: CameraKind
    joints: tuple[SkeletonJoint, ...]
    metres: float
    """m per unit of the camera."""
    R_room_from_camera: Array  # (3, 3)
    states: tuple[TrackingState, ...]
    """By the camera's own number."""
    room_joints: tuple[SkeletonJoint, ...] = field(init=False)
    """Joints of every frame in the room, in order."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "room_joints", with_interpolated(self.joints))

    def state_numbers(self, codes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Place in STATES of each of the camera's codes; a code that it does not have is not tracked."""
        table = np.array([STATES.index(state) for state in self.states], dtype=np.int64)
        known = (codes >= 0) & (codes < len(table))
        return np.where(known, table[np.where(known, codes, 0)], 0)


def view_of(
    kind: CameraKind,
    *,
    up: Sequence[float] | None = None,
    joints: Sequence[SkeletonJoint] | None = None,
    axes: Axes | None = None,
    unit: str | None = None,
) -> CameraView:
    """The view of a camera of this kind; what is given stands over what its SDK says.

    up: (3,) any length, the direction up in the camera's own axes, as an accelerometer or the floor plane tells it.
    None: its case stands level. axes: the room's x, y, z in the camera's, the camera being level. A camera of the kind
    `other` must give joints and axes; its unit is m and its states are numbered like those of a Kinect v2.

    Raises WrongAxes, InvalidManifest or UnknownUnit.
    """
    vendor = VENDORS.get(kind)
    if vendor is None and (joints is None or axes is None):
        raise WrongAxes(f"a camera of the kind {kind} is not known; give its joints in order, and its axes")
    delivered = tuple(joints) if joints is not None else vendor.joints if vendor else ()
    R_level = rotation_from_axes(axes or (list(vendor.axes) if vendor else None), f"camera {kind}")
    pitch = vendor.pitch if vendor else 0.0
    direction = R_level.T @ [math.sin(pitch), math.cos(pitch), 0.0] if up is None else np.asarray(up, dtype=np.float64)
    return CameraView(
        kind,
        delivered,
        scale_to_si("length", unit or (vendor.unit if vendor else "m")),
        levelled(R_level, direction),
        vendor.states if vendor else STATES,
    )


def levelled(R_room_from_level_camera: Array, up_in_camera: Array) -> Array:
    """R_room_from_camera of a tilted camera: y against gravity, x the horizontal part of the way to the camera.

    up_in_camera (3,), not zero. Raises WrongAxes for a direction that no camera on its feet can see as up.
    """
    length = float(np.linalg.norm(up_in_camera))
    if up_in_camera.shape != (3,) or not (math.isfinite(length) and length > 0.0):
        raise WrongAxes(f"up {up_in_camera.tolist()} is no direction; give three numbers in the camera's axes")
    y = up_in_camera / length
    tilt = math.acos(min(1.0, max(-1.0, float(R_room_from_level_camera[1] @ y))))
    if tilt > LARGEST_TILT:
        raise WrongAxes(
            f"up {up_in_camera.tolist()} lies {math.degrees(tilt):.0f} deg from the camera's own upward axis, more "
            f"than {math.degrees(LARGEST_TILT):.0f}; check its sign and the order of the axes"
        )
    x = R_room_from_level_camera[0] - (R_room_from_level_camera[0] @ y) * y
    x /= float(np.linalg.norm(x))
    return np.array([x, y, np.cross(x, y)])


def plane_of_floor(plane: Sequence[float], metres: float = 1.0) -> tuple[list[float], float]:
    """The direction up in the camera's axes, and the height of the floor in the room (negative: below the camera), m.

    plane: a, b, c, d of a x + b y + c z + d = 0 in the camera's axes and unit, as a Kinect v2 tells it (FloorClipPlane,
    all zero while it sees no floor). Raises WrongAxes for one without a direction.
    """
    normal, d = np.asarray(plane[:3], dtype=np.float64), float(plane[3])
    length = float(np.linalg.norm(normal))
    if len(plane) != 4 or not (math.isfinite(length) and length > 0.0 and math.isfinite(d)) or d == 0.0:
        raise WrongAxes(
            f"floor plane {list(plane)} is none; give a, b, c, d of a x + b y + c z + d = 0, or leave it out"
        )
    # The camera, at the origin, is above the floor: the normal that points to it is the one for which d is positive.
    sign = math.copysign(1.0, d)
    return (sign * normal / length).tolist(), -abs(d) / length * metres
