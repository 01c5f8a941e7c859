"""The truths of the NeuRA walk: Plug-in-Gait, joint centres, segment orientations."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ReferenceBatch
from schemas.signals import REFERENCE
from schemas.vocabulary import Side
from services.biomech.rotations import matrix_from_quaternion
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NeuraTruth:
    """Angles by side, each (frames,) in degrees, NaN where unknown."""

    knee_plug_in_gait: dict[Side, Array]
    knee_joint_centres: dict[Side, Array]
    hip_segments: dict[Side, Array]

    def by_label(self) -> dict[str, tuple[str, dict[Side, Array]]]:
        """Label of each truth -> joint and angles."""
        return {
            "knee PiG": ("knee", self.knee_plug_in_gait),
            "knee joint centres": ("knee", self.knee_joint_centres),
            "hip": ("hip", self.hip_segments),
        }


def reference_channels(spec: str) -> dict[str, Array]:
    """All reference channels of a recording by name, (frames,) in SI units, NaN where unknown."""
    source = open_source(spec, session="truth")
    names = [channel.name for channel in source.describe().reference]
    rows = [
        row
        for message in iter_messages(source)
        if message.stream.signal is REFERENCE and isinstance(message.payload, ReferenceBatch)
        for row in message.payload.values
    ]
    table = np.array([[np.nan if value is None else value for value in row] for row in rows])
    return {name: table[:, i] for i, name in enumerate(names)}


def collect_truth(spec: str) -> NeuraTruth:
    """Read a recording's reference and make angles of it."""
    channels = reference_channels(spec)
    return NeuraTruth(
        {side: np.degrees(channels[f"knee_flexion_{side}"]) for side in Side},
        {side: knee_from_joint_centres(channels, side) for side in Side},
        {side: hip_from_segments(channels, side) for side in Side},
    )


def _point(channels: dict[str, Array], name: str) -> Array:
    return np.stack([channels[f"{name}_{axis}"] for axis in "xyz"], axis=1)


def knee_from_joint_centres(channels: dict[str, Array], side: Side) -> Array:
    """Angle between the lines hip-knee and knee-ankle, seen along the pelvis's horizontal right; degrees."""
    front = _point(channels, "asis_left") + _point(channels, "asis_right")
    forward = front - _point(channels, "psis_left") - _point(channels, "psis_right")
    forward[:, 1] = 0.0
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    hip, knee, ankle = (_point(channels, f"{joint}_{side}") for joint in ("hip", "knee", "ankle"))

    def inclination(line: Array) -> Array:
        return np.asarray(np.arctan2(np.sum(line * forward, axis=1), -line[:, 1]))

    return np.asarray(np.degrees(inclination(knee - hip) - inclination(ankle - knee)))


def hip_from_segments(channels: dict[str, Array], side: Side) -> Array:
    """First angle of the rotation from pelvis to thigh in the order flexion, adduction, rotation; degrees.

    R = Rz(flexion) Rx Ry, so tan(flexion) = -R[0, 1] / R[1, 1].
    """
    pelvis, thigh = (_quaternions(channels, name) for name in ("pelvis", f"thigh_{side}"))
    flexion = np.full(len(pelvis), np.nan)
    for i, (p, t) in enumerate(zip(pelvis, thigh, strict=True)):
        if np.isfinite(p).all() and np.isfinite(t).all():
            R_pelvis_from_thigh = matrix_from_quaternion(p).T @ matrix_from_quaternion(t)
            flexion[i] = np.arctan2(-R_pelvis_from_thigh[0, 1], R_pelvis_from_thigh[1, 1])
    return np.asarray(np.degrees(flexion))


def _quaternions(channels: dict[str, Array], segment: str) -> Array:
    return np.stack([channels[f"quat_world_from_{segment}_{part}"] for part in "wxyz"], axis=1)
