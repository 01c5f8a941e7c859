import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.biomech.rotations import (
    angle_between,
    frame_from_up_and_right,
    matrix_from_quaternion,
    multiply_quaternions,
    normalised,
    quaternion_from_matrix,
    rotation_about,
    skew,
)

TURNS = [Rotation.random(random_state=seed) for seed in range(20)] + [
    Rotation.from_euler("xyz", angles, degrees=True) for angles in ((180, 0, 0), (0, 180, 0), (0, 0, 180), (0, 0, 0))
]


@pytest.mark.parametrize("turn", TURNS)
def test_quaternions_and_matrices_agree(turn: Rotation) -> None:
    R = turn.as_matrix()
    quat = quaternion_from_matrix(R)
    assert quat[0] >= 0.0
    assert np.linalg.norm(quat) == pytest.approx(1.0)
    np.testing.assert_allclose(matrix_from_quaternion(quat), R, atol=1e-12)
    np.testing.assert_allclose(np.abs(quat @ turn.as_quat(scalar_first=True)), 1.0, atol=1e-12)


def test_product_is_one_rotation_after_the_other() -> None:
    p, q = TURNS[0], TURNS[1]
    product = multiply_quaternions(quaternion_from_matrix(p.as_matrix()), quaternion_from_matrix(q.as_matrix()))
    np.testing.assert_allclose(matrix_from_quaternion(product), (p * q).as_matrix(), atol=1e-12)


def test_rotation_about_turns_by_the_right_hand_rule() -> None:
    # A quarter turn about up takes forward to the left (minus right).
    turned = rotation_about(np.array([0.0, 1.0, 0.0]), np.pi / 2) @ np.array([1.0, 0.0, 0.0])
    np.testing.assert_allclose(turned, [0.0, 0.0, -1.0], atol=1e-15)


def test_skew_is_the_cross_product() -> None:
    a, b = np.array([1.0, 2.0, 3.0]), np.array([-2.0, 0.5, 1.0])
    np.testing.assert_allclose(skew(a) @ b, np.cross(a, b))


def test_frame_takes_up_exactly_and_right_as_nearly_as_it_can() -> None:
    up, right = np.array([0.1, 0.2, 9.8]), np.array([1.0, 0.3, 0.5])
    R = frame_from_up_and_right(up, right)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(R) == pytest.approx(1.0)
    np.testing.assert_allclose(R @ normalised(up), [0.0, 1.0, 0.0], atol=1e-12)
    assert (R @ right)[2] > 0.0
    assert (R @ right)[0] == pytest.approx(0.0, abs=1e-12)


def test_impossible_directions_are_refused() -> None:
    with pytest.raises(ValueError, match="direction"):
        normalised(np.zeros(3))
    with pytest.raises(ValueError, match="direction"):
        frame_from_up_and_right(np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -2.0]))


def test_angle_between() -> None:
    assert angle_between(np.array([1.0, 0, 0]), np.array([0, 2.0, 0])) == pytest.approx(np.pi / 2)
    assert angle_between(np.array([1.0, 0, 0]), np.array([-1.0, 0, 0])) == pytest.approx(np.pi)
