"""Recorded Kinect v2 skeletons as joint centres in our axes, and the optical reference beside one of them."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre
from services.biomech.whole_body.model import CENTRE_NAMES
from services.ingest.data import find_data
from services.ingest.errors import MissingFile
from services.ingest.synthetic.whole_body.camera import Seen

Array = NDArray[np.float64]

KINECT_V2 = {
    JointCentre.SPINE_BASE: 0, JointCentre.SPINE_MID: 1, JointCentre.SPINE_SHOULDER: 20,
    JointCentre.SHOULDER_RIGHT: 8, JointCentre.ELBOW_RIGHT: 9, JointCentre.WRIST_RIGHT: 10,
    JointCentre.SHOULDER_LEFT: 4, JointCentre.ELBOW_LEFT: 5, JointCentre.WRIST_LEFT: 6,
    JointCentre.HIP_RIGHT: 16, JointCentre.KNEE_RIGHT: 17, JointCentre.ANKLE_RIGHT: 18,
    JointCentre.HIP_LEFT: 12, JointCentre.KNEE_LEFT: 13, JointCentre.ANKLE_LEFT: 14,
}  # fmt: skip
"""Place of each centre among the 25 joints of a Kinect v2."""

ORDER = np.array([KINECT_V2[centre] for centre in CENTRE_NAMES])
RATE_HZ = 30.0
OPTICAL_COLUMNS = 7
OPTICAL_CHEST, OPTICAL_HIPS = 4, 13


class Lean(NamedTuple):
    """A seated trunk exercise: what the camera saw, and the optical inclination of the trunk over the same time."""

    name: str
    seen: Seen
    frontal: Array  # (n,) rad to the right, at the camera's frames


def in_our_axes(camera: Array) -> Array:
    """(..., 3) m: x forward, y up, z right of who faces the camera; Kinect v2 has z away from it and x to its left."""
    return np.stack([-camera[..., 2], camera[..., 1], camera[..., 0]], axis=-1)


def kimore(exercise: int) -> Seen:
    """KIMORE: 5 is a squat that starts low, 1 an arm lift. Raises MissingFile without the data."""
    path = find_data("kimore_kinect_v2") / f"JointPositionExercise{exercise}.csv"
    rows = [line.rstrip(", ").split(",") for line in _lines(path)]
    values = np.array([row for row in rows if len(row) == 100], dtype=np.float64).reshape(-1, 25, 4)[:, ORDER]
    return Seen(in_our_axes(values[:, :, :3]), values[:, :, 3].astype(np.int64))


def keraal(exercise: str) -> Lean:
    """KERAAL, CTK or RTK, seated. Both files span the same time. Raises MissingFile without the data."""
    folder = find_data("keraal_kinect_vicon")
    kinect, optical = (
        _numbers(folder / f"G3-{system}-{exercise}-P1T1-Unknown-C-0.txt") for system in ("Kinect", "Vicon")
    )
    centres = in_our_axes(kinect.reshape(len(kinect), 25, 7)[:, ORDER, :3])
    targets = optical.reshape(len(optical), -1, OPTICAL_COLUMNS)[:, :, :3] / 1000.0
    trunk = targets[:, OPTICAL_CHEST] - targets[:, OPTICAL_HIPS]
    # Optical z is up; the sideways axis is that between the thighs' targets, right minus left, levelled.
    right = np.median(targets[:, 5] - targets[:, 6], axis=0) * [1.0, 1.0, 0.0]
    sideways = trunk @ (right / np.linalg.norm(right))
    lean = np.arctan2(sideways, trunk[:, 2])
    at = np.linspace(0.0, len(lean) - 1.0, len(centres))
    return Lean(exercise, Seen(centres, np.full(centres.shape[:2], 2)), np.interp(at, np.arange(len(lean)), lean))


def _numbers(path: Path) -> Array:
    return np.array([line.split() for line in _lines(path)], dtype=np.float64)


def _lines(path: Path) -> list[str]:
    if not path.exists():
        raise MissingFile(f"no file {path.name} in {path.parent}; copy it there or leave this part out")
    return [line for line in path.read_text().splitlines() if line.strip()]
