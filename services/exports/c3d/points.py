"""What stands among the points of a C3D file: joint centres in mm, and angles of a joint as three components."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from schemas.vocabulary import JointCentre
from services.exports.facts import freedoms_of
from services.exports.joint_positions import Positions
from services.exports.motion import Array, Flags, Motion, Times, resampled
from services.exports.parameters import ROWS_AT_A_TIME

MILLIMETRES = 1000.0
LABELS: dict[JointCentre, str] = {
    JointCentre.HIP_RIGHT: "RHJC",
    JointCentre.KNEE_RIGHT: "RKJC",
    JointCentre.ANKLE_RIGHT: "RAJC",
    JointCentre.HIP_LEFT: "LHJC",
    JointCentre.KNEE_LEFT: "LKJC",
    JointCentre.ANKLE_LEFT: "LAJC",
    JointCentre.SHOULDER_RIGHT: "RSJC",
    JointCentre.ELBOW_RIGHT: "REJC",
    JointCentre.WRIST_RIGHT: "RWJC",
    JointCentre.SHOULDER_LEFT: "LSJC",
    JointCentre.ELBOW_LEFT: "LEJC",
    JointCentre.WRIST_LEFT: "LWJC",
    JointCentre.SPINE_BASE: "SPINEBASE",
    JointCentre.SPINE_MID: "SPINEMID",
    JointCentre.SPINE_SHOULDER: "SPINESHOULDER",
}
"""Names that laboratories use for joint centres, also in .trc files."""

Components = tuple[str | None, str | None, str | None]


def _of_leg(side: str) -> dict[str, Components]:
    letter = side[0].upper()
    return {
        f"{letter}HipAngles": (f"hip_flexion_{side}", f"hip_adduction_{side}", f"hip_internal_rotation_{side}"),
        f"{letter}KneeAngles": (f"knee_flexion_{side}", f"knee_adduction_{side}", f"knee_internal_rotation_{side}"),
        f"{letter}AnkleAngles": (f"ankle_dorsiflexion_{side}", None, None),
    }


def _of_arm(side: str) -> dict[str, Components]:
    letter = side[0].upper()
    shoulder = (f"shoulder_flexion_{side}", f"shoulder_adduction_{side}", f"shoulder_internal_rotation_{side}")
    return {f"{letter}ShoulderAngles": shoulder, f"{letter}ElbowAngles": (f"elbow_flexion_{side}", None, None)}


ANGLES: dict[str, Components] = {
    "PelvisAngles": ("pelvis_tilt", "pelvis_obliquity", "pelvis_rotation"),
    **_of_leg("left"),
    **_of_leg("right"),
    "TrunkAngles": ("trunk_flexion", None, None),
    **_of_arm("left"),
    **_of_arm("right"),
}
"""Components in the order sagittal, frontal, transverse, as optical laboratories write them, with our signs."""


class Outputs(NamedTuple):
    """What a file holds beside joint centres: labels of angles, and per component its place in the body model."""

    labels: list[str]
    descriptions: list[str]
    columns: list[tuple[int | None, int | None, int | None]]


def angle_outputs(motion: Motion) -> Outputs:
    """Joints with at least one angle that is told nearly all the time; a component that is not is 0, and says so."""
    freedoms = freedoms_of(motion.model)
    place = {freedom.name: i for i, freedom in enumerate(freedoms) if freedom.name in motion.told}
    outputs = Outputs([], [], [])
    for label, components in ANGLES.items():
        columns = tuple(None if name is None else place.get(name) for name in components)
        if any(column is not None for column in columns):
            said = (f"{axis} {_direction(motion, at)}" for axis, at in zip("XYZ", columns, strict=True))
            outputs.labels.append(label)
            outputs.descriptions.append("; ".join(said))
            outputs.columns.append((columns[0], columns[1], columns[2]))
    return outputs


def _direction(motion: Motion, column: int | None) -> str:
    if column is None:
        return "not measured (0)"
    freedom = freedoms_of(motion.model)[column]
    return f"{freedom.name} deg, + {freedom.positive}"


def frames(
    motion: Motion, positions: Positions | None, outputs: Outputs, times_ns: Times, rate_hz: float
) -> Iterator[bytes]:
    """Point data: x, y, z, residual as float32 per point; -1 as the residual of a point that is not valid then."""
    for first in range(0, times_ns.size, ROWS_AT_A_TIME):
        times = times_ns[first : first + ROWS_AT_A_TIME]
        parts = [] if positions is None else [_centres(positions, times, rate_hz)]
        parts.append(_angles(motion, outputs, times, rate_hz))
        yield np.concatenate(parts, axis=1).astype("<f4").tobytes()


def _centres(positions: Positions, times: Times, rate_hz: float) -> Array:
    track = resampled(positions.track, times, rate_hz)
    return _with_residual(track.value * MILLIMETRES, track.valid)


def _angles(motion: Motion, outputs: Outputs, times: Times, rate_hz: float) -> Array:
    track = resampled(motion.angles, times, rate_hz)
    value = np.zeros((times.size, len(outputs.labels), 3))
    valid = np.ones((times.size, len(outputs.labels)), dtype=bool)
    for point, columns in enumerate(outputs.columns):
        for axis, column in enumerate(columns):
            if column is not None:
                value[:, point, axis] = np.degrees(track.value[:, column, 0])
                valid[:, point] &= track.valid[:, column]
    return _with_residual(value, valid)


def _with_residual(value: Array, valid: Flags) -> Array:
    residual = np.where(valid, 0.0, -1.0)[..., None]
    return np.concatenate([np.where(valid[..., None], value, 0.0), residual], axis=2)
