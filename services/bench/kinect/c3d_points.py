"""Points of a C3D file: the part of the format that optical laboratories use (https://www.c3d.org/docs/C3D_User_Guide.pdf).

Little-endian files (Intel) whose points are floating-point numbers; others are refused.
"""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

BLOCK = 512
INTEL = 84
_POINT_LABELS = ("LABELS", *(f"LABELS{k}" for k in range(2, 10)))


class Points(NamedTuple):
    """All points of a file over time."""

    rate_hz: float
    names: tuple[str, ...]
    values: NDArray[np.float64]  # (frames, points, 3) in the file's units; NaN where invalid

    def of(self, name: str) -> NDArray[np.float64]:
        """(frames, 3) of the point whose label is, or ends with, that name. Raises KeyError if there is none."""
        for k, label in enumerate(self.names):
            if label == name or label.endswith(f":{name}"):
                return self.values[:, k]
        raise KeyError(name)


def read_points(path: Path) -> Points:
    """Raises ValueError for a file that is no C3D of that kind."""
    data = path.read_bytes()
    if len(data) < BLOCK or data[1] != 0x50:
        raise ValueError(f"{path.name}: no C3D file")
    first_block = data[0]
    if data[(first_block - 1) * BLOCK + 3] != INTEL:
        raise ValueError(f"{path.name}: written by a processor whose numbers are not read here")
    points, analogs, first, last = struct.unpack_from("<HHHH", data, 2)
    (scale,) = struct.unpack_from("<f", data, 12)
    (data_block,) = struct.unpack_from("<H", data, 16)
    (rate_hz,) = struct.unpack_from("<f", data, 20)
    if scale >= 0.0:
        raise ValueError(f"{path.name}: points are whole numbers; only floating-point ones are read here")
    groups = _parameters(data, (first_block - 1) * BLOCK)
    labels = [name for key in _POINT_LABELS for name in groups.get(("POINT", key), [])]
    width = 4 * points + analogs
    start, frames = (data_block - 1) * BLOCK, last - first + 1
    frames = min(frames, (len(data) - start) // (4 * width))
    table = np.frombuffer(data, "<f4", frames * width, start).reshape(frames, width)[:, : 4 * points]
    table = table.reshape(frames, points, 4).astype(np.float64)
    values = np.where(table[:, :, 3:] < 0.0, np.nan, table[:, :, :3])
    return Points(float(rate_hz), tuple(labels[:points]), values)


def _parameters(data: bytes, start: int) -> dict[tuple[str, str], list[str]]:
    """Lists of words by group and name."""
    names: dict[int, str] = {}
    found: list[tuple[int, str, list[str]]] = []
    for group, name, body in _records(data, start + 4):
        if group < 0:
            names[-group] = name
        elif body[0] == 0xFF:
            found.append((group, name, _words(body)))
    return {(names.get(group, ""), name): words for group, name, words in found}


def _records(data: bytes, at: int) -> Iterator[tuple[int, str, bytes]]:
    """Group number (negative for the group itself), name and the rest of each record."""
    while at + 2 < len(data) and data[at] != 0:
        length, group = (struct.unpack_from("<b", data, at + k)[0] for k in (0, 1))
        name_end = at + 2 + abs(length)
        (offset,) = struct.unpack_from("<h", data, name_end)
        # The last record points to none behind it.
        end = name_end + offset if offset else len(data)
        yield group, data[at + 2 : name_end].decode("latin-1"), data[name_end + 2 : end]
        if offset == 0:
            return
        at = end


def _words(body: bytes) -> list[str]:
    dimensions = list(body[2 : 2 + body[1]])
    text = body[2 + body[1] :]
    width = dimensions[0] if dimensions else 1
    count = int(np.prod(dimensions[1:])) if len(dimensions) > 1 else 1
    return [text[k * width : (k + 1) * width].decode("latin-1").strip() for k in range(count)]
