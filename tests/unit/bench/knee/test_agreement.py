"""Errors and limits of agreement of known differences."""

import numpy as np
import pytest

from services.bench.knee.agreement import bland_altman, errors, unwrapped_error


def test_a_constant_offset_is_absolute_error_only():
    truth = np.linspace(0.0, 60.0, 100)
    result = errors(truth + 5.0, truth)
    assert result.absolute_rmse == pytest.approx(5.0)
    assert result.zero_mean_rmse == pytest.approx(0.0, abs=1e-12)
    assert result.bias == pytest.approx(5.0)
    assert result.samples == 100


def test_unknown_samples_are_left_out():
    truth = np.array([0.0, np.nan, 2.0, 3.0])
    assert errors(np.array([1.0, 1.0, np.nan, 5.0]), truth) == pytest.approx((np.sqrt(2.5), 0.5, 1.5, 2))
    with pytest.raises(ValueError, match="no sample"):
        errors(np.full(4, np.nan), truth)


def test_limits_hold_95_percent_of_normal_differences():
    draw = np.random.default_rng(0)
    truth = draw.uniform(0.0, 60.0, 20000)
    result = bland_altman(1.1 * truth - 2.0 + draw.normal(0.0, 0.5, 20000), truth)
    assert result.slope == pytest.approx(1.1, abs=1e-3)
    assert result.intercept == pytest.approx(-2.0, abs=0.05)
    assert result.bias == pytest.approx(1.0, abs=0.05)
    assert result.r_squared > 0.998
    assert result.bias_p < 1e-6
    plain = bland_altman(truth + draw.normal(1.0, 2.0, 20000), truth)
    assert (plain.lower_limit, plain.upper_limit) == pytest.approx((1.0 - 3.92, 1.0 + 3.92), abs=0.1)


def test_a_bias_within_its_scatter_is_none():
    draw = np.random.default_rng(1)
    truth, noise = draw.uniform(0.0, 60.0, 400), draw.normal(0.0, 2.0, 400)
    assert bland_altman(truth + noise - noise.mean(), truth).bias_p == pytest.approx(1.0)
    assert bland_altman(truth, truth).bias_p == 1.0
    assert bland_altman(truth + 1.0, truth).bias_p < 1e-6


@pytest.mark.parametrize("truth", [[1.0, 2.0], [3.0, 3.0, 3.0]])
def test_agreement_needs_a_truth_that_varies(truth):
    with pytest.raises(ValueError, match="three samples"):
        bland_altman(np.array(truth), np.array(truth))


def test_an_error_over_the_half_turn_is_small():
    assert unwrapped_error(np.array([np.pi - 0.1]), np.array([-np.pi + 0.1])) == pytest.approx([-0.2])
