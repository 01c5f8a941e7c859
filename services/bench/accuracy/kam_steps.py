"""Single walking steps on a treadmill with inertial sensors and markers (KAM data set): samples, and the knee's truth.

Each step runs from 0.2 s before heel strike to 0.2 s after toe-off and stands by itself. Sensors: z out of the skin,
y up. Laboratory: x to the right, y forward, z up; millimetres.
"""

import csv
import gzip
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Segment
from services.ingest.data import find_data

Array = NDArray[np.float64]

FOLDER = "kam_8imu_subject_01"
RATE_HZ = 100.0
NAMES = {Segment.PELVIS: "WAIST", Segment.THIGH_RIGHT: "R_THIGH", Segment.SHANK_RIGHT: "R_SHANK"}


class Step(NamedTuple):
    """One step."""

    samples: Array  # (n, 3, 6) rad/s and m/s^2 in the order of NAMES
    knee_deg: Array  # (n,) flexion between the lines hip-knee and knee-ankle, seen from the right


def read_steps() -> list[Step]:
    """All steps. Raises MissingFile where the data are not there."""
    with gzip.open(find_data(FOLDER) / "steps.csv.gz", "rt") as file:
        table = csv.DictReader(file)
        columns = list(table.fieldnames or [])
        rows = np.array([[float(row[name] or "nan") for name in columns] for row in table])
    channels = dict(zip(columns, rows.T, strict=True))
    return [_step({name: c[channels["step"] == k] for name, c in channels.items()}) for k in np.unique(rows[:, 0])]


def _step(channels: dict[str, Array]) -> Step:
    samples = np.stack([_samples(channels, name) for name in NAMES.values()], axis=1)
    hip, knee, ankle = _hip(channels), _middle(channels, "RFME", "RFLE"), _middle(channels, "RTAM", "RFAL")
    flexion = np.degrees(_inclination(knee - hip) - _inclination(ankle - knee))
    return Step(samples, flexion)


def _samples(channels: dict[str, Array], sensor: str) -> Array:
    rate = np.stack([np.radians(channels[f"Gyro{axis}_{sensor}"]) for axis in "XYZ"], axis=1)
    force = np.stack([channels[f"Accel{axis}_{sensor}"] for axis in "XYZ"], axis=1)
    return np.hstack([rate, force])


def _point(channels: dict[str, Array], marker: str) -> Array:
    return np.stack([channels[f"{marker}_{axis}"] for axis in "XYZ"], axis=1)


def _middle(channels: dict[str, Array], first: str, second: str) -> Array:
    return 0.5 * (_point(channels, first) + _point(channels, second))


def _hip(channels: dict[str, Array]) -> Array:
    """Right hip centre from the pelvis markers after Bell et al. 1990: 14 % of the distance between the front spines
    medially, 19 % back and 30 % down from the right one."""
    right, left = _point(channels, "RIAS"), _point(channels, "LIAS")
    width = np.linalg.norm(right - left, axis=1)[:, None]
    across = (right - left) / width
    forward = 0.5 * (right + left) - _middle(channels, "RIPS", "LIPS")
    forward -= np.sum(forward * across, axis=1)[:, None] * across
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    up = np.cross(across, forward)
    return np.asarray(right - width * (0.14 * across + 0.19 * forward + 0.30 * up))


def _inclination(line: Array) -> Array:
    """Rad, of a line that points down; positive with its lower end forward."""
    return np.asarray(np.arctan2(line[:, 1], -line[:, 2]))
