import numpy as np
import pytest

from schemas.signals import JOINT_CENTRES, JOINT_STATE
from schemas.vocabulary import JointCentre, Segment
from services.biomech.lower_body import LowerBodyModel
from services.biomech.pinocchio_model import PinocchioBody
from services.exports.joint_positions import AT_PELVIS, IN_ROOM, LEG_CENTRES, joint_positions, leg_poses, rotation_about
from services.exports.motion import gather_motion


def test_legs_stand_where_pinocchio_puts_them(about, made):
    """Independent oracle: the same body built with another library."""
    body = about.anthropometry
    oracle = PinocchioBody(LowerBodyModel(body))
    motion = gather_motion(made.joint_states(count=50))
    positions = joint_positions(motion, body)
    assert positions.names == LEG_CENTRES
    assert positions.origin == AT_PELVIS
    assert positions.track.valid.all()
    for row, angles in enumerate(motion.angles.value[..., 0]):
        expected = []
        for side in ("right", "left"):
            expected += [oracle.segment_pose(Segment(f"{name}_{side}"), angles)[1] for name in ("thigh", "shank")]
            expected.append(oracle.ankle_position(Segment(f"shank_{side}"), angles))
        np.testing.assert_allclose(positions.track.value[row], expected, atol=1e-12)


def test_every_frame_is_that_of_pinocchio(about):
    angles = np.random.default_rng(4).uniform(-1, 1, (5, 15))
    model = LowerBodyModel(about.anthropometry)
    oracle = PinocchioBody(model)
    rotation, origin = leg_poses(angles, about.anthropometry)
    for row in range(5):
        for segment in (Segment.PELVIS, Segment.SHANK_LEFT):
            R, at = oracle.segment_pose(segment, angles[row])
            np.testing.assert_allclose(rotation[row, model.last_joint(segment)], R, atol=1e-12)
            np.testing.assert_allclose(origin[row, model.last_joint(segment)], at, atol=1e-12)


def test_a_leg_of_which_only_the_knee_is_told_has_no_joint_centres(about, made):
    names = ["knee_flexion_right"]
    motion = gather_motion(made.joint_states(valid=[f == 6 for f in range(15)], count=20))
    assert sorted(motion.told) == names
    assert joint_positions(motion, about.anthropometry) is None


def test_one_leg_is_told_without_the_other(about, made):
    motion = gather_motion(made.joint_states(valid=[f < 9 for f in range(15)], count=20))
    track = joint_positions(motion, about.anthropometry).track
    assert track.valid.all(axis=0).tolist() == [True, True, True, True, False, False]
    assert not track.value[:, 4:].any()


def test_a_camera_tells_its_own(seen):
    motion = gather_motion(seen.payloads(JOINT_STATE, JOINT_CENTRES))
    positions = joint_positions(motion, seen.description.anthropometry)
    assert positions.origin == IN_ROOM
    assert positions.names == tuple(JointCentre)
    np.testing.assert_allclose(positions.track.value[0, 1], [0.1, 1.0, -1.99])


@pytest.mark.parametrize(("axis", "moved"), [(0, [1, 0, 0]), (1, [0, 0, -1]), (2, [0, 1, 0])])
def test_rotations_turn_by_the_right_hand(axis, moved):
    R = rotation_about(axis, np.array([np.pi / 2]))[0]
    np.testing.assert_allclose(R @ [1.0, 0.0, 0.0], moved, atol=1e-15)
