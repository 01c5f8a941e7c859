import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY
from services.segmentation.batch import INDEX
from services.segmentation.gait.leg_kinematics import SIDES, leg_motion

BODY = Anthropometry(
    height_m=None, mass_kg=None, thigh_length_m=0.41, shank_length_m=0.39, hip_width_m=0.18, source="measured"
)
FORWARD, UP, RIGHT = 0, 1, 2


def pose(**angles: float) -> np.ndarray:
    position = np.zeros((1, len(LOWER_BODY)))
    for name, value in angles.items():
        position[0, INDEX[name]] = value
    return position


def ankle(side: str, **angles: float) -> np.ndarray:
    return leg_motion(pose(**angles), np.zeros((1, 15)), BODY).ankle[:, 0, SIDES.index(side)]


def rate(side: str, angles: dict[str, float], rates: dict[str, float]) -> float:
    return float(leg_motion(pose(**angles), pose(**rates), BODY).shank_rate[0, SIDES.index(side)])


def test_standing():
    np.testing.assert_allclose(ankle("left"), [0, -0.80, -0.09], atol=1e-12)
    np.testing.assert_allclose(ankle("right"), [0, -0.80, 0.09], atol=1e-12)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_posed_leg_goes_where_the_vocabulary_says(side):
    outward = 1 if side == "right" else -1
    assert ankle(side, **{f"hip_flexion_{side}": 0.3})[FORWARD] > 0.2
    assert ankle(side, **{f"knee_flexion_{side}": 0.3})[FORWARD] < -0.1
    assert outward * ankle(side, **{f"hip_adduction_{side}": 0.3})[RIGHT] < -0.1
    assert outward * ankle(side, **{f"knee_adduction_{side}": 0.3})[RIGHT] < 0.0
    # Sitting, the foot of an internally rotated hip points outwards from the knee.
    seated = {f"hip_flexion_{side}": np.pi / 2, f"knee_flexion_{side}": np.pi / 2}
    assert outward * ankle(side, **seated, **{f"hip_internal_rotation_{side}": 0.3})[RIGHT] > 0.1


def test_pelvis_coordinates_tilt_the_legs_but_not_the_heading_frame():
    assert ankle("left", pelvis_tilt=0.2)[FORWARD] < -0.1
    assert ankle("left", pelvis_obliquity=0.2)[RIGHT] > ankle("left")[RIGHT]
    np.testing.assert_allclose(ankle("left", pelvis_rotation=1.0), ankle("left"))


@pytest.mark.parametrize("side", ["left", "right"])
def test_shank_rate_is_positive_when_the_ankle_swings_forward(side):
    assert rate(side, {}, {f"hip_flexion_{side}": 1.0}) == pytest.approx(1.0)
    assert rate(side, {}, {f"knee_flexion_{side}": 1.0}) == pytest.approx(-1.0)
    assert rate(side, {}, {"pelvis_tilt": 1.0}) == pytest.approx(-1.0)
    assert rate(side, {}, {"pelvis_rotation": 1.0}) == pytest.approx(0.0)


def world_from_shank(position: np.ndarray, side: str) -> Rotation:
    chain = Rotation.identity()
    for dof, angle in zip(LOWER_BODY, position, strict=True):
        if dof.name.startswith("pelvis") or dof.name.endswith(side):
            chain = chain * Rotation.from_rotvec(angle * np.array(dof.axis, dtype=float))
    return chain


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("seed", range(5))
def test_against_rotations_multiplied_out(side, seed):
    rng = np.random.default_rng(seed)
    position, velocity = rng.uniform(-1, 1, (2, 15))
    motion = leg_motion(position[None], velocity[None], BODY)
    h = 1e-6
    before, after = (world_from_shank(position + sign * h * velocity, side) for sign in (-1, 1))
    # Angular velocity in the shank's own frame by central difference.
    omega = (before.inv() * after).as_rotvec() / (2 * h)
    assert motion.shank_rate[0, SIDES.index(side)] == pytest.approx(omega[2], abs=1e-6)
    shank = world_from_shank(position, side).apply([0, -BODY.shank_length_m, 0])
    drawn = (motion.ankle - motion.knee)[:, 0, SIDES.index(side)]
    heading = Rotation.from_rotvec([0, position[INDEX["pelvis_rotation"]], 0])
    np.testing.assert_allclose(heading.apply(drawn), shank, atol=1e-12)


def test_rows_do_not_mix():
    rng = np.random.default_rng(0)
    position, velocity = rng.uniform(-1, 1, (2, 7, 15))
    together = leg_motion(position, velocity, BODY)
    alone = leg_motion(position[3:4], velocity[3:4], BODY)
    np.testing.assert_allclose(together.ankle[:, 3], alone.ankle[:, 0], atol=1e-15)
    np.testing.assert_allclose(together.shank_rate[3], alone.shank_rate[0], atol=1e-15)
