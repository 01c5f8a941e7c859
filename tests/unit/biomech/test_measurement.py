"""Predicted samples and Jacobians: against Pinocchio and against central differences."""

import numpy as np
import pytest
from numpy.typing import NDArray

from schemas.session import Anthropometry
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.kernels.kinematics import accelerate, orient
from services.biomech.kernels.measurement import column, yaw_row
from services.biomech.kernels.step import predicted_sample
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.biomech.lower_body_ekf import LowerBodyEkf, MeasurementModel
from services.biomech.pinocchio_model import PinocchioBody
from services.biomech.rotations import rotation_about

Array = NDArray[np.float64]

BODY = Anthropometry(
    height_m=1.75, mass_kg=70, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="measured"
)
MODELS = {
    "14 dof": LowerBodyModel(BODY, translations=True, soft_knees=False),
    "18 dof": LowerBodyModel(BODY, translations=True, soft_knees=True),
    "15 dof": LowerBodyModel(BODY),
}
DYNAMIC = [("14 dof", True), ("18 dof", True), ("14 dof", False), ("18 dof", False), ("15 dof", False)]


def mounts(seed: int) -> list[SensorMount]:
    random = np.random.default_rng(seed)
    result = []
    for segment in SEGMENTS:
        axis = random.normal(size=3)
        R = rotation_about(axis / np.linalg.norm(axis), float(random.uniform(0, 3)))
        at = random.normal(size=3) * 0.2
        result.append(SensorMount(segment, R, (float(at[0]), float(at[1]), float(at[2]))))
    return result


def random_state(model: LowerBodyModel, seed: int) -> Array:
    random = np.random.default_rng(seed)
    n = len(model.dofs)
    return np.stack([random.normal(size=n) * 0.5, random.normal(size=n) * 3.0, random.normal(size=n) * 20.0])


def predict(ekf: LowerBodyEkf, x: Array) -> tuple[Array, Array]:
    """Samples (S, 6) and the Jacobian (S, 6, 3, n) spread back to joint coordinates."""
    orient(x, ekf.body, ekf._motion)
    accelerate(x, ekf.body, ekf._motion)
    S, n, t = len(ekf.sensors.joint), x.shape[1], ekf.body.translations
    z, H = np.zeros((S, 6)), np.zeros((S, 6, 3, n))
    for s in range(S):
        row = np.zeros((6, ekf.padded_covariance.shape[1]))
        predicted_sample(s, ekf.body, ekf.sensors, ekf.options, ekf._motion, z[s], row)
        for order in range(3):
            for j in range(n):
                if j >= t or order == 2:
                    H[s, :, order, j] = row[:, column(order, j, t, n)]
    return z, H


def differences(ekf: LowerBodyEkf, x: Array) -> Array:
    """Central differences of `predict`, (S, 6, 3, n)."""
    H = np.zeros((len(ekf.sensors.joint), 6, *x.shape))
    step = 1e-6
    for index in np.ndindex(*x.shape):
        up, down = x.copy(), x.copy()
        up[index] += step
        down[index] -= step
        H[(slice(None), slice(None), *index)] = (predict(ekf, up)[0] - predict(ekf, down)[0]) / (2 * step)
    return H


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ["14 dof", "18 dof"])
def test_whole_motion_equals_pinocchio(name: str, seed: int) -> None:
    model, sensors = MODELS[name], mounts(seed)
    ekf = LowerBodyEkf(
        model, sensors, np.zeros((5, 3)), MeasurementModel(gyro_sees_position=True, accel_sees_motion=True)
    )
    x = random_state(model, seed)
    z, H = predict(ekf, x)
    oracle = PinocchioBody(model, sensors)
    for s in range(5):
        expected_z, expected_H = oracle.sample_jacobian(s, x)
        np.testing.assert_allclose(expected_z, oracle.sample(s, x), atol=1e-9)
        np.testing.assert_allclose(z[s], expected_z, atol=1e-9)
        # Position and velocity of the pelvis are not part of the covariance: Pinocchio must find them without effect.
        np.testing.assert_allclose(H[s], expected_H, atol=1e-9)


@pytest.mark.parametrize("name", list(MODELS))
def test_gyroscope_equals_pinocchio_in_every_model(name: str) -> None:
    model, sensors = MODELS[name], mounts(5)
    ekf = LowerBodyEkf(model, sensors, np.zeros((5, 3)), MeasurementModel(gyro_sees_position=True))
    x = random_state(model, 5)
    z, H = predict(ekf, x)
    for s in range(5):
        expected_z, expected_H = PinocchioBody(model, sensors).sample_jacobian(s, x)
        np.testing.assert_allclose(z[s, :3], expected_z[:3], atol=1e-9)
        np.testing.assert_allclose(H[s, :3], expected_H[:3], atol=1e-9)


@pytest.mark.parametrize(("name", "sees_motion"), DYNAMIC)
def test_jacobian_equals_central_differences(name: str, sees_motion: bool) -> None:
    model = MODELS[name]
    options = MeasurementModel(gyro_sees_position=True, accel_sees_motion=sees_motion)
    ekf = LowerBodyEkf(model, mounts(7), np.zeros((5, 3)), options)
    for seed in range(3):
        x = random_state(model, 20 + seed)
        np.testing.assert_allclose(predict(ekf, x)[1], differences(ekf, x), rtol=1e-6, atol=2e-6)


def test_without_position_the_gyro_keeps_its_value_and_its_velocity_columns() -> None:
    model, sensors = MODELS["15 dof"], mounts(3)
    full = LowerBodyEkf(model, sensors, np.zeros((5, 3)), MeasurementModel(gyro_sees_position=True))
    ours = LowerBodyEkf(model, sensors, np.zeros((5, 3)))
    x = random_state(model, 3)
    (z_full, H_full), (z, H) = predict(full, x), predict(ours, x)
    np.testing.assert_array_equal(z, z_full)
    np.testing.assert_array_equal(H[:, :3, 1], H_full[:, :3, 1])
    assert np.abs(H_full[:, :3, 0]).max() > 0.1
    assert not H[:, :3, 0].any()


def test_gravity_alone_is_the_whole_motion_at_rest() -> None:
    model, sensors = MODELS["18 dof"], mounts(9)
    gravity = LowerBodyEkf(model, sensors, np.zeros((5, 3)))
    motion = LowerBodyEkf(model, sensors, np.zeros((5, 3)), MeasurementModel(accel_sees_motion=True))
    x = random_state(model, 9)
    x[1:] = 0.0
    (z_gravity, H_gravity), (z, H) = predict(gravity, x), predict(motion, x)
    np.testing.assert_allclose(z_gravity, z, atol=1e-12)
    np.testing.assert_allclose(H_gravity[:, 3:, 0], H[:, 3:, 0], atol=1e-12)


@pytest.mark.parametrize("segment", [Segment.PELVIS, Segment.THIGH_LEFT, Segment.THIGH_RIGHT])
def test_yaw_row_equals_pinocchio_and_differences(segment: Segment) -> None:
    model = MODELS["15 dof"]
    ekf, oracle = LowerBodyEkf(model, mounts(1), np.zeros((5, 3))), PinocchioBody(model)
    joint = model.last_joint(segment)
    for seed in range(4):
        x = random_state(model, seed) * np.array([[0.5], [1.0], [1.0]])

        def yaw(x: Array) -> tuple[float, Array]:
            orient(x, ekf.body, ekf._motion)
            row = np.zeros(ekf.padded_covariance.shape[1])
            return yaw_row(joint, ekf.body, ekf._motion, 1.0, row), row[:15]

        value, row = yaw(x)
        expected, expected_row = oracle.yaw(segment, x[0])
        assert value == pytest.approx(expected, abs=1e-12)
        np.testing.assert_allclose(row, expected_row, atol=1e-12)
        for j in range(15):
            step = np.zeros((3, 15))
            step[0, j] = 1e-6
            turned = yaw(x + step)[0] - yaw(x - step)[0]
            difference = ((turned + np.pi) % (2 * np.pi) - np.pi) / 2e-6
            assert row[j] == pytest.approx(difference, abs=1e-6)
