"""A leg posed by hand: every degree of freedom moves the body in the direction that its name says."""

import numpy as np
import pytest
from numpy.typing import NDArray

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY, Segment
from services.biomech.bones import SEGMENTS
from services.biomech.forward_kinematics import Pose, ankle_position, segment_poses
from services.biomech.lower_body import LowerBodyModel
from services.biomech.pinocchio_model import PinocchioBody

Array = NDArray[np.float64]

BODY = Anthropometry(
    height_m=1.75, mass_kg=70, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="measured"
)
MODEL = LowerBodyModel(BODY)
FORWARD, UP, RIGHT = np.eye(3)
MIDLINE = {"right": -RIGHT, "left": RIGHT}


def posed(**angles: float) -> dict[Segment, Pose]:
    position = np.zeros(15)
    for name, angle in angles.items():
        position[MODEL.names.index(name)] = angle
    return segment_poses(MODEL, position)


def direction(poses: dict[Segment, Pose], segment: str, axis: Array) -> Array:
    return poses[Segment(segment)].R_world_from_segment @ axis


def test_zero_is_upright_and_faces_forward() -> None:
    poses = posed()
    for pose in poses.values():
        np.testing.assert_allclose(pose.R_world_from_segment, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(poses[Segment.THIGH_RIGHT].position, [0, 0, 0.09])
    np.testing.assert_allclose(poses[Segment.SHANK_LEFT].position, [0, -0.42, -0.09])
    np.testing.assert_allclose(ankle_position(MODEL, poses, Segment.SHANK_LEFT), [0, -0.83, -0.09])


@pytest.mark.parametrize("side", ["right", "left"])
def test_legs(side: str) -> None:
    thigh, shank, down = f"thigh_{side}", f"shank_{side}", -UP
    assert direction(posed(**{f"hip_flexion_{side}": 0.5}), thigh, down) @ FORWARD > 0.4
    assert direction(posed(**{f"hip_adduction_{side}": 0.5}), thigh, down) @ MIDLINE[side] > 0.4
    assert direction(posed(**{f"hip_internal_rotation_{side}": 0.5}), thigh, FORWARD) @ MIDLINE[side] > 0.4
    assert direction(posed(**{f"knee_flexion_{side}": 0.5}), shank, down) @ FORWARD < -0.4
    assert direction(posed(**{f"knee_adduction_{side}": 0.5}), shank, down) @ MIDLINE[side] > 0.4
    assert direction(posed(**{f"knee_internal_rotation_{side}": 0.5}), shank, FORWARD) @ MIDLINE[side] > 0.4


def test_pelvis() -> None:
    assert direction(posed(pelvis_rotation=0.5), "pelvis", FORWARD) @ RIGHT < -0.4
    assert direction(posed(pelvis_tilt=0.5), "pelvis", FORWARD) @ UP < -0.4
    assert direction(posed(pelvis_obliquity=0.5), "pelvis", RIGHT) @ UP > 0.4


def test_sitting_bends_hip_and_knee_by_a_right_angle() -> None:
    quarter = np.pi / 2
    poses = posed(hip_flexion_right=quarter, knee_flexion_right=quarter)
    np.testing.assert_allclose(poses[Segment.SHANK_RIGHT].position, [0.42, 0, 0.09], atol=1e-12)
    np.testing.assert_allclose(ankle_position(MODEL, poses, Segment.SHANK_RIGHT), [0.42, -0.41, 0.09], atol=1e-12)


@pytest.mark.parametrize("translations", [False, True])
@pytest.mark.parametrize("soft_knees", [False, True])
def test_poses_equal_pinocchio(translations: bool, soft_knees: bool) -> None:
    model = LowerBodyModel(BODY, translations, soft_knees)
    oracle = PinocchioBody(model)
    for seed in range(5):
        position = np.random.default_rng(seed).normal(size=len(model.dofs))
        poses = segment_poses(model, position)
        for segment in SEGMENTS:
            R, at = oracle.segment_pose(segment, position)
            np.testing.assert_allclose(poses[segment].R_world_from_segment, R, atol=1e-12)
            np.testing.assert_allclose(poses[segment].position, at, atol=1e-12)
        for shank in (Segment.SHANK_RIGHT, Segment.SHANK_LEFT):
            expected = oracle.ankle_position(shank, position)
            np.testing.assert_allclose(ankle_position(model, poses, shank), expected, atol=1e-12)


def test_models_have_the_degrees_of_freedom_they_promise() -> None:
    assert len(LowerBodyModel(BODY, translations=True, soft_knees=False).dofs) == 14
    assert MODEL.dofs == LOWER_BODY
    np.testing.assert_array_equal(MODEL.reported, np.arange(15))
    without_soft = LowerBodyModel(BODY, soft_knees=False).reported
    assert (without_soft == -1).sum() == 4
    assert PinocchioBody(MODEL).model.names[1:].tolist() == [dof.name for dof in LOWER_BODY]
