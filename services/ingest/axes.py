"""Vendor axes to Ambula's: rotations written as signed axis letters or as rows of a matrix."""

import numpy as np
from numpy.typing import NDArray

from services.ingest.errors import InvalidManifest

Axes = list[str] | list[list[float]]

ORTHONORMAL_TOLERANCE = 1e-6

_LETTERS = {"x": 0, "y": 1, "z": 2}


def rotation_from_axes(axes: Axes | None, where: str) -> NDArray[np.float64]:
    """R_ours_from_vendor, 3 x 3: `["x", "z", "-y"]` says ours x, y, z are the vendor's x, z and minus y.

    Raises InvalidManifest when it is no right-handed rotation.
    """
    if axes is None:
        return np.eye(3)
    rows = [_row(entry, where) for entry in axes]
    R_ours_from_vendor = np.array(rows, dtype=np.float64)
    if R_ours_from_vendor.shape != (3, 3):
        raise InvalidManifest(f'{where}: axes need three entries, such as ["x", "z", "-y"]')
    error = np.abs(R_ours_from_vendor @ R_ours_from_vendor.T - np.eye(3)).max()
    if not error < ORTHONORMAL_TOLERANCE or np.linalg.det(R_ours_from_vendor) < 0:
        raise InvalidManifest(f"{where}: axes {axes} are no right-handed rotation; check the signs")
    return R_ours_from_vendor


def _row(entry: str | list[float], where: str) -> list[float]:
    if isinstance(entry, list):
        if len(entry) != 3:
            raise InvalidManifest(f"{where}: a row of axes has three numbers, not {len(entry)}")
        return entry
    letter = entry.lstrip("+-")
    if letter not in _LETTERS or len(entry) - len(letter) > 1:
        raise InvalidManifest(f"{where}: {entry!r} is no axis; write x, y, z, -x, -y or -z")
    row = [0.0, 0.0, 0.0]
    row[_LETTERS[letter]] = -1.0 if entry.startswith("-") else 1.0
    return row
