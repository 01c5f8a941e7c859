"""The virtual yaw measurement in a whole filter step, against differences of headings that Pinocchio gives."""

import numpy as np
import pytest
from numpy.typing import NDArray

from schemas.session import Anthropometry
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.biomech.lower_body_ekf import LowerBodyEkf, MeasurementModel, NoiseModel
from services.biomech.pinocchio_model import PinocchioBody

Array = NDArray[np.float64]

BODY = Anthropometry(
    height_m=1.75, mass_kg=70, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="measured"
)
MODEL = LowerBodyModel(BODY)
ORACLE = PinocchioBody(MODEL)
MOUNTS = [SensorMount(segment, np.eye(3)) for segment in SEGMENTS]
DT_S = 1e-6


def headings(mode: str, position: Array) -> Array:
    """What is measured as zero in each mode, rad."""
    pelvis, right, left = (
        ORACLE.yaw(segment, position)[0] for segment in (Segment.PELVIS, Segment.THIGH_RIGHT, Segment.THIGH_LEFT)
    )
    return np.array([pelvis, right, left] if mode == "world" else [right - pelvis, left - pelvis])


def wrapped(angle: Array) -> Array:
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def rows_by_differences(mode: str, position: Array) -> Array:
    """d(headings)/dq, central differences."""
    step = 1e-6
    moves = step * np.eye(len(position))
    return np.array(
        [wrapped(headings(mode, position + move) - headings(mode, position - move)) / (2 * step) for move in moves]
    ).T


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("mode", ["world", "relative"])
def test_a_step_without_samples_corrects_as_the_exact_rows_say(mode: str, seed: int) -> None:
    """With P = I and variance 1 the correction is H' (H H' + I)^-1 (0 - headings)."""
    ekf = LowerBodyEkf(
        MODEL, MOUNTS, np.zeros((5, 3)), MeasurementModel(yaw=mode), NoiseModel(yaw_std=(DT_S / 0.01) ** 0.5)
    )
    position = np.random.default_rng(seed).normal(size=15) * 0.4
    ekf.x[:] = 0.0
    ekf.x[0] = position
    ekf.P[:] = np.eye(len(ekf.P))
    H = rows_by_differences(mode, position)
    expected = H.T @ np.linalg.solve(H @ H.T + np.eye(len(H)), -wrapped(headings(mode, position)))
    ekf.advance(DT_S, np.zeros((5, 6)), np.zeros(5, dtype=np.bool_), np.zeros(15), np.zeros((3, 15)))
    np.testing.assert_allclose(ekf.x[0] - position, expected, atol=2e-5)
    assert np.abs(expected).max() > 0.05


@pytest.mark.parametrize(("mode", "turned"), [("world", True), ("relative", False)])
def test_a_turn_of_the_whole_body_is_pulled_back_in_world_mode_alone(mode: str, turned: bool) -> None:
    ekf = LowerBodyEkf(MODEL, MOUNTS, np.zeros((5, 3)), MeasurementModel(yaw=mode))
    ekf.x[0, 0] = 1.0
    upright = np.tile([0.0, 0.0, 0.0, 0.0, 9.81, 0.0], (5, 1))
    for _ in range(100):
        ekf.advance(0.01, upright, np.ones(5, dtype=np.bool_), np.zeros(15), np.zeros((3, 15)))
    assert (abs(ekf.x[0, 0]) < 0.5) == turned
