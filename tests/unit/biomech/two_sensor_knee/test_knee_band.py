"""Our band: usable at once, honest, any rate and direction."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.bench.knee.legs import Sensors, cycling, record, still, walking
from services.biomech.two_sensor_knee.knee_band import KneeBand

UP = np.tile([0.0, 1.0, 0.0], (2, 1))


def readings(band, leg, rate_hz):
    return [band.step(rate, force, 1.0 / rate_hz) for rate, force in zip(leg.rate, leg.force, strict=True)]


@pytest.mark.parametrize("rate_hz", [20.0, 50.0, 128.0])
def test_pedalling_is_known_from_the_first_second_at_any_rate_and_mounting(rate_hz):
    R = Rotation.random(2, rng=4).as_matrix()
    leg = record(cycling()._replace(lean=still(), heading=still()), 30.0, rate_hz, Sensors(R))
    band = KneeBand(leg.axes, np.einsum("nij,j->ni", R, [0.0, 1.0, 0.0]))
    told = readings(band, leg, rate_hz)
    error = np.array([r.flexion for r in told]) - leg.flexion
    assert all(r.is_valid for r in told)
    first = slice(0, int(rate_hz))
    assert np.abs(np.degrees(error[first])).max() < 2.0
    assert np.degrees(np.std(error)) < 3.0


def test_biases_are_told_while_it_runs():
    bias = np.radians([[0.0, 0.0, -0.8], [0.0, 0.0, 0.5]])
    leg = record(walking()._replace(lean=still(), heading=still()), 80.0, 50.0, Sensors(gyro_bias=bias))
    band = KneeBand(leg.axes, UP)
    readings(band, leg, 50.0)
    assert np.degrees(band.thigh.bias) == pytest.approx(0.8, abs=0.15)
    assert np.degrees(band.shank.bias) == pytest.approx(-0.5, abs=0.15)


def test_most_errors_lie_within_two_claimed_deviations():
    leg = record(walking(), 40.0, 50.0, Sensors(rate_noise=0.01, force_noise=0.1, soft_tissue=0.02))
    told = readings(KneeBand(leg.axes, UP), leg, 50.0)
    error = np.abs(np.array([r.flexion for r in told]) - leg.flexion)
    assert np.mean(error < 2.0 * np.array([r.flexion_std for r in told])) > 0.9


def test_a_lost_sample_is_not_valid_and_widens_the_deviation():
    leg = record(walking(), 5.0, 50.0)
    band = KneeBand(leg.axes, UP)
    before = readings(band, leg, 50.0)[-1]
    lost = band.step(np.full((2, 3), np.nan), leg.force[-1], 0.02)
    assert not lost.is_valid
    assert np.isfinite(lost.flexion)
    assert lost.flexion_std > before.flexion_std


def test_an_interrupted_run_goes_on_to_the_bit():
    leg = record(walking(), 6.0, 50.0)
    whole, first, second = (KneeBand(leg.axes, UP) for _ in range(3))
    expected = readings(whole, leg, 50.0)
    half = leg._replace(rate=leg.rate[:150], force=leg.force[:150])
    rest = leg._replace(rate=leg.rate[150:], force=leg.force[150:])
    told = readings(first, half, 50.0)
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert told + readings(second, rest, 50.0) == expected


def test_a_reference_along_the_axis_is_refused():
    axes = np.tile([0.0, 0.0, -1.0], (2, 1))
    with pytest.raises(ValueError, match="direction"):
        KneeBand(axes, axes)
