"""Two optical strides of one healthy walker as Fourier shapes: the ground of the synthetic gait."""

import csv
import gzip
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.ingest.data import find_data

RECORDING = "neura_s02_walk"
HARMONICS = 10
LEFT_STRIDES = ((1228, 1373), (1660, 1798))
"""Frames of left initial contacts (`step_detect.csv`): the strides there and back that are clear of start and turn."""
PHASES = 200


@dataclass(frozen=True)
class StrideShapes:
    """Angles of knee left, knee right, thigh pitch left, thigh pitch right over a stride."""

    coefficients: NDArray[np.complex128]
    """rad, shape (2 strides, 4 joints, 1 + 10): angle(x) = Re sum_k c_k exp(2 pi i k x), x = 0..1."""


def load_stride_shapes() -> StrideShapes:
    """Read the strides.

    Raises:
        MissingFile: the recording is not on this machine; says where it was looked for.
    """
    path = find_data(RECORDING) / "vicon.csv.gz"
    with gzip.open(path, "rt") as file:
        rows = csv.reader(file)
        columns = {name: i for i, name in enumerate(next(rows))}
        table = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows])
    return StrideShapes(np.stack([_shape(table[start : end + 1], columns) for start, end in LEFT_STRIDES]))


def _shape(stride: NDArray[np.float64], columns: dict[str, int]) -> NDArray[np.complex128]:
    """Coefficients (4, 1 + HARMONICS) of one stride: resampled to phase, closed linearly."""
    angles = np.stack(
        [np.radians(stride[:, columns[f"knee_angle_{side}_deg"]]) for side in "lr"]
        + [_thigh_pitch(stride, columns, side) for side in "LR"]
    )
    share = np.linspace(0.0, 1.0, stride.shape[0])
    phase = np.arange(PHASES) / PHASES
    closed = angles - share * (angles[:, -1:] - angles[:, :1])
    even = np.stack([np.interp(phase, share, angle) for angle in closed])
    spectrum = np.fft.rfft(even, axis=1)[:, : HARMONICS + 1] / PHASES
    spectrum[:, 1:] *= 2.0
    return np.asarray(spectrum)


def _thigh_pitch(stride: NDArray[np.float64], columns: dict[str, int], side: str) -> NDArray[np.float64]:
    """Forward lean of the thigh in the plane of walking, rad: knee ahead of hip is positive."""

    def point(name: str) -> NDArray[np.float64]:
        return stride[:, [columns[f"{side}{name}_{axis}_mm"] for axis in "xyz"]]

    hip, knee = point("HJC"), point("KJC")
    way = hip[-1, :2] - hip[0, :2]
    thigh = knee - hip
    ahead = thigh[:, :2] @ (way / np.linalg.norm(way))
    return np.arctan2(ahead, -thigh[:, 2])
