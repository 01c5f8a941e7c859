"""What every estimator puts out for one instant: joint coordinates with their deviations, and the rhythm."""

from typing import NamedTuple

from schemas.vocabulary import LOWER_BODY
from services.biomech.rhythm.reading import RhythmReading

MODEL = "lower_body"
"""Name of the body model in BODY_MODELS: rows have its coordinates, whoever estimates them."""

INDEX = {dof.name: i for i, dof in enumerate(LOWER_BODY)}
"""Place of each coordinate in a row, by name."""

RHYTHM_CHANNELS = ("knee_flexion_right", "knee_flexion_left", "hip_flexion_right", "hip_flexion_left")
"""Joints whose velocity the rhythm listens to. They share the stride; the pelvis has the step in it."""


class Row(NamedTuple):
    """Estimates at one instant, in the order of LOWER_BODY, and the rhythm."""

    captured_ns: int
    position: list[float]  # (15,) rad
    velocity: list[float]  # (15,) rad/s
    acceleration: list[float]  # (15,) rad/s^2
    position_std: list[float]  # (15,) rad
    velocity_std: list[float]  # (15,) rad/s
    rhythm: RhythmReading
