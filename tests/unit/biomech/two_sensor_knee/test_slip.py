"""A sensor that slips on the leg: noticed, not valid until the axis is found again, and no false alarm."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.bench.knee.legs import LegRecording, Sensors, cycling, record, sit_to_stand, walking
from services.biomech.two_sensor_knee.knee_axis import Datum, KneeAxis
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

RATE_HZ = 100.0
FLEXION, _, VALID = range(3)
WORN = Sensors(gyro_bias=np.radians([[0.4, -0.3, 0.2], [-0.2, 0.3, -0.4]]), rate_noise=0.003, force_noise=0.1)
ROUND_THE_LEG, SIDEWAYS, ABOUT_THE_KNEE = (
    np.array([0.0, 1.0, 0.0]),
    np.array([1.0, 0.0, 0.0]),
    np.array([0.0, 0.0, 1.0]),
)
THIGH, SHANK = 0, 1
SLIP_S = 20.0
PART = 10
"""Samples between two looks at the count of slips."""


def slipped(leg: LegRecording, sensor: int, axis, degrees: float, lasting_s: float = 1.5) -> LegRecording:
    """The same with one sensor turned on its segment about an axis of its own, from SLIP_S on."""
    share = np.clip((np.arange(len(leg.rate)) / RATE_HZ - SLIP_S) / lasting_s, 0.0, 1.0)
    angle = np.radians(degrees) * share**2 * (3.0 - 2.0 * share)
    back = Rotation.from_rotvec(-angle[:, None] * axis)
    rate, force = leg.rate.copy(), leg.force.copy()
    rate[:, sensor] = back.apply(rate[:, sensor]) + np.gradient(angle)[:, None] * RATE_HZ * axis
    force[:, sensor] = back.apply(force[:, sensor])
    return leg._replace(rate=rate, force=force)


def run(leg: LegRecording) -> tuple[np.ndarray, np.ndarray, KneeAxis]:
    """Outputs, slips so far at each sample, and the estimator."""
    estimator = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    outs, slips = [], []
    for first in range(0, len(leg.rate), PART):
        part = slice(first, first + PART)
        outs.append(estimator.run(leg.rate[part], leg.force[part], 1.0 / RATE_HZ))
        slips += [estimator.slips] * len(outs[-1])
    return np.vstack(outs), np.array(slips), estimator


@pytest.mark.parametrize("sensor", [THIGH, SHANK])
@pytest.mark.parametrize(("axis", "degrees"), [(ROUND_THE_LEG, 40.0), (SIDEWAYS, 25.0)])
def test_an_axis_that_jumped_is_found_again(sensor, axis, degrees):
    leg = slipped(record(walking(), 40.0, RATE_HZ, WORN, seed=1), sensor, axis, degrees)
    out, slips, estimator = run(leg)
    assert slips[-1] == 1
    noticed = int(np.argmax(slips)) + PART
    assert noticed < (SLIP_S + 6.0) * RATE_HZ
    again = noticed + int(np.argmax(out[noticed:, VALID] > 0.0))
    assert not out[noticed:again, VALID].any()
    assert 2.0 < (again - noticed) / RATE_HZ < 9.0
    assert np.degrees(np.std(out[-700:, FLEXION] - leg.flexion[-700:])) < 1.5
    assert estimator.reading().is_sign_known
    assert estimator.reading().datum is Datum.START


@pytest.mark.parametrize("sensor", [THIGH, SHANK])
def test_a_slip_about_the_flexion_axis_is_told_by_the_arm(sensor):
    leg = slipped(record(walking(), 62.0, RATE_HZ, WORN, seed=2), sensor, ABOUT_THE_KNEE, 35.0)
    _, slips, estimator = run(leg)
    assert slips[-1] == 1
    assert estimator.reading().datum is Datum.START


def test_a_sensor_that_is_put_on_anew_keeps_no_sense():
    """Upside down and turned: whatever was known of its axis is of no use, and only posture tells its sense."""
    leg = record(walking(), 50.0, RATE_HZ, WORN, seed=3)
    leg = slipped(leg, THIGH, ROUND_THE_LEG, 120.0)
    out, slips, _ = run(leg)
    assert slips[-1] >= 1
    assert out[-1, VALID] == 0.0 or np.corrcoef(out[-700:, FLEXION], leg.flexion[-700:])[0, 1] > 0.99


@pytest.mark.parametrize("motion", [walking(), cycling(), sit_to_stand()])
@pytest.mark.parametrize("soft_tissue", [0.0, 0.05])
def test_no_slip_is_seen_where_there_is_none(motion, soft_tissue):
    worn = Sensors(gyro_bias=WORN.gyro_bias, rate_noise=0.003, force_noise=0.1, soft_tissue=soft_tissue)
    leg = record(motion, 60.0, RATE_HZ, worn, seed=4)
    estimator = KneeAxis()
    estimator.run(leg.rate, leg.force, 1.0 / RATE_HZ)
    assert estimator.slips == 0


@pytest.mark.parametrize("gap_s", [1.0, 4.0])
def test_levelling_anew_after_a_gap_is_no_slip(gap_s):
    draw = np.random.default_rng(2)
    worn = Sensors(Rotation.random(2, rng=2).as_matrix(), np.radians(draw.uniform(-0.5, 0.5, (2, 3))), 0.003, 0.1, 0.03)
    leg = record(walking(), 50.0, RATE_HZ, worn, seed=2)
    estimator = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    estimator.run(leg.rate[:3000], leg.force[:3000], 1.0 / RATE_HZ)
    back = 3000 + int(gap_s * RATE_HZ)
    estimator.step(leg.rate[back], leg.force[back], gap_s)
    out = estimator.run(leg.rate[back + 1 :], leg.force[back + 1 :], 1.0 / RATE_HZ)
    assert estimator.slips == 0
    assert np.degrees(np.std(out[-700:, FLEXION] - leg.flexion[-700:])) < 2.0


def test_a_slow_slide_round_the_leg_is_followed():
    leg = slipped(record(walking(), 60.0, RATE_HZ, WORN, seed=5), SHANK, ROUND_THE_LEG, 30.0, lasting_s=35.0)
    out, _, _ = run(leg)
    valid = out[:, VALID] > 0.0
    error = np.degrees(out[:, FLEXION] - leg.flexion)
    assert valid[-1]
    assert error[-700:].std() < 3.0


def test_a_slip_survives_an_interruption():
    leg = slipped(record(walking(), 26.0, RATE_HZ, WORN, seed=6), SHANK, SIDEWAYS, 40.0)
    whole, _, estimator = run(leg)
    first = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    first.run(leg.rate[:2250], leg.force[:2250], 1.0 / RATE_HZ)
    second = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    second.restore(json.loads(json.dumps(first.snapshot())))
    rest = second.run(leg.rate[2250:], leg.force[2250:], 1.0 / RATE_HZ)
    np.testing.assert_array_equal(rest, whole[2250:])
    assert second.slips == estimator.slips == 1
