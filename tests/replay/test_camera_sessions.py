"""Recordings of a depth camera through the node: limits, jumps, lengths, lean, who stands and who does not."""

import json
from functools import cache

import numpy as np
import pytest

from schemas.kinematics import Calibration, JointCentres, JointState, LivePose
from schemas.signals import SKELETON
from schemas.vocabulary import BODY_MODELS
from services.bench.kinect.recordings import keraal
from services.biomech.whole_body.observability import trunk_lean
from services.biomech.whole_body.parameters import LIMITS_DEG, per_angle
from services.estimation.node import build
from services.ingest.errors import MissingFile
from services.ingest.source import iter_messages, open_source

NAMES = [dof.name for dof in BODY_MODELS["whole_body"]]
KNEES = [NAMES.index(f"knee_flexion_{side}") for side in ("right", "left")]
FRAMES = {"kimore_squat": 517, "kimore_arm_lift": 505, "keraal_torso_rotation": 193, "keraal_hiding_face": 197}


@cache
def recorded(name: str):
    try:
        source = open_source(name, estimator="body_cekf")
        messages = [m for m in iter_messages(source) if m.stream.signal is SKELETON and m.payload is not None]
    except MissingFile as missing:
        pytest.skip(str(missing))
    return source.describe(), messages


@cache
def outputs(name: str):
    description, messages = recorded(name)
    node = build(description)
    found = [output for message in messages for output in node.step(message)] + node.finish()
    assert node.rejections() == []
    return found


def payloads(name: str, model: type) -> list:
    return [output.payload for output in outputs(name) if isinstance(output.payload, model)]


def rows(name: str, quantity: str = "position") -> tuple[np.ndarray, np.ndarray]:
    """The quantity (n, 24) and validity (n, 24)."""
    states = payloads(name, JointState)
    values = np.concatenate([getattr(state, quantity) for state in states])
    return values, np.concatenate([[state.valid] * len(state.captured_ns) for state in states])


def datum(name: str) -> list[bool]:
    flags = [calibration.absolute for calibration in payloads(name, Calibration)]
    return [flag for i, flag in enumerate(flags) if i == 0 or flag != flags[i - 1]]


@pytest.mark.parametrize("name", FRAMES)
def test_every_frame_has_a_row_within_the_limits_and_finite(name):
    low, high = per_angle(LIMITS_DEG).T
    angles, _ = rows(name)
    assert len(angles) == FRAMES[name]
    assert (angles[:, 1:22] >= low[1:]).all()
    assert (angles[:, 1:22] <= high[1:]).all()
    for quantity in ("velocity", "acceleration", "position_std", "velocity_std"):
        assert np.isfinite(rows(name, quantity)[0]).all()


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("kimore_squat", [False]),
        # The arms are up at first, and hang for more than a second after 2 s.
        ("kimore_arm_lift", [False, True]),
        ("keraal_torso_rotation", [False]),
        ("keraal_hiding_face", [False]),
    ],
)
def test_only_who_stands_still_has_absolute_angles(name, expected):
    assert datum(name) == expected
    last = payloads(name, LivePose)[-1]
    assert ("not absolute" in last.message) != expected[-1]


def test_a_squat_that_starts_low_has_next_to_no_jumps():
    """Of the raw centres 86 frames have one."""
    angles, valid = rows("kimore_squat")
    steps = np.abs(np.diff(np.degrees(angles[:, KNEES]), axis=0))
    assert (steps > 20.0).any(axis=1).sum() <= 9
    assert valid[:, KNEES].mean() > 0.7


def test_lengths_are_held_after_five_seconds():
    first, held = payloads("kimore_squat", Calibration)
    assert held.lengths != first.lengths
    bones = {"thigh_right": ("hip_right", "knee_right"), "shank_left": ("knee_left", "ankle_left")}
    centres = np.concatenate([each.position for each in payloads("kimore_squat", JointCentres)])[160:]
    places = {"hip_right": 9, "knee_right": 10, "knee_left": 13, "ankle_left": 14}
    for name, (upper, lower) in bones.items():
        length = np.linalg.norm(centres[:, places[upper]] - centres[:, places[lower]], axis=1)
        assert length == pytest.approx(np.full(len(length), held.lengths[name]), rel=1e-3)


def test_the_lean_of_a_seated_trunk_agrees_with_the_optical_one():
    frontal = keraal().frontal if recorded("keraal_torso_rotation") else None
    centres = np.concatenate([each.position for each in payloads("keraal_torso_rotation", JointCentres)])
    lean = trunk_lean(centres)[:, 1]
    assert np.corrcoef(lean, frontal)[0, 1] > 0.75
    assert np.degrees(np.sqrt(np.mean((lean - frontal) ** 2))) < 5.5


def test_split_and_resume_is_identical():
    description, messages = recorded("kimore_arm_lift")
    first, second = build(description), build(description)
    found = [output for message in messages[:230] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    found += [output for message in messages[230:] for output in second.step(message)] + second.finish()
    assert found == outputs("kimore_arm_lift")
