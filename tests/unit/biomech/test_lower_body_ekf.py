"""The compiled filter: equal to the textbook's, symmetric, at ease with missing sensors."""

import numpy as np
import pytest
from numpy.typing import NDArray

from schemas.session import Anthropometry
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.biomech.lower_body_ekf import LowerBodyEkf, MeasurementModel, NoiseModel
from services.biomech.pinocchio_model import PinocchioBody
from services.biomech.rotations import rotation_about
from services.biomech.textbook_ekf import TextbookEkf

Array = NDArray[np.float64]

BODY = Anthropometry(
    height_m=1.75, mass_kg=70, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="measured"
)
OURS = MeasurementModel()
PAPER = MeasurementModel(gyro_sees_position=True, accel_sees_motion=True, yaw="world")
CASES = {
    "15 dof, gravity": (LowerBodyModel(BODY), OURS),
    "15 dof, world yaw": (LowerBodyModel(BODY), MeasurementModel(yaw="world")),
    "11 dof, full gyro, no yaw": (
        LowerBodyModel(BODY, soft_knees=False),
        MeasurementModel(gyro_sees_position=True, yaw="none"),
    ),
    "14 dof as in the paper": (LowerBodyModel(BODY, translations=True, soft_knees=False), PAPER),
    "18 dof, dynamic": (LowerBodyModel(BODY, translations=True), MeasurementModel(accel_sees_motion=True)),
}
ALL = np.ones(5, dtype=np.bool_)
BLOW = np.array([6.0, -5.0, 4.0, 60.0, 90.0, -40.0])
"""rad/s and m/s^2 that a landing adds."""


def mounts() -> list[SensorMount]:
    random = np.random.default_rng(4)
    frames = [rotation_about(np.array([0.0, 0.6, 0.8]), float(random.uniform(-2, 2))) for _ in SEGMENTS]
    return [SensorMount(segment, R) for segment, R in zip(SEGMENTS, frames, strict=True)]


def motion(model: LowerBodyModel, t: float) -> Array:
    """A smooth motion (3, n): every joint swings at its own amplitude and phase."""
    n = len(model.dofs)
    amplitude, phase, w = 0.1 + 0.02 * np.arange(n), np.arange(n) * 1.3, 5.0
    return np.stack(
        [
            amplitude * np.sin(w * t + phase),
            amplitude * w * np.cos(w * t + phase),
            -amplitude * w * w * np.sin(w * t + phase),
        ]
    )


def samples_of(model: LowerBodyModel, steps: int, dt_s: float, noise: float = 0.05) -> Array:
    random = np.random.default_rng(1)
    oracle = PinocchioBody(model, mounts())
    clean = [[oracle.sample(s, motion(model, k * dt_s)) for s in range(5)] for k in range(steps)]
    return np.array(clean) + noise * random.normal(size=(steps, 5, 6))


def rest_of(model: LowerBodyModel) -> Array:
    rest = np.zeros((3, len(model.dofs)))
    rest[0, model.soft] = NoiseModel().soft_knee_std ** 2
    return rest


@pytest.mark.parametrize("name", list(CASES))
def test_equals_the_textbook(name: str) -> None:
    model, measurement = CASES[name]
    n, t, steps = len(model.dofs), model.first_rotation, 150
    fast = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement)
    slow = TextbookEkf(model, mounts(), measurement, NoiseModel())
    jerk = np.linspace(-20, 20, n)
    jerk[:t] = 0.0
    samples = samples_of(model, steps, 0.02)
    samples[70:72, 2] += BLOW
    for sample in samples:
        fast.advance(0.02, sample, ALL, jerk, rest_of(model))
        slow.advance(0.02, sample, jerk)
    x = slow.x.reshape(3, n)
    np.testing.assert_allclose(fast.x[:, t:], x[:, t:], atol=1e-8)
    np.testing.assert_allclose(fast.x[2, :t], x[2, :t], atol=1e-8)
    std = np.sqrt(np.diag(slow.P)).reshape(3, n)
    np.testing.assert_allclose(fast.deviations()[0, t:], std[0, t:], atol=1e-8)
    np.testing.assert_allclose(fast.deviations()[1, t:], std[1, t:], atol=1e-8)


def test_follows_the_motion_it_is_shown() -> None:
    model, _ = CASES["18 dof, dynamic"]
    noise = NoiseModel(gyro_std=0.005, accel_std=0.02, jerk_density=3e4)
    ekf = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), MeasurementModel(True, True, "none"), noise)
    ekf.x[:] = motion(model, 0.0)
    samples = samples_of(model, 400, 0.01, noise=0.002)
    for sample in samples:
        ekf.advance(0.01, sample, ALL, np.zeros(len(model.dofs)), np.zeros((3, len(model.dofs))))
    truth = motion(model, 3.99)
    # Heading is not observed without a yaw measurement; everything else is.
    assert np.abs(ekf.x[0, 4:] - truth[0, 4:]).max() < 0.05
    assert np.abs(ekf.x[1, 3:] - truth[1, 3:]).max() < 0.3


def test_gyro_bias_is_taken_off() -> None:
    model, measurement = CASES["15 dof, gravity"]
    bias = np.random.default_rng(0).normal(size=(5, 3)) * 0.02
    plain = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement)
    biased = LowerBodyEkf(model, mounts(), bias, measurement)
    for sample in samples_of(model, 50, 0.01):
        shifted = sample.copy()
        shifted[:, :3] += bias
        plain.advance(0.01, sample, ALL, np.zeros(15), rest_of(model))
        biased.advance(0.01, shifted, ALL, np.zeros(15), rest_of(model))
    np.testing.assert_allclose(biased.x, plain.x, atol=1e-10)


def test_a_blow_tilts_a_gravity_sensor_no_more_than_the_bound() -> None:
    """Ten times the force along one direction does what the bound does along it."""
    model, measurement = CASES["15 dof, gravity"]
    states = []
    for length in (measurement.force_bound, 10.0 * measurement.force_bound):
        ekf = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement)
        sample = samples_of(model, 1, 0.01)[0]
        sample[2, 3:] = length * np.array([0.6, 0.0, 0.8])
        ekf.advance(0.01, sample, ALL, np.zeros(15), rest_of(model))
        states.append(ekf.x.copy())
    np.testing.assert_allclose(states[0], states[1], atol=1e-12)


def test_velocity_follows_an_impact_at_once() -> None:
    """A knee that starts to turn between two samples: what walking shows is smoothed, what a landing shows is not."""
    model, measurement = CASES["15 dof, gravity"]
    knee = model.names.index("knee_flexion_right")
    followed = []
    for jump in (2.0, 10.0):
        ekf = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement)
        oracle = PinocchioBody(model, mounts())
        for k in range(101):
            x = np.zeros((3, 15))
            x[1, knee] = jump * (k == 100)
            ekf.advance(0.01, np.array([oracle.sample(s, x) for s in range(5)]), ALL, np.zeros(15), rest_of(model))
        followed.append(ekf.x[1, knee] / jump)
    assert followed[0] < 0.8
    assert followed[1] > 0.9


@pytest.mark.parametrize("density", [30.0, 300.0, 3e6])
def test_covariance_stays_symmetric_and_positive(density: float) -> None:
    model, measurement = CASES["15 dof, gravity"]
    ekf = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement, NoiseModel(jerk_density=density))
    samples = samples_of(model, 200, 0.01)
    for k in range(20_000):
        ekf.advance(0.01, samples[k % 200], ALL, np.zeros(15), rest_of(model))
    assert np.abs(ekf.P - ekf.P.T).max() < 1e-9 * np.abs(ekf.P).max()
    assert np.linalg.eigvalsh(ekf.P).min() > 0.0
    assert np.isfinite(ekf.x).all()


@pytest.mark.parametrize("name", ["15 dof, gravity", "14 dof as in the paper"])
def test_rest_is_measured_one_state_after_another(name: str) -> None:
    """All orders of three joints, against scalar updates written down plainly."""
    model, options = CASES[name]
    measurement = MeasurementModel(options.gyro_sees_position, options.accel_sees_motion, "none")
    free, held = (LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement) for _ in range(2))
    nowhere, jerk = np.zeros((3, len(model.dofs))), np.zeros(len(model.dofs))
    for ekf in (free, held):
        for sample in samples_of(model, 40, 0.01):
            ekf.advance(0.01, sample, ALL, jerk, nowhere)
    rest = nowhere.copy()
    rest[:, [5, 6, 9]] = [[0.5], [2.0], [70.0]]
    for ekf, pull in ((free, nowhere), (held, rest)):
        ekf.advance(0.01, np.zeros((5, 6)), ~ALL, jerk, pull)
    t, r = model.first_rotation, len(model.dofs) - model.first_rotation
    x, P = np.concatenate([free.x[:, t:].ravel(), free.x[2, :t]]), free.P.copy()
    for order, joint in np.argwhere(rest > 0):
        c = order * r + joint - t
        gain = P[:, c] / (P[c, c] + rest[order, joint])
        x -= gain * x[c]
        P -= np.outer(gain, P[c])
    np.testing.assert_allclose(held.x[:, t:], x[: 3 * r].reshape(3, r), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(held.P, P, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("missing", range(5))
def test_a_missing_sensor_has_no_block(missing: int) -> None:
    """Whatever stands in the row of a silent sensor, nothing of it is used."""
    model, measurement = CASES["15 dof, gravity"]
    fresh = ALL.copy()
    fresh[missing] = False
    states = []
    for rubbish in (0.0, 1e6):
        ekf = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement)
        for sample in samples_of(model, 50, 0.01):
            sample[missing] = rubbish
            ekf.advance(0.01, sample, fresh, np.zeros(15), rest_of(model))
        states.append(ekf.x.copy())
    np.testing.assert_array_equal(states[0], states[1])


def test_sensors_at_their_own_times() -> None:
    """Ten half steps with alternating sensors do about what five whole steps with all of them do."""
    model, measurement = CASES["15 dof, gravity"]
    together = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement)
    apart = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement)
    even = np.array([True, False, True, False, True])
    fine = samples_of(model, 800, 0.005, noise=0.0)
    for k, sample in enumerate(fine):
        if k % 2 == 0:
            together.advance(0.01, sample, ALL, np.zeros(15), rest_of(model))
        apart.advance(0.005, sample, even if k % 2 == 0 else ~even, np.zeros(15), rest_of(model))
    assert np.abs(together.x[0, 1:] - apart.x[0, 1:]).max() < 0.05


def test_settling_keeps_the_pose_and_forgets_the_rest() -> None:
    model, measurement = CASES["15 dof, gravity"]
    ekf = LowerBodyEkf(model, mounts(), np.zeros((5, 3)), measurement)
    for sample in samples_of(model, 50, 0.01):
        ekf.advance(0.01, sample, ALL, np.zeros(15), rest_of(model))
    pose = ekf.x[0].copy()
    ekf.settle()
    np.testing.assert_array_equal(ekf.x[0], pose)
    assert not ekf.x[1:].any()
    np.testing.assert_allclose(ekf.deviations()[0], NoiseModel().start_position_std)
    ekf.loosen([3])
    assert ekf.deviations()[0, 3] > 1.4 * NoiseModel().start_position_std


def test_dynamic_rows_need_translations() -> None:
    with pytest.raises(ValueError, match="translations"):
        LowerBodyEkf(LowerBodyModel(BODY), mounts(), np.zeros((5, 3)), MeasurementModel(accel_sees_motion=True))
