"""Our knee from two sensors: known legs, any mounting, interruptions, and what it says of itself."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.bench.knee.legs import LegRecording, Sensors, cycling, record, seated_flexion, sit_to_stand, walking
from services.biomech.two_sensor_knee.knee_axis import Datum, KneeAxis
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

RATE_HZ = 100.0
FLEXION, STD, VALID, RATE, AXIS_STD = range(5)
MOUNTINGS = [Rotation.random(2, rng=seed).as_matrix() for seed in range(3)]


def run(leg: LegRecording, rate_hz: float = RATE_HZ, parameters: KneeAxisParameters | None = None):
    estimator = KneeAxis(parameters or KneeAxisParameters(sample_delay_s=0.0))
    return estimator.run(leg.rate, leg.force, 1.0 / rate_hz), estimator


def settled_error_deg(out, leg: LegRecording, rate_hz: float = RATE_HZ):
    assert out[-1, VALID] == 1.0
    last = slice(-int(10 * rate_hz), None)
    return np.degrees(out[last, FLEXION] - leg.flexion[last])


@pytest.mark.parametrize("rate_hz", [40.0, 100.0, 200.0])
def test_a_walk_after_standing_is_known_to_a_degree_from_the_mounting_of_nobody(rate_hz):
    leg = record(walking(), 30.0, rate_hz, Sensors(MOUNTINGS[0]))
    out, estimator = run(leg, rate_hz)
    error = settled_error_deg(out, leg, rate_hz)
    assert abs(error.mean()) < 0.5
    assert error.std() < 1.0
    assert estimator.reading().datum is Datum.STANDING
    assert estimator.reading().is_sign_known


def test_sit_to_stand_is_known_where_the_shank_rests():
    leg = record(sit_to_stand(), 30.0, RATE_HZ, Sensors(MOUNTINGS[1]))
    out, estimator = run(leg)
    error = settled_error_deg(out, leg)
    assert abs(error.mean()) < 0.5
    assert error.std() < 0.5
    assert np.degrees(np.arccos(estimator.axes[0] @ leg.axes[0])) < 1.0


def test_pedalling_has_no_standing_and_says_so():
    leg = record(cycling(), 30.0, RATE_HZ, Sensors(MOUNTINGS[2]))
    out, estimator = run(leg)
    assert settled_error_deg(out, leg).std() < 1.0
    assert estimator.reading().datum is Datum.START


def test_a_seated_leg_does_not_show_which_way_it_bends():
    leg = record(seated_flexion(), 30.0, RATE_HZ, Sensors(MOUNTINGS[0]))
    out, estimator = run(leg)
    assert not estimator.reading().is_sign_known
    assert not out[:, VALID].any()


def test_the_angle_does_not_depend_on_how_the_sensors_are_mounted():
    outs = [run(record(walking(), 20.0, RATE_HZ, Sensors(mounting)))[0] for mounting in MOUNTINGS]
    for other in outs[1:]:
        np.testing.assert_allclose(other[:, FLEXION], outs[0][:, FLEXION], atol=1e-6)
        np.testing.assert_allclose(other[:, STD], outs[0][:, STD], atol=1e-6)


def test_a_sensor_worn_upside_down_changes_nothing():
    over = np.stack([np.diag([-1.0, -1.0, 1.0]), np.eye(3)])
    upright, turned = (
        run(record(walking(), 20.0, RATE_HZ, Sensors(R)))[0] for R in (np.tile(np.eye(3), (2, 1, 1)), over)
    )
    np.testing.assert_allclose(turned[:, FLEXION], upright[:, FLEXION], atol=1e-6)


def test_noise_bias_and_soft_tissue_stay_within_the_claimed_deviation():
    bias = np.radians([[0.4, -0.3, 0.2], [-0.2, 0.3, -0.4]])
    worn = Sensors(MOUNTINGS[1], bias, rate_noise=0.003, force_noise=0.1, soft_tissue=0.03)
    leg = record(walking(), 40.0, RATE_HZ, worn, seed=5)
    out, _ = run(leg)
    error = settled_error_deg(out, leg)
    assert np.mean(np.abs(error) < 2.0 * np.degrees(out[-1000:, STD])) > 0.9
    assert np.sqrt(np.mean(error**2)) < 3.5


def test_the_rate_is_that_of_the_flexion():
    leg = record(walking(), 20.0, RATE_HZ)
    out, _ = run(leg)
    slope = np.gradient(leg.flexion) * RATE_HZ
    assert np.corrcoef(out[-800:, RATE], slope[-800:])[0, 1] > 0.999


def test_the_arms_to_the_knee_are_found():
    leg = record(walking(), 30.0, RATE_HZ)
    _, estimator = run(leg)
    in_plane = estimator.arms[:, :2]
    np.testing.assert_allclose(in_plane, [[-0.05, -0.15], [-0.03, 0.15]], atol=0.04)


def test_an_interrupted_run_goes_on_to_the_bit():
    leg = record(walking(), 12.0, RATE_HZ, Sensors(MOUNTINGS[0], rate_noise=0.003))
    whole, _ = run(leg)
    first = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    outs = [first.run(leg.rate[:777], leg.force[:777], 1.0 / RATE_HZ)]
    second = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    second.restore(json.loads(json.dumps(first.snapshot())))
    outs.append(second.run(leg.rate[777:], leg.force[777:], 1.0 / RATE_HZ))
    np.testing.assert_array_equal(np.vstack(outs), whole)


def test_one_sample_at_a_time_gives_what_the_whole_gives():
    leg = record(walking(), 9.0, RATE_HZ)
    whole, _ = run(leg)
    estimator = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    readings = [estimator.step(rate, force, 1.0 / RATE_HZ) for rate, force in zip(leg.rate, leg.force, strict=True)]
    np.testing.assert_array_equal([r.flexion for r in readings], whole[:, FLEXION])
    assert [r.is_valid for r in readings] == (whole[:, VALID] > 0.0).tolist()


def test_other_layouts_of_a_sample_are_taken_as_they_are():
    leg = record(walking(start_s=0.5), 6.0, RATE_HZ)
    one, other = KneeAxis(), KneeAxis()
    for rate, force in zip(leg.rate, leg.force, strict=True):
        expected = one.step(rate, force, 1.0 / RATE_HZ)
        told = other.step(np.asfortranarray(rate), force.astype(np.float32), 1.0 / RATE_HZ)
    assert told.flexion == pytest.approx(expected.flexion, abs=1e-3)
    assert told.is_valid is expected.is_valid


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e9])
def test_unusable_samples_are_not_valid_and_leave_no_trace(value):
    leg = record(walking(), 25.0, RATE_HZ)
    rate = leg.rate.copy()
    rate[1200:1220, 1, 2] = value
    out, _ = run(leg._replace(rate=rate))
    assert not out[1200:1220, VALID].any()
    assert np.isfinite(out).all()
    assert np.abs(settled_error_deg(out, leg)).max() < 8.0


def test_after_a_gap_both_sensors_are_levelled_anew():
    leg = record(walking(), 30.0, RATE_HZ)
    estimator = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    estimator.run(leg.rate[:1500], leg.force[:1500], 1.0 / RATE_HZ)
    before = estimator.reading().flexion_std
    reading = estimator.step(leg.rate[1700], leg.force[1700], 2.0)
    assert reading.flexion_std > 2.0 * before
    out = estimator.run(leg.rate[1701:], leg.force[1701:], 1.0 / RATE_HZ)
    assert np.abs(np.degrees(out[-500:, FLEXION] - leg.flexion[-500:])).max() < 3.0


def test_no_time_is_no_sample():
    estimator = KneeAxis()
    before = estimator.snapshot()
    estimator.step(np.ones((2, 3)), np.ones((2, 3)), 0.0)
    assert estimator.snapshot() == before


def test_a_declared_zero_stays():
    leg = record(walking(), 30.0, RATE_HZ)
    estimator = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    estimator.run(leg.rate[:1500], leg.force[:1500], 1.0 / RATE_HZ)
    estimator.declare_zero()
    out = estimator.run(leg.rate[1500:], leg.force[1500:], 1.0 / RATE_HZ)
    offset = np.degrees(out[-500:, FLEXION] - leg.flexion[-500:])
    assert offset.mean() == pytest.approx(-np.degrees(leg.flexion[1499]), abs=2.0)
    assert estimator.reading().datum is Datum.SET


def test_a_standing_of_long_ago_can_be_declared_the_zero():
    """Its verticals are told after the motion, here those of a knee that was bent by 0.2 rad."""
    leg = record(walking(), 24.0, RATE_HZ, Sensors(MOUNTINGS[1]))
    estimator = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    estimator.run(leg.rate[:2000], leg.force[:2000], 0.01)
    assert estimator.has_angle
    assert estimator.is_joint_known
    up = np.array([[0.0, 1.0, 0.0], [-np.sin(0.2), np.cos(0.2), 0.0]])
    estimator.declare_standing(np.einsum("sij,sj->si", MOUNTINGS[1], up))
    assert estimator.reading().datum is Datum.SET
    rest = estimator.run(leg.rate[2000:], leg.force[2000:], 0.01)
    assert np.degrees(np.abs(rest[:, FLEXION] + 0.2 - leg.flexion[2000:]).max()) < 2.0
    # The relative orientation turns one vertical of standing by the flexion, about the axis, into the other.
    thigh, shank = MOUNTINGS[1] @ np.array([0.0, 1.0, 0.0])
    turned = Rotation.from_rotvec((rest[-1, FLEXION] + 0.2) * estimator.axes[0]).apply(thigh)
    assert turned @ estimator.R_thigh_from_shank @ shank > np.cos(np.radians(3.0))


def test_what_was_not_seen_is_not_told():
    estimator = KneeAxis()
    estimator.declare_standing(np.eye(3)[:2])
    assert (estimator.has_angle, estimator.is_joint_known) == (False, False)
    assert estimator.reading().datum is Datum.START
    assert not estimator.standing.any()
    assert not estimator.gyro_bias.any()
    assert not estimator.R_thigh_from_shank.any()


def test_a_restored_estimator_says_the_same_of_the_last_sample():
    leg = record(walking(), 8.0, RATE_HZ, Sensors(MOUNTINGS[0]))
    _, estimator = run(leg)
    other = KneeAxis(estimator.parameters)
    other.restore(json.loads(json.dumps(estimator.snapshot())))
    assert other.reading() == estimator.reading()
    np.testing.assert_array_equal(other.up, estimator.up)


def test_the_axis_is_not_believed_before_it_was_seen():
    leg = record(walking(start_s=6.0), 20.0, RATE_HZ)
    out, _ = run(leg)
    assert not out[:600, VALID].any()
    told = out[:, AXIS_STD][out[:, AXIS_STD] > 0.0]
    assert told[0] > told[-1]


def test_an_axis_that_wanders_is_followed():
    parameters = replace(KneeAxisParameters(sample_delay_s=0.0), axis_memory_s=6.0)
    leg = record(walking(start_s=1.0), 40.0, RATE_HZ)
    turned = Rotation.from_euler("y", 15.0, degrees=True)
    rate, force = leg.rate.copy(), leg.force.copy()
    # The whole band slips round the leg half way.
    for s in range(2):
        rate[2000:, s], force[2000:, s] = turned.apply(rate[2000:, s]), turned.apply(force[2000:, s])
    _, estimator = run(leg._replace(rate=rate, force=force), parameters=parameters)
    error = np.degrees(np.arccos(abs(estimator.axes[1] @ turned.apply(leg.axes[1]))))
    assert error < 3.0


def test_a_snapshot_of_something_else_is_refused():
    state = KneeAxis().snapshot()
    state["axes"] = state["knee"]
    with pytest.raises(ValueError, match="axes"):
        KneeAxis().restore(state)
