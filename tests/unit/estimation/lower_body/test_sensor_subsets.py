"""Any subset of the sensors: what is observed is right and valid, what is not says so."""

import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from schemas.vocabulary import Segment
from services.estimation.lower_body.node import LowerBodyNode

sys.path.insert(0, str(Path(__file__).parent))
from tests.unit.estimation import estimation_walks as walks

SHANKS = (Segment.SHANK_RIGHT, Segment.SHANK_LEFT)
LEFT_LEG = (Segment.THIGH_LEFT, Segment.SHANK_LEFT)


@cache
def run(*segments: Segment):
    description = walks.describe(hubs=(segments,))
    return tuple(walks.run(LowerBodyNode(description), walks.messages(description, walks.walk(12.0)[1])))


def error_deg(outputs, *names: str):
    """Mean and standard deviation of the error of the sum of some angles, from 3.5 s on."""
    truth = np.sum([walks.walk(12.0)[0][:, walks.NAMES.index(name)] for name in names], axis=0)
    angles = [walks.angles(outputs, name) for name in names]
    error = np.degrees([sum(a[k * 10_000_000] for a in angles) - truth[k] for k in range(350, 1200)])
    return np.mean(error), np.std(error)


def test_one_leg_has_a_valid_knee_and_no_hip() -> None:
    last = walks.joint_states(run(*LEFT_LEG))[-1]
    valid = {name for name, is_valid in zip(walks.NAMES, last.valid, strict=True) if is_valid}
    assert valid == {"knee_flexion_left", "knee_adduction_left", "knee_internal_rotation_left"}
    assert last.observed == list(LEFT_LEG)
    mean, spread = error_deg(run(*LEFT_LEG), "knee_flexion_left")
    assert abs(mean) < 4.0
    assert spread < 4.0


@pytest.mark.parametrize("side", ["left", "right"])
def test_shanks_alone_have_no_valid_joint_but_their_tilt(side: str) -> None:
    last = walks.joint_states(run(*SHANKS))[-1]
    assert not any(last.valid)
    assert last.observed == list(SHANKS)
    # Flexions about parallel axes: the shank's inclination is their alternating sum.
    description = ("pelvis_tilt", f"hip_flexion_{side}")
    estimate = walks.joint_states(run(*SHANKS))
    assert estimate
    table = np.array([row for state in estimate for row in state.position])
    times = [t for state in estimate for t in state.captured_ns]
    truth = walks.walk(12.0)[0]

    def inclination(rows):
        proximal = np.sum([rows[:, walks.NAMES.index(name)] for name in description], axis=0)
        return proximal - rows[:, walks.NAMES.index(f"knee_flexion_{side}")]

    use = np.array(times) >= 3_500_000_000
    frames = np.array(times)[use] // 10_000_000
    error = np.degrees(inclination(table[use]) - inclination(truth[frames]))
    assert np.std(error) < 4.0
    assert abs(np.mean(error)) < 4.0


def test_nothing_is_invented_for_what_nobody_wears() -> None:
    last = walks.joint_states(run(*SHANKS))[-1]
    unseen = [i for i, name in enumerate(walks.NAMES) if name.startswith("hip")]
    assert np.abs(np.array(last.position)[:, unseen]).max() < 0.5
    assert np.isfinite(last.position).all()
    assert np.isfinite(last.position_std).all()
