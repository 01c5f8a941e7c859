"""Angles of a session as coordinates of an OpenSim model."""

from typing import NamedTuple

import numpy as np

from services.exports.errors import ExportError
from services.exports.joint_positions import rotation_about
from services.exports.motion import Array, Flags, Motion, Times
from services.exports.opensim.models import PELVIS, Coordinate, OpenSimModel

_UP, _RIGHT, _FORWARD = 1, 2, 0
_OURS_OF_PELVIS = ("pelvis_rotation", "pelvis_tilt", "pelvis_obliquity")


class Coordinates(NamedTuple):
    """Columns (n, m) rad of the coordinates that are told; rows in which one of them is not valid are left out."""

    names: tuple[str, ...]
    times_ns: Times  # (n,)
    values: Array  # (n, m)
    without: tuple[str, ...]
    """Coordinates of the model that the session does not tell."""
    rows_left_out: int


def to_coordinates(motion: Motion, model: OpenSimModel) -> Coordinates:
    """Every coordinate of the model that is valid nearly all the time.

    Raises ExportError: none is, or values lie where the model cannot go, so that a sign would be wrong.
    """
    columns: dict[str, tuple[Array, Flags]] = {}
    if set(_OURS_OF_PELVIS) <= motion.told:
        columns |= pelvis_columns(motion, model.pelvis)
    for coordinate in model.coordinates:
        if coordinate.freedom in motion.told:
            angle, valid = motion.angle(coordinate.freedom)
            columns[coordinate.name] = (_checked(coordinate, coordinate.sign * angle, valid), valid)
    if not columns:
        wanted = ", ".join(coordinate.freedom for coordinate in model.coordinates)
        raise ExportError("joint_state.valid", f"none of {wanted} is told", "export joint_angles.csv")
    rows = np.logical_and.reduce([valid for _, valid in columns.values()])
    values = np.stack([value[rows] for value, _ in columns.values()], axis=1)
    every = (*model.pelvis, *(coordinate.name for coordinate in model.coordinates))
    without = tuple(name for name in every if name not in columns)
    times_ns = motion.angles.times_ns
    return Coordinates(tuple(columns), times_ns[rows], values, without, int((~rows).sum()))


def pelvis_columns(motion: Motion, rotations: tuple[str, ...]) -> dict[str, tuple[Array, Flags]]:
    """Rotations of the pelvis as the model has them: in one plane its tilt, else all three of Z, X, Y."""
    (heading, turned), (tilt, tilted), (obliquity, listed) = (motion.angle(name) for name in _OURS_OF_PELVIS)
    if rotations == PELVIS[:1]:
        return {PELVIS[0]: (-tilt, tilted)}
    valid = turned & tilted & listed
    values = tilt_list_rotation(heading, tilt, obliquity)
    values[2, valid] = np.unwrap(values[2, valid])
    return {name: (value, valid) for name, value in zip(PELVIS, values, strict=True) if name in rotations}


def tilt_list_rotation(heading: Array, tilt: Array, obliquity: Array) -> Array:
    """(3, n) rad of OpenSim's pelvis for our three angles (n,) rad.

    Ours turn about y, then forward over (about -z), then right side up (about -x): R = Ry(h) Rz(-t) Rx(-o).
    OpenSim's turn about z, x, y: R = Rz(tilt) Rx(list) Ry(rotation), positive backward, right side down, to the left;
    so R[2, 1] = sin(list), R[0, 1] / R[1, 1] = -tan(tilt), R[2, 0] / R[2, 2] = -tan(rotation).
    """
    R = rotation_about(_UP, heading) @ rotation_about(_RIGHT, -tilt) @ rotation_about(_FORWARD, -obliquity)
    listed = np.arcsin(np.clip(R[:, 2, 1], -1.0, 1.0))
    return np.stack([np.arctan2(-R[:, 0, 1], R[:, 1, 1]), listed, np.arctan2(-R[:, 2, 0], R[:, 2, 2])])


def _checked(coordinate: Coordinate, value: Array, valid: Flags) -> Array:
    """The values, unless most would fit the model's range with the other sign only."""
    low, high = coordinate.limits
    told = value[valid]
    fits, mirrored = (float(np.mean((signed >= low) & (signed <= high))) for signed in (told, -told))
    if fits < 0.5 < mirrored:
        what = f"{fits:.0%} of its values lie within {low:g} to {high:g} rad, with the other sign {mirrored:.0%}"
        raise ExportError(f"model.{coordinate.name}", what, "choose another model, or check the session's sides")
    return value
