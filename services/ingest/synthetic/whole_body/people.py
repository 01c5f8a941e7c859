"""People who do the simulated tasks: size, standing posture and manner, drawn by seed."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import WHOLE_BODY
from services.biomech.whole_body.directions import TRUNK_JOINT
from services.biomech.whole_body.model import DOF, PARTNERS
from services.biomech.whole_body.parameters import REST_DEG, lengths_of, unsided

Array = NDArray[np.float64]

TUNING_PERSON = 0
TEST_PEOPLE = tuple(range(1, 8))

SPREAD_DEG = {
    "pelvis_rotation": 2.0, "pelvis_tilt": 4.0, "pelvis_obliquity": 1.5, "hip_flexion": 4.0, "hip_adduction": 2.5,
    "hip_internal_rotation": 6.0, "knee_flexion": 2.5, "trunk_flexion": 4.0, "clavicle_elevation": 3.0,
    "shoulder_flexion": 6.0, "shoulder_adduction": 3.0, "shoulder_internal_rotation": 10.0, "elbow_flexion": 5.0,
}  # fmt: skip
"""Of the standing posture among people. Less than the filter presumes."""

LEGS_DIFFER_DEG = {"hip_flexion": 1.5, "hip_adduction": 1.5, "hip_internal_rotation": 4.0, "knee_flexion": 1.5}
"""Of the left leg from the right one."""


@dataclass(frozen=True)
class Person:
    """One person."""

    number: int
    stature: float  # m
    lengths: Array  # (12,) m
    rest_deg: Array  # (22,)
    amplitude: float
    tempo: float  # duration of a repetition / nominal
    trunk_share: float  # of the bending that the trunk does
    abduction_deg: float  # of the arms in a squat; below 90, where the shoulder's angles lock
    trunk_joint: float


def person(number: int) -> Person:
    """Person by number: 0 tunes, others are scored."""
    generator = np.random.default_rng([number, 2020])
    stature = float(np.clip(generator.normal(1.74, 0.08), 1.55, 1.92))
    deviation = generator.normal(0.0, 0.04, 12)
    for right, left in PARTNERS:
        deviation[left] = deviation[right]
    lengths = lengths_of(stature) * (1.0 + deviation) * (1.0 + generator.normal(0.0, 0.005, 12))
    return Person(
        number, stature, lengths, _rest(generator), generator.uniform(0.75, 1.1), generator.uniform(0.8, 1.35),
        generator.uniform(0.25, 0.65), generator.uniform(60.0, 80.0), TRUNK_JOINT + 0.02 * generator.normal(),
    )  # fmt: skip


def _rest(generator: np.random.Generator) -> Array:
    rest = np.zeros(len(WHOLE_BODY))
    for i, dof in enumerate(WHOLE_BODY):
        name = unsided(dof.name)
        rest[i] = REST_DEG[name][0] + SPREAD_DEG[name] * generator.normal()
    for name, spread in LEGS_DIFFER_DEG.items():
        rest[DOF[f"{name}_left"]] = rest[DOF[f"{name}_right"]] + spread * generator.normal()
    for name in ("knee_flexion", "elbow_flexion"):
        for side in ("right", "left"):
            rest[DOF[f"{name}_{side}"]] = abs(rest[DOF[f"{name}_{side}"]])
    return rest
