"""The published axis and angle, from exact orientations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.biomech.two_sensor_knee.mcgrath import knee_flexion, principal_axis, relative_rate, segment_frame

RATE_HZ = 100.0


def hinge(axis_in_thigh, flexion):
    """A thigh that tumbles and a shank that turns about the axis; both sensors' orientations and rates."""
    t = np.arange(len(flexion)) / RATE_HZ
    thigh = Rotation.from_euler("YXZ", np.stack([0.4 * t, 0.3 * np.sin(t), 0.5 * np.sin(2 * t)], axis=1))
    mounted = Rotation.from_euler("xyz", [0.3, -0.2, 0.5])
    shank = thigh * Rotation.from_rotvec(np.outer(flexion, axis_in_thigh)) * mounted
    rates = [(R[:-1].inv() * R[1:]).as_rotvec() * RATE_HZ for R in (thigh, shank)]
    return thigh[:-1].as_matrix(), shank[:-1].as_matrix(), *rates


def test_angle_and_axis_of_an_exact_hinge():
    axis = np.array([0.2, -0.3, np.sqrt(0.87)])
    flexion = 0.6 - 0.6 * np.cos(np.arange(2001) / RATE_HZ * 5.0)
    angle, axes = knee_flexion(*hinge(axis, flexion))
    sense = np.sign(axes[0] @ axis)
    assert abs(axes[0] @ axis) > np.cos(np.radians(1.0))
    change = sense * (np.unwrap(angle) - angle[0])
    assert np.degrees(np.abs(change - (flexion[:-1] - flexion[0]))).max() < 1.5


def test_relative_rate_of_a_locked_knee_is_none():
    thigh, shank, thigh_rate, shank_rate = hinge(np.array([0.0, 0.0, 1.0]), np.full(50, 0.3))
    assert np.abs(relative_rate(thigh, shank, thigh_rate, shank_rate)).max() < 1e-2


def test_principal_axis_does_not_mind_the_sense():
    rates = np.outer(np.sin(np.arange(100.0)), [0.6, 0.0, 0.8])
    assert abs(principal_axis(rates) @ [0.6, 0.0, 0.8]) == pytest.approx(1.0)


def test_segment_frame_is_a_rotation_with_the_axis_as_z():
    R = segment_frame(np.array([0.2, 0.5, -0.3]))
    assert pytest.approx(np.eye(3)) == R.T @ R
    assert np.linalg.det(R) == pytest.approx(1.0)
    assert R[:, 2] == pytest.approx(np.array([0.2, 0.5, -0.3]) / np.linalg.norm([0.2, 0.5, -0.3]))
    assert R[0, 1] == 0.0


def test_segment_frame_does_not_exist_along_the_sensors_x():
    with pytest.raises(ValueError, match="direction"):
        segment_frame(np.array([1.0, 0.0, 0.0]))
