"""Bones in plain numbers: those of the rigid-body library, posture by posture."""

import numpy as np
import pytest

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY, WHOLE_BODY, Segment
from services.biomech.bones import SEGMENTS, ankle, bones, rotated
from services.biomech.figure import Pace, lower_body_of, segment_pictures
from services.biomech.lower_body import LowerBodyModel
from services.biomech.pinocchio_model import PinocchioBody
from services.biomech.rotations import matrix_from_quaternion

BODY = Anthropometry(
    height_m=1.75, mass_kg=70, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="measured"
)
NAMES = [dof.name for dof in LOWER_BODY]


@pytest.mark.parametrize("seed", range(8))
def test_bones_equal_pinocchio(seed):
    position = np.random.default_rng(seed).normal(scale=1.5, size=15)
    oracle, found = PinocchioBody(LowerBodyModel(BODY)), bones(BODY, position.tolist())
    assert tuple(found) == SEGMENTS
    for segment, bone in found.items():
        R, at = oracle.segment_pose(segment, position)
        quat = np.array(bone.quat_world_from_segment)
        np.testing.assert_allclose(matrix_from_quaternion(quat), R, atol=1e-12)
        np.testing.assert_allclose(bone.position, at, atol=1e-12)
        assert quat[0] >= 0.0
        assert np.linalg.norm(quat) == pytest.approx(1.0, abs=1e-12)
        np.testing.assert_allclose(rotated(bone.quat_world_from_segment, (0.1, -0.2, 0.3)), R @ [0.1, -0.2, 0.3])
    for shank in (Segment.SHANK_RIGHT, Segment.SHANK_LEFT):
        np.testing.assert_allclose(ankle(BODY, found[shank]), oracle.ankle_position(shank, position), atol=1e-12)


def test_the_lower_ankle_of_those_drawn_stands_on_the_floor_and_only_observed_bones_are_known():
    position = [0.0] * 15
    position[NAMES.index("knee_flexion_left")] = 1.0
    right = (Segment.THIGH_RIGHT, Segment.SHANK_RIGHT)
    drawn = segment_pictures(BODY, position, SEGMENTS, right)
    assert [each.segment for each in drawn if each.valid] == list(right)
    assert drawn[0].position == pytest.approx([0.0, 0.83, 0.0])
    alone = segment_pictures(BODY, position, (Segment.THIGH_LEFT, Segment.SHANK_LEFT), SEGMENTS)
    assert alone[0].position[1] == pytest.approx(0.42 + 0.41 * np.cos(1.0))


def test_the_whole_body_s_legs_are_drawn_as_a_lower_body():
    names = [dof.name for dof in WHOLE_BODY]
    whole = [float(place) for place, _ in enumerate(names)]
    lower = dict(zip(NAMES, lower_body_of(whole), strict=True))
    assert lower["knee_flexion_left"] == names.index("knee_flexion_left")
    assert lower["pelvis_tilt"] == names.index("pelvis_tilt")
    assert lower["knee_adduction_right"] == 0.0


def test_a_picture_is_due_once_a_period():
    pace = Pace(10.0)
    times = [0, 50_000_000, 99_000_000, 100_000_000, 110_000_000, 350_000_000, 399_999_999, 400_000_000]
    assert [pace.is_due(each) for each in times] == [True, False, False, True, False, True, False, True]
