import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.exports.errors import ExportError
from services.exports.motion import gather_motion
from services.exports.opensim.coordinates import tilt_list_rotation, to_coordinates
from services.exports.opensim.models import GAIT_10DOF, PELVIS, RAJAGOPAL, known_model


@pytest.fixture
def motion(made):
    return gather_motion(made.joint_states())


def column(coordinates, name):
    return coordinates.values[:, coordinates.names.index(name)]


def test_angles_are_ours_with_the_models_sign(motion):
    knee, _ = motion.angle("knee_flexion_left")
    rajagopal, planar = (to_coordinates(motion, known_model(name)) for name in (RAJAGOPAL, GAIT_10DOF))
    np.testing.assert_array_equal(column(rajagopal, "knee_angle_l"), knee)
    np.testing.assert_array_equal(column(planar, "knee_angle_l"), -knee)
    for name in ("hip_flexion", "hip_adduction"):
        np.testing.assert_array_equal(column(rajagopal, f"{name}_r"), motion.angle(f"{name}_right")[0])
    assert planar.names == ("pelvis_tilt", "hip_flexion_r", "knee_angle_r", "hip_flexion_l", "knee_angle_l")
    assert rajagopal.without == ("ankle_angle_r", "ankle_angle_l")


def test_the_pelvis_is_the_same_rotation_in_their_sequence():
    """Independent oracle: SciPy's intrinsic rotations."""
    rng = np.random.default_rng(5)
    heading, tilt, obliquity = rng.uniform(-3, 3, 40), rng.uniform(-0.6, 0.6, 40), rng.uniform(-0.6, 0.6, 40)
    ours = Rotation.from_euler("YZX", np.stack([heading, -tilt, -obliquity], axis=1))
    theirs = Rotation.from_euler("ZXY", tilt_list_rotation(heading, tilt, obliquity).T)
    assert (ours.inv() * theirs).magnitude().max() < 1e-12


@pytest.mark.parametrize(
    ("ours", "theirs"),
    [((0.0, 0.2, 0.0), (-0.2, 0.0, 0.0)), ((0.0, 0.0, 0.2), (0.0, -0.2, 0.0)), ((0.2, 0.0, 0.0), (0.0, 0.0, 0.2))],
)
def test_a_leaning_pelvis_has_the_signs_of_the_models(ours, theirs):
    """Forward is negative tilt, right side up negative list, to the left positive rotation."""
    found = tilt_list_rotation(*(np.array([angle]) for angle in ours))
    np.testing.assert_allclose(found[:, 0], theirs, atol=1e-12)


def test_turning_on_and_on_does_not_jump(made):
    motion = gather_motion(made.joint_states(count=3000))
    rotation = column(to_coordinates(motion, known_model(RAJAGOPAL)), PELVIS[2])
    assert rotation.max() > 2 * np.pi
    assert np.abs(np.diff(rotation)).max() < 0.1


def test_a_leg_worn_the_other_way_round_is_refused(made):
    """Every knee angle negative: it would bend forward."""
    states = [
        state.model_copy(update={"position": (-np.array(state.position)).tolist()}) for state in made.joint_states()
    ]
    with pytest.raises(ExportError, match=r"model.knee_angle_r: .*with the other sign"):
        to_coordinates(gather_motion(states), known_model(RAJAGOPAL))


def test_rows_with_a_hole_are_left_out_and_counted(made):
    later = made.joint_states(count=50, valid=[f != 12 for f in range(15)], start_ns=made.start_ns + 10**10)
    coordinates = to_coordinates(gather_motion([*made.joint_states(), *later]), known_model(RAJAGOPAL))
    assert coordinates.rows_left_out == 50
    assert coordinates.times_ns.size == 1000


def test_a_single_knee_is_a_file_of_one_coordinate(made):
    motion = gather_motion(made.joint_states(valid=[f == 6 for f in range(15)]))
    assert to_coordinates(motion, known_model(RAJAGOPAL)).names == ("knee_angle_r",)


def test_a_session_of_none_of_the_models_angles_is_refused(made):
    motion = gather_motion(made.joint_states(valid=[f == 8 for f in range(15)]))
    with pytest.raises(ExportError, match=r"is told; export joint_angles\.csv"):
        to_coordinates(motion, known_model(GAIT_10DOF))
