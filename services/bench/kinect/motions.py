"""The four tasks of Colombel et al. (section 3.3), ten repetitions each, as joint angles at 30 Hz.

Squats are the five recorded ones of OpenCap; arms, steps and tilts are shaped. Centres come from a Pinocchio body whose
trunk also bends aside and twists, which no method under test knows of.
"""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.signal import butter, filtfilt

from services.bench.kinect.people import Person
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, WholeBodyModel
from services.biomech.whole_body.pinocchio_whole_body import PinocchioWholeBody
from services.ingest.data import find_data

Array = NDArray[np.float64]

RATE_HZ = 30.0
TASKS = (1, 2, 3, 4)
TASK_NAMES = {1: "squat with arms", 2: "steps", 3: "tilt forward", 4: "tilt aside"}
REPETITIONS = 10
REST_S = 3.0
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


@cache
def _recorded_squats() -> dict[str, Array]:
    lines = (find_data("opencap_joint_angles") / "squats1_videoAndMocap.mot").read_text().splitlines()
    header = lines.index("endheader")
    names = lines[header + 1].split("\t")
    values = np.loadtxt(lines[header + 2 :])
    return dict(zip(names, values.T, strict=True))


SQUAT_COLUMNS = {
    "pelvis_tilt": ("pelvis_tilt", -1.0), "pelvis_obliquity": ("pelvis_list", -1.0),
    "pelvis_rotation": ("pelvis_rotation", 1.0), "hip_flexion_right": ("hip_flexion_r", 1.0),
    "hip_adduction_right": ("hip_adduction_r", 1.0), "hip_internal_rotation_right": ("hip_rotation_r", 1.0),
    "knee_flexion_right": ("knee_angle_r", 1.0), "hip_flexion_left": ("hip_flexion_l", 1.0),
    "hip_adduction_left": ("hip_adduction_l", 1.0), "hip_internal_rotation_left": ("hip_rotation_l", 1.0),
    "knee_flexion_left": ("knee_angle_l", 1.0), "trunk_flexion": ("lumbar_extension", -1.0),
}  # fmt: skip
"""Angle -> column of OpenSim and sign: its tilt and lumbar extension are positive backward, its list to the right."""


def _resampled(values: Array, frames: int) -> Array:
    return np.interp(np.linspace(0.0, len(values) - 1.0, frames), np.arange(len(values)), values)


def _bump(frames: int, power: float) -> Array:
    return np.asarray(np.sin(np.pi * np.linspace(0.0, 1.0, frames)) ** power)


def _squat(who: Person, rng: np.random.Generator, amplitude: float) -> Array:
    frames = _frames(who, rng, 2.6)
    which = rng.integers(0, 5)
    part = slice(SQUAT_EDGES[which], SQUAT_EDGES[which + 1])
    angles = np.zeros((frames, len(DOF)))
    for name, (column, sign) in SQUAT_COLUMNS.items():
        values = _resampled(_recorded_squats()[column][part], frames)
        moved = values - np.linspace(values[0], values[-1], frames)
        angles[:, DOF[name]] = sign * amplitude * moved * (who.trunk_share if name == "trunk_flexion" else 1.0)
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


def _steps(who: Person, rng: np.random.Generator, amplitude: float) -> Array:
    frames = _frames(who, rng, 1.35)
    angles, half = np.zeros((frames, len(DOF))), frames // 2
    for side, other, first in (("right", "left", 0), ("left", "right", half)):
        part, lift = slice(first, first + half), _bump(half, 1.6)
        angles[part, DOF[f"hip_flexion_{side}"]] += (48.0 + 4.0 * rng.normal()) * amplitude * lift
        angles[part, DOF[f"knee_flexion_{side}"]] += (62.0 + 5.0 * rng.normal()) * amplitude * _bump(half, 1.4)
        angles[part, DOF[f"hip_adduction_{side}"]] -= (5.0 + 2.0 * rng.normal()) * lift
        angles[part, DOF[f"hip_internal_rotation_{side}"]] += (6.0 + 5.0 * rng.normal()) * lift
        angles[part, DOF[f"hip_adduction_{other}"]] += 3.0 * lift
    swing = np.sin(np.linspace(0.0, 2.0 * np.pi, frames)) * amplitude
    angles[:, DOF["pelvis_obliquity"]] -= 3.0 * swing
    angles[:, DOF["pelvis_rotation"]] += 4.0 * swing
    angles[:, DOF["pelvis_tilt"]] += 2.0 * np.abs(swing)
    angles[:, DOF["shoulder_flexion_right"]] -= 15.0 * swing
    angles[:, DOF["shoulder_flexion_left"]] += 15.0 * swing
    return angles


def _tilt_forward(who: Person, rng: np.random.Generator, amplitude: float) -> Array:
    frames = _frames(who, rng, 3.4)
    angles, bow, bend = np.zeros((frames, len(DOF))), _bump(frames, 1.8), 50.0 * amplitude
    angles[:, DOF["pelvis_tilt"]] = 0.6 * bend * bow
    angles[:, DOF["trunk_flexion"]] = 0.4 * bend * bow
    for side in ("right", "left"):
        angles[:, DOF[f"hip_flexion_{side}"]] = (0.6 * bend - 4.0) * bow
        angles[:, DOF[f"knee_flexion_{side}"]] = (4.0 + 2.0 * rng.normal()) * bow
        angles[:, DOF[f"hip_adduction_{side}"]] = (2.0 + 1.5 * rng.normal()) * bow
        angles[:, DOF[f"hip_internal_rotation_{side}"]] = 2.0 * rng.normal() * bow
        angles[:, DOF[f"shoulder_flexion_{side}"]] = 0.75 * bend * bow
    return angles


def _tilt_aside(who: Person, rng: np.random.Generator, amplitude: float) -> Array:
    frames = _frames(who, rng, 3.6)
    angles, lean = np.zeros((frames, len(DOF))), 16.0 * amplitude
    sway = np.sin(np.linspace(0.0, 2.0 * np.pi, frames)) * np.hanning(frames) ** 0.15
    angles[:, DOF["pelvis_obliquity"]] = -lean * sway
    angles[:, DOF["hip_adduction_right"]] = 0.95 * lean * sway
    angles[:, DOF["hip_adduction_left"]] = -0.95 * lean * sway
    angles[:, DOF["trunk_flexion"]] = 7.0 * amplitude * np.abs(sway)
    angles[:, DOF["pelvis_tilt"]] = 3.0 * amplitude * np.abs(sway)
    for side, sign in (("right", -1.0), ("left", 1.0)):
        angles[:, DOF[f"hip_flexion_{side}"]] = 4.0 * amplitude * np.abs(sway)
        angles[:, DOF[f"shoulder_adduction_{side}"]] = sign * 0.3 * lean * sway
    return angles


def _frames(who: Person, rng: np.random.Generator, seconds: float) -> int:
    return int(RATE_HZ * seconds * who.tempo * (1.0 + 0.06 * rng.normal()))


def slow_noise(rng: np.random.Generator, frames: int, columns: int, cutoff_hz: float = 0.4) -> Array:
    """(frames, columns) of unit variance below a frequency."""
    edge = 300
    white = rng.normal(size=(frames + 2 * edge, columns))
    low = filtfilt(*butter(2, cutoff_hz / (RATE_HZ / 2.0)), white, axis=0)[edge:-edge]
    return np.asarray(low / low.std(axis=0))


MANNERS = {1: _squat, 2: _steps, 3: _tilt_forward, 4: _tilt_aside}


def angles_of(who: Person, task: int, rng: np.random.Generator) -> Array:
    """(n, 22) rad: a rest of 3 s, then ten repetitions with short pauses, and natural drift throughout."""
    still = np.zeros((1, len(DOF)))
    parts = [np.repeat(still, int(REST_S * RATE_HZ), axis=0)]
    for _ in range(REPETITIONS):
        parts.append(MANNERS[task](who, rng, who.amplitude * (1.0 + 0.05 * rng.normal())))
        pause = 0.1 if task == 2 else rng.uniform(0.2, 0.8)
        parts.append(np.repeat(still, int(RATE_HZ * pause), axis=0))
    angles = who.rest_deg + np.concatenate([*parts, np.repeat(still, int(RATE_HZ), axis=0)])
    angles = uniform_filter1d(angles, 5, axis=0, mode="nearest")
    sway = np.array([0.8 if name.startswith(("pelvis", "hip", "clavicle")) else 1.2 for name in DOF])
    sway[[i for i, name in enumerate(DOF) if "shoulder_internal" in name]] = 2.0
    angles += slow_noise(rng, len(angles), len(DOF)) * sway
    hinges = [i for i, name in enumerate(DOF) if name.startswith(("knee", "elbow"))]
    angles[:, hinges] = np.maximum(angles[:, hinges], 0.3)
    return np.asarray(np.radians(angles))


def trial(who: Person, task: int) -> Trial:
    """A person's trial, always the same. Raises MissingFile without the recorded squats."""
    rng = np.random.default_rng([who.number, task, 7])
    angles = angles_of(who, task, rng)
    n = len(angles)
    bends = np.radians(DRIFT_DEG * slow_noise(rng, n, 2, 0.3))
    body = PinocchioWholeBody(WholeBodyModel(who.trunk_joint), who.lengths, supple=True)
    q = np.concatenate([np.zeros((n, 3)), angles], axis=1)
    frames = [body.supple_frames(*pair) for pair in zip(q, bends, strict=True)]
    centres, carriers = np.array([f[0] for f in frames]), np.array([f[1] for f in frames])
    base = -_feet(centres, task) + np.array([0.0, HEIGHT, 0.0])
    sway = slow_noise(rng, n, 2) * 0.006
    base[:, 0] += sway[:, 0]
    base[:, 2] += sway[:, 1]
    q[:, :3] = base
    return Trial(task, q, centres + base[:, None, :], carriers)


def _feet(centres: Array, task: int) -> Array:
    """(n, 3) the point that stays on its place: the middle of the ankles, in steps the lower one's track."""
    right, left = (centres[:, CENTRE_NAMES.index(name)] for name in ("ankle_right", "ankle_left"))
    if task != 2:
        return np.asarray((right + left) / 2.0)
    higher = np.clip((right[:, 1] - left[:, 1]) / 0.02, -30.0, 30.0)
    share = uniform_filter1d(1.0 / (1.0 + np.exp(higher)), 5)[:, None]
    return np.asarray(share * (right - right[0]) + (1.0 - share) * (left - left[0]) + (right[0] + left[0]) / 2.0)
