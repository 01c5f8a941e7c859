"""The four tasks of Colombel et al. (section 3.3), ten repetitions each, as joint angles at 30 Hz.

Squats are the five recorded ones of OpenCap; arms, steps and tilts are shaped. Centres come from a Pinocchio body whose
trunk also bends aside and twists, which no method under test knows of.
"""

from functools import cache, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.model import WholeBodyModel
from services.biomech.whole_body.pinocchio_whole_body import PinocchioWholeBody
from services.ingest.data import find_data
from services.ingest.synthetic.whole_body.body import foothold
from services.ingest.synthetic.whole_body.manners import MANNERS, SQUAT, STEPS, Manner, squat
from services.ingest.synthetic.whole_body.people import Person
from services.ingest.synthetic.whole_body.programme import perform, slow_noise
from services.ingest.synthetic.whole_body.progress import Progress

Array = NDArray[np.float64]

TASKS = (1, 2, 3, 4)
TASK_NAMES = {1: "squat with arms", 2: "steps", 3: "tilt forward", 4: "tilt aside"}
SQUAT_EDGES = (10, 163, 308, 467, 627, 800)
"""Frames at which the recorded squats begin and end."""
DRIFT_DEG = 2.0
"""Of what the trunk does unknown to the model."""
HEIGHT = -0.8
"""m, ankles below the camera."""


class Trial(NamedTuple):
    """One person doing one task, without a camera."""

    task: int
    q: Array  # (n, 25) m and rad
    centres: Array  # (n, 15, 3) m
    carriers: Array  # (n, 15, 3, 3) R_world_from_segment of what carries each centre
    repetition: Array  # (n,) number from 1, 0 in none


@cache
def opencap(recording: str) -> dict[str, Array]:
    """Columns of `squats1` or `walking1`, deg at 100 Hz. Raises MissingFile."""
    lines = (find_data("opencap_joint_angles") / f"{recording}_videoAndMocap.mot").read_text().splitlines()
    header = lines.index("endheader")
    names = lines[header + 1].split("\t")
    values = np.loadtxt(lines[header + 2 :])
    return dict(zip(names, values.T, strict=True))


OPENSIM_COLUMNS = {
    "pelvis_tilt": ("pelvis_tilt", -1.0), "pelvis_obliquity": ("pelvis_list", -1.0),
    "pelvis_rotation": ("pelvis_rotation", 1.0), "hip_flexion_right": ("hip_flexion_r", 1.0),
    "hip_adduction_right": ("hip_adduction_r", 1.0), "hip_internal_rotation_right": ("hip_rotation_r", 1.0),
    "knee_flexion_right": ("knee_angle_r", 1.0), "hip_flexion_left": ("hip_flexion_l", 1.0),
    "hip_adduction_left": ("hip_adduction_l", 1.0), "hip_internal_rotation_left": ("hip_rotation_l", 1.0),
    "knee_flexion_left": ("knee_angle_l", 1.0), "trunk_flexion": ("lumbar_extension", -1.0),
}  # fmt: skip
"""Angle -> column of OpenSim and sign: its tilt and lumbar extension are positive backward, its list to the right."""


def recorded_squat(rng: np.random.Generator, progress: Progress) -> dict[str, Array]:
    """One of the five, its ends brought to zero. Raises MissingFile without the recording."""
    frames, which = len(progress.whole), rng.integers(0, 5)
    part = slice(SQUAT_EDGES[which], SQUAT_EDGES[which + 1])
    found = {}
    for name, (column, sign) in OPENSIM_COLUMNS.items():
        values = _resampled(opencap("squats1")[column][part], frames)
        found[name] = sign * (values - np.linspace(values[0], values[-1], frames))
    return found


def _resampled(values: Array, frames: int) -> Array:
    return np.interp(np.linspace(0.0, len(values) - 1.0, frames), np.arange(len(values)), values)


RECORDED: dict[int, Manner] = {**MANNERS, SQUAT: partial(squat, recorded_squat)}
"""Manners of the tasks, squats as recorded."""


def trial(who: Person, task: int) -> Trial:
    """A person's trial, always the same. Raises MissingFile without the recorded squats."""
    rng = np.random.default_rng([who.number, task, 7])
    angles, repetition, _ = perform(who, task, rng, manners=RECORDED)
    return placed_trial(who, task, (angles, repetition), rng, lowest=task == STEPS)


def placed_trial(who: Person, task: int, done: tuple[Array, Array], rng: np.random.Generator, *, lowest: bool) -> Trial:
    """Angles (n, 22) rad on the person's body, with the repetition (n,) of each instant; `lowest` as in foothold."""
    angles, repetition = done
    n = len(angles)
    bends = np.radians(DRIFT_DEG * slow_noise(rng, n, 2, 0.3))
    body = PinocchioWholeBody(WholeBodyModel(who.trunk_joint), who.lengths, supple=True)
    q = np.concatenate([np.zeros((n, 3)), angles], axis=1)
    frames = [body.supple_frames(*pair) for pair in zip(q, bends, strict=True)]
    centres, carriers = np.array([f[0] for f in frames]), np.array([f[1] for f in frames])
    base = -foothold(centres, lowest=lowest) + np.array([0.0, HEIGHT, 0.0])
    sway = slow_noise(rng, n, 2) * 0.006
    base[:, 0] += sway[:, 0]
    base[:, 2] += sway[:, 1]
    q[:, :3] = base
    return Trial(task, q, centres + base[:, None, :], carriers, repetition)
