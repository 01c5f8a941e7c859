"""Groups of parameters of a C3D file, as bytes (c3d.org user guide, section "The Parameter Section").

Little-endian ("Intel") floats throughout. A text parameter is a list of strings of equal length.
"""

import struct
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.exports.errors import ExportError

BLOCK = 512
INTEL = 84
_MOST_BLOCKS = 255
_MOST_LENGTH = 255
"""A dimension is one byte."""
_MOST_BYTES = 32_000
"""The way to the next parameter is a signed word."""

Value = int | float | str | Sequence[str] | NDArray[np.float32] | NDArray[np.int16]


class Parameter(NamedTuple):
    """One named value. Arrays are in C3D's order: the first dimension runs fastest."""

    name: str
    value: Value
    description: str = ""
    shape: tuple[int, ...] | None = None
    """Of a list of texts; None: as long as it is."""


class Group(NamedTuple):
    """Parameters that belong together."""

    name: str
    parameters: Sequence[Parameter]
    description: str = ""


def encode_groups(groups: Sequence[Group]) -> bytes:
    """The whole section, padded to blocks. Raises ExportError when it does not fit."""
    body = bytearray()
    for number, group in enumerate(groups, 1):
        body += _record(group.name, -number, b"", group.description)
        for parameter in group.parameters:
            body += _record(parameter.name, number, encode_value(parameter), parameter.description)
    body += b"\x00\x00"
    blocks = -(-(len(body) + 4) // BLOCK)
    if blocks > _MOST_BLOCKS:
        raise ExportError("c3d.parameters", f"{blocks} blocks, more than {_MOST_BLOCKS}", "export the CSV tables")
    return (bytes([1, 80, blocks, INTEL]) + body).ljust(blocks * BLOCK, b"\x00")


def encode_value(parameter: Parameter) -> bytes:
    """Type, dimensions and data. Raises ExportError for more than 255 entries along a dimension."""
    value = parameter.value
    if isinstance(value, int):
        return struct.pack("<bBh", 2, 0, value)
    if isinstance(value, float):
        return struct.pack("<bBf", 4, 0, value)
    if isinstance(value, np.ndarray):
        kind = 4 if value.dtype == np.float32 else 2
        return _dimensions(parameter.name, kind, value.shape) + value.tobytes(order="F")
    if isinstance(value, str):
        text = _ascii(value)[:_MOST_LENGTH]
        return _dimensions(parameter.name, -1, (len(text),)) + text
    texts = [_ascii(text)[:_MOST_LENGTH] for text in value]
    width = max((len(text) for text in texts), default=0)
    shape = parameter.shape or (len(texts),)
    return _dimensions(parameter.name, -1, (width, *shape)) + b"".join(text.ljust(width) for text in texts)


def _record(name: str, number: int, value: bytes, description: str) -> bytes:
    text = _ascii(description)[:_MOST_LENGTH]
    after = value + bytes([len(text)]) + text
    if len(after) > _MOST_BYTES:
        raise ExportError(f"c3d.{name}", f"{len(after)} bytes, more than {_MOST_BYTES}", "export the CSV tables")
    return struct.pack("<bb", len(name), number) + name.encode("ascii") + struct.pack("<h", len(after) + 2) + after


def _dimensions(name: str, kind: int, shape: Sequence[int]) -> bytes:
    if max(shape, default=0) > _MOST_LENGTH:
        raise ExportError(f"c3d.{name}", f"{max(shape)} entries, more than {_MOST_LENGTH}", "export the CSV tables")
    return struct.pack("<bB", kind, len(shape)) + bytes(shape)


def _ascii(text: str) -> bytes:
    return text.encode("ascii", "replace")
