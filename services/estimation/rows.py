"""What every estimator puts out for one instant: joint coordinates with their deviations, and the rhythm."""

from collections.abc import Iterable
from typing import NamedTuple

from schemas.vocabulary import BODY_MODELS, LOWER_BODY
from services.biomech.rhythm.reading import RhythmReading

MODEL = "lower_body"
"""Name of the body model in BODY_MODELS whose coordinates rows have, unless another is named."""

INDEX = {dof.name: i for i, dof in enumerate(LOWER_BODY)}
"""Place of each coordinate in a row, by name."""

RHYTHM_CHANNELS = ("knee_flexion_right", "knee_flexion_left", "hip_flexion_right", "hip_flexion_left")
"""Joints whose velocity the rhythm listens to. They share the stride; the pelvis has the step in it."""


class Row(NamedTuple):
    """Estimates at one instant, in the order of the body model, and the rhythm."""

    captured_ns: int
    position: list[float]  # (n,) rad
    velocity: list[float]  # (n,) rad/s
    acceleration: list[float]  # (n,) rad/s^2
    position_std: list[float]  # (n,) rad
    velocity_std: list[float]  # (n,) rad/s
    rhythm: RhythmReading


def places(model: str, names: Iterable[str]) -> list[int]:
    """Of coordinates, by name, in the rows of a body model."""
    order = [dof.name for dof in BODY_MODELS[model]]
    return [order.index(name) for name in names]
