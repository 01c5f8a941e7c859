"""Coordinates as .mot (degrees) and .sto (radians): the tables that OpenSim calls Storage."""

from collections.abc import Iterator

import numpy as np

from services.exports.facts import Facts
from services.exports.opensim.coordinates import Coordinates
from services.exports.opensim.models import OpenSimModel
from services.exports.parameters import ROWS_AT_A_TIME
from services.exports.text_rows import rows_of_numbers


def storage_file(facts: Facts, model: OpenSimModel, coordinates: Coordinates, *, in_degrees: bool) -> Iterator[bytes]:
    """The file in parts. Time is session time, s; rows are the samples themselves, at their own times."""
    head = [
        "Coordinates",
        "version=1",
        f"nRows={coordinates.times_ns.size}",
        f"nColumns={len(coordinates.names) + 1}",
        f"inDegrees={'yes' if in_degrees else 'no'}",
        *(line.replace("=", " ") for line in _about(facts, model, coordinates)),
        "endheader",
        "\t".join(["time", *coordinates.names]),
    ]
    yield ("\n".join(head) + "\n").encode("utf-8")
    scale = 180.0 / np.pi if in_degrees else 1.0
    for first in range(0, coordinates.times_ns.size, ROWS_AT_A_TIME):
        some = slice(first, first + ROWS_AT_A_TIME)
        seconds = coordinates.times_ns[some, None] * 1e-9
        yield rows_of_numbers(np.concatenate([seconds, coordinates.values[some] * scale], axis=1))


def _about(facts: Facts, model: OpenSimModel, coordinates: Coordinates) -> list[str]:
    """OpenSim keeps free lines of a header as they are, unless they hold an equals sign."""
    signs = [f"{each.name} {'-' if each.sign < 0 else ''}{each.freedom}" for each in model.coordinates]
    left_out = ", ".join(coordinates.without) or "none"
    return [
        *facts.lines(),
        f"model: {model.name}; signs by its ranges: {'; '.join(signs)}",
        "pelvis: tilt positive backward, list positive right side down, rotation positive to the left",
        "position of the pelvis: not in this file; joint centres are in the .trc file",
        f"not told: {left_out}; rows left out because an angle was not valid: {coordinates.rows_left_out}",
    ]
