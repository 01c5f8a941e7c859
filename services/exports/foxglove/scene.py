"""One skeleton as the viewer's messages: a drawing, and the frames of its segments."""

from typing import Any

import numpy as np

from schemas.vocabulary import JointCentre
from services.biomech.rotations import quaternion_from_matrix
from services.exports.joint_positions import BONES
from services.exports.motion import Array, Flags

ROOM = "room"
"""Our axes: x forward, y up, z right."""
FIXED = "world"
"""The viewer's axes: z up."""
_HALF = float(np.sqrt(0.5))
UPRIGHT = {"x": _HALF, "y": 0.0, "z": 0.0, "w": _HALF}
"""The room in the viewer's world: y becomes z."""
_LEFT = {"r": 0.769, "g": 0.306, "b": 0.0, "a": 1.0}
_RIGHT = {"r": 0.0, "g": 0.447, "b": 0.698, "a": 1.0}
_MIDDLE = {"r": 0.4, "g": 0.4, "b": 0.4, "a": 1.0}
_THICKNESS_M = 0.03
_JOINT_M = 0.06
_NOWHERE = {"position": {"x": 0.0, "y": 0.0, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
Message = dict[str, Any]


def stamp(unix_ns: int) -> dict[str, int]:
    """A time as the viewer writes it."""
    return {"sec": unix_ns // 10**9, "nsec": unix_ns % 10**9}


def scene(unix_ns: int, names: tuple[JointCentre, ...], points: Array, told: Flags) -> Message:
    """A ball per joint centre that is known, (n, 3) m, and a line per bone between two of them."""
    place = {name: point for name, point, known in zip(names, points.tolist(), told, strict=True) if known}
    bones = [(a, b) for a, b in BONES if a in place and b in place]
    lines = {
        "type": 2,
        "pose": _NOWHERE,
        "thickness": _THICKNESS_M,
        "scale_invariant": False,
        "points": [_xyz(place[end]) for bone in bones for end in bone],
        "color": _MIDDLE,
        "colors": [_colour(bone[1]) for bone in bones for _ in bone],
        "indices": [],
    }
    spheres = [
        {
            "pose": {**_NOWHERE, "position": _xyz(point)},
            "size": {"x": _JOINT_M, "y": _JOINT_M, "z": _JOINT_M},
            "color": _colour(name),
        }
        for name, point in place.items()
    ]
    empty: dict[str, list[Any]] = {
        kind: [] for kind in ("metadata", "arrows", "cubes", "cylinders", "triangles", "texts", "models")
    }
    entity = {
        "timestamp": stamp(unix_ns),
        "frame_id": ROOM,
        "id": "skeleton",
        "lifetime": {"sec": 0, "nsec": 0},
        "frame_locked": True,
        **empty,
        "spheres": spheres,
        "lines": [lines],
    }
    return {"deletions": [], "entities": [entity]}


def transforms(unix_ns: int, segments: dict[str, tuple[Array, Array]]) -> Message:
    """The room in the viewer's world, and segments (rotation (3, 3), proximal joint (3,) m) in the room."""
    upright = _transform(unix_ns, FIXED, ROOM, {"x": 0.0, "y": 0.0, "z": 0.0}, UPRIGHT)
    parts = [
        _transform(unix_ns, ROOM, name, _xyz(origin.tolist()), _quaternion(R)) for name, (R, origin) in segments.items()
    ]
    return {"transforms": [upright, *parts]}


def _transform(unix_ns: int, parent: str, child: str, translation: Message, rotation: Message) -> Message:
    return {
        "timestamp": stamp(unix_ns),
        "parent_frame_id": parent,
        "child_frame_id": child,
        "translation": translation,
        "rotation": rotation,
    }


def _quaternion(R: Array) -> dict[str, float]:
    w, x, y, z = quaternion_from_matrix(R).tolist()
    return {"x": x, "y": y, "z": z, "w": w}


def _xyz(point: list[float]) -> dict[str, float]:
    return {"x": point[0], "y": point[1], "z": point[2]}


def _colour(name: JointCentre) -> dict[str, float]:
    return _LEFT if name.endswith("_left") else _RIGHT if name.endswith("_right") else _MIDDLE
