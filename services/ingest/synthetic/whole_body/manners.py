"""How the four tasks of Colombel et al. (2020, section 3.3) are done: angles of one repetition, away from standing.

A manner takes a person, a generator for what differs between repetitions, how large it is (1: usual) and its progress
over n frames, and gives (n, 22) deg. All draw the same numbers however they are held or how large they are.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.model import DOF
from services.ingest.synthetic.whole_body.people import Person
from services.ingest.synthetic.whole_body.progress import Progress, bump

Array = NDArray[np.float64]
Manner = Callable[[Person, np.random.Generator, float, Progress], Array]
Legs = Callable[[np.random.Generator, Progress], dict[str, Array]]
"""Angles of pelvis, legs and trunk in a squat, deg by name, at amplitude 1 and with all of the bending in the trunk."""

SQUAT_DEG = {
    "pelvis_tilt": 22.0, "trunk_flexion": 45.0, "hip_flexion": 84.0, "hip_adduction": -6.0, "knee_flexion": 88.0,
}  # fmt: skip
"""Of a squat of amplitude 1, thighs nearly level and shanks 26 deg forward."""


def shaped_squat(rng: np.random.Generator, progress: Progress) -> dict[str, Array]:
    """A smooth squat; the pelvis goes a little ahead of the knees, by a share that differs between repetitions."""
    down = bump(progress.whole, 1.8)
    ahead = bump(progress.whole, 1.8 - 0.3 * rng.uniform())
    found = {name: SQUAT_DEG[name] * ahead for name in ("pelvis_tilt", "trunk_flexion")}
    for side in ("right", "left"):
        for name in ("hip_flexion", "hip_adduction", "knee_flexion"):
            found[f"{name}_{side}"] = SQUAT_DEG[name] * down
    return found


def squat(legs: Legs, who: Person, rng: np.random.Generator, amplitude: float, progress: Progress) -> Array:
    """Arms go up to the sides with the knees."""
    angles = np.zeros((len(progress.whole), len(DOF)))
    for name, moved in legs(rng, progress).items():
        angles[:, DOF[name]] = amplitude * moved * (who.trunk_share if name == "trunk_flexion" else 1.0)
    depth = angles[:, DOF["knee_flexion_right"]]
    depth = np.clip(depth / depth.max(), 0.0, 1.0)
    for side in ("right", "left"):
        raised = np.clip(depth * (1.0 + 0.05 * rng.normal()), 0.0, 1.1)
        angles[:, DOF[f"clavicle_elevation_{side}"]] = (8.0 + 4.0 * rng.normal()) * raised
        angles[:, DOF[f"shoulder_flexion_{side}"]] = 0.15 * who.abduction_deg * raised
        angles[:, DOF[f"shoulder_adduction_{side}"]] = -(who.abduction_deg - 10.0) * raised
        angles[:, DOF[f"shoulder_internal_rotation_{side}"]] = (18.0 + 6.0 * rng.normal()) * raised
        angles[:, DOF[f"elbow_flexion_{side}"]] = (8.0 + 4.0 * rng.normal()) * raised
    return angles


def steps(_who: Person, rng: np.random.Generator, amplitude: float, progress: Progress) -> Array:
    """The right knee up, then the left."""
    angles = np.zeros((len(progress.whole), len(DOF)))
    for side, other, share in (("right", "left", progress.first), ("left", "right", progress.second)):
        lift = bump(share, 1.6)
        angles[:, DOF[f"hip_flexion_{side}"]] += (48.0 + 4.0 * rng.normal()) * amplitude * lift
        angles[:, DOF[f"knee_flexion_{side}"]] += (62.0 + 5.0 * rng.normal()) * amplitude * bump(share, 1.4)
        angles[:, DOF[f"hip_adduction_{side}"]] -= (5.0 + 2.0 * rng.normal()) * lift
        angles[:, DOF[f"hip_internal_rotation_{side}"]] += (6.0 + 5.0 * rng.normal()) * lift
        angles[:, DOF[f"hip_adduction_{other}"]] += 3.0 * lift
    swing = np.sin(2.0 * np.pi * progress.whole) * amplitude
    angles[:, DOF["pelvis_obliquity"]] -= 3.0 * swing
    angles[:, DOF["pelvis_rotation"]] += 4.0 * swing
    angles[:, DOF["pelvis_tilt"]] += 2.0 * np.abs(swing)
    angles[:, DOF["shoulder_flexion_right"]] -= 15.0 * swing
    angles[:, DOF["shoulder_flexion_left"]] += 15.0 * swing
    return angles


def tilt_forward(_who: Person, rng: np.random.Generator, amplitude: float, progress: Progress) -> Array:
    """A bow from hips and trunk."""
    angles, bow, bend = np.zeros((len(progress.whole), len(DOF))), bump(progress.whole, 1.8), 50.0 * amplitude
    angles[:, DOF["pelvis_tilt"]] = 0.6 * bend * bow
    angles[:, DOF["trunk_flexion"]] = 0.4 * bend * bow
    for side in ("right", "left"):
        angles[:, DOF[f"hip_flexion_{side}"]] = (0.6 * bend - 4.0) * bow
        angles[:, DOF[f"knee_flexion_{side}"]] = (4.0 + 2.0 * rng.normal()) * bow
        angles[:, DOF[f"hip_adduction_{side}"]] = (2.0 + 1.5 * rng.normal()) * bow
        angles[:, DOF[f"hip_internal_rotation_{side}"]] = 2.0 * rng.normal() * bow
        angles[:, DOF[f"shoulder_flexion_{side}"]] = 0.75 * bend * bow
    return angles


def tilt_aside(_who: Person, _rng: np.random.Generator, amplitude: float, progress: Progress) -> Array:
    """To the right, then to the left."""
    angles, lean = np.zeros((len(progress.whole), len(DOF))), 16.0 * amplitude
    turn = 2.0 * np.pi * progress.whole
    sway = np.sin(turn) * np.maximum(0.5 - 0.5 * np.cos(turn), 0.0) ** 0.15
    angles[:, DOF["pelvis_obliquity"]] = -lean * sway
    angles[:, DOF["hip_adduction_right"]] = 0.95 * lean * sway
    angles[:, DOF["hip_adduction_left"]] = -0.95 * lean * sway
    angles[:, DOF["trunk_flexion"]] = 7.0 * amplitude * np.abs(sway)
    angles[:, DOF["pelvis_tilt"]] = 3.0 * amplitude * np.abs(sway)
    for side, sign in (("right", -1.0), ("left", 1.0)):
        angles[:, DOF[f"hip_flexion_{side}"]] = 4.0 * amplitude * np.abs(sway)
        angles[:, DOF[f"shoulder_adduction_{side}"]] = sign * 0.3 * lean * sway
    return angles


SQUAT, STEPS, TILT_FORWARD, TILT_ASIDE = 1, 2, 3, 4
"""Tasks, numbered as in the paper."""

MANNERS: dict[int, Manner] = {
    SQUAT: partial(squat, shaped_squat), STEPS: steps, TILT_FORWARD: tilt_forward, TILT_ASIDE: tilt_aside,
}  # fmt: skip
USUAL_S = {SQUAT: 2.6, STEPS: 1.35, TILT_FORWARD: 3.4, TILT_ASIDE: 3.6}
"""s of one repetition by a person of usual tempo."""
TWO_SIDED = (STEPS, TILT_ASIDE)
"""Tasks whose repetition goes to the right first, then to the left."""
