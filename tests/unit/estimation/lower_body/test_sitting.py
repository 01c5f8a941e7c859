"""Sitting quietly with sensors on the side of the thighs looks like standing, until the person rises."""

import numpy as np
import pytest
from numpy.typing import NDArray

from schemas.session import Placement
from schemas.signals import CALIBRATION, JOINT_STATE
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import SensorMount
from services.biomech.pinocchio_model import PinocchioBody
from services.biomech.rotations import rotation_about
from services.estimation.lower_body.node import LowerBodyNode
from tests.unit.estimation import estimation_walks as walks

Array = NDArray[np.float64]

SEATED_RAD = 1.5
SITTING_S, RISING_S = 3.0, 1.5
PLACEMENTS = {s: Placement.POSTERIOR if s is Segment.PELVIS else Placement.LATERAL for s in SEGMENTS}


def lateral_mounts() -> list[SensorMount]:
    """The sensors of the walk carried round to the outer side of each leg."""
    turns = {Segment.PELVIS: 0.0}
    mounts = []
    for segment, frame in walks.mounting().items():
        turn = turns.get(segment, -np.pi / 2 if segment.endswith("right") else np.pi / 2)
        mounts.append(SensorMount(segment, rotation_about(np.array([0.0, 1.0, 0.0]), turn) @ frame))
    return mounts


def seated(t: float) -> float:
    """Flexion of hips and knees, rad."""
    ease = min(max((t - SITTING_S) / RISING_S, 0.0), 1.0)
    return SEATED_RAD * (1.0 - ease * ease * ease * (10.0 - 15.0 * ease + 6.0 * ease * ease))


def rising(t: float) -> Array:
    x, step = np.zeros((3, 15)), 1e-3
    value, ahead, behind = seated(t), seated(t + step), seated(t - step)
    derivatives = (value, (ahead - behind) / (2 * step), (ahead - 2 * value + behind) / step**2)
    for i, name in enumerate(walks.NAMES):
        if name.startswith(("hip_flexion", "knee_flexion")):
            x[:, i] = derivatives
    return x


def samples(*, seated_first: bool, then_stands_s: float = 3.0, seconds: float = 16.0) -> Array:
    """(n, 5, 6): sitting, rising and standing, or standing all the time; then a walk."""
    oracle = PinocchioBody(walks.MODEL, lateral_mounts())
    begins = SITTING_S + RISING_S + then_stands_s
    rows = []
    for k in range(round(seconds * walks.RATE_HZ)):
        t = k / walks.RATE_HZ
        x = walks.pose(t - begins + walks.STANDING_S) if t >= begins else rising(t) if seated_first else walks.pose(0.0)
        rows.append([oracle.sample(s, x) for s in range(5)])
    noise = np.random.default_rng(2).normal(size=(len(rows), 5, 6))
    return np.array(rows) + 0.02 * noise


@pytest.mark.parametrize("seated_first", [True, False])
def test_what_was_sitting_is_withdrawn_and_the_standing_after_it_counts(seated_first: bool) -> None:
    description = walks.describe(placements=PLACEMENTS)
    outputs = walks.run(LowerBodyNode(description), walks.messages(description, samples(seated_first=seated_first)))
    said = {pose.message for pose in walks.pictures(outputs)}
    assert ("Sitting, not standing: please stand up straight" in said) == seated_first
    (calibration,) = [output.payload for output in outputs if output.signal is CALIBRATION]
    assert calibration.method == "standing+walking"
    first = next(output for output in outputs if output.signal is JOINT_STATE)
    assert first.payload.captured_ns[0] >= (SITTING_S + RISING_S) * 1e9 or not seated_first
    knee = [value for t, value in sorted(walks.angles(outputs, "knee_flexion_left").items()) if t > 10e9]
    assert -0.2 < min(knee) < 0.3
    assert 0.9 < max(knee) < 1.3


def test_who_rises_and_walks_at_once_is_calibrated_from_the_walk() -> None:
    description = walks.describe(placements=PLACEMENTS)
    walked = samples(seated_first=True, then_stands_s=0.0, seconds=22.0)
    outputs = walks.run(LowerBodyNode(description), walks.messages(description, walked))
    (calibration,) = [output.payload for output in outputs if output.signal is CALIBRATION]
    assert calibration.method == "walking alone"
    knee = [value for t, value in sorted(walks.angles(outputs, "knee_flexion_left").items()) if t > 14e9]
    assert 0.7 < max(knee) - min(knee) < 1.3
