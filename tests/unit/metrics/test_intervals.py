import math

import numpy as np
import pytest
from scipy import stats

from services.metrics.intervals import of_mean, of_ratio, of_spread, student_t


def test_student_t_against_a_table():
    """Two-sided 95 %: 12.706 with one degree of freedom, 2.776 with four, 1.984 with a hundred."""
    assert student_t(1) == pytest.approx(12.706, abs=1e-3)
    assert student_t(4) == pytest.approx(2.776, abs=1e-3)
    assert student_t(100) == pytest.approx(1.984, abs=1e-3)
    assert student_t(0.2) == student_t(1)


def test_the_mean_of_few_strides_lies_within_as_often_as_said():
    rng = np.random.default_rng(1)
    for strides in (3, 5, 12):
        drawn = rng.normal(0.6, 0.05, (4000, strides))
        hits = [
            low <= 0.6 <= high
            for row in drawn
            for low, high in [of_mean(row.mean(), row.std(ddof=1) / math.sqrt(strides), strides - 1)]
        ]
        assert np.mean(hits) == pytest.approx(0.95, abs=0.012)


def test_what_all_strides_share_no_number_of_them_averages_out():
    rng = np.random.default_rng(2)
    hits = []
    for _ in range(3000):
        drawn = 0.6 + rng.normal(0.0, 0.02) + rng.normal(0.0, 0.01, 60)
        low, high = of_mean(drawn.mean(), drawn.std(ddof=1) / math.sqrt(60), 59, shared_std=0.02)
        hits.append(low <= 0.6 <= high)
    assert np.mean(hits) == pytest.approx(0.95, abs=0.012)


def test_a_standard_deviation_lies_within_as_often_as_said():
    rng = np.random.default_rng(3)
    drawn = rng.normal(0.0, 1.0, (4000, 12)).std(axis=1, ddof=1)
    hits = [low <= 1.0 <= high for low, high in (of_spread(spread, 11) for spread in drawn)]
    assert np.mean(hits) == pytest.approx(0.95, abs=0.012)
    low, high = of_spread(1.0, 11)
    assert low == pytest.approx(math.sqrt(11 / stats.chi2.ppf(0.975, 11)))
    assert high == pytest.approx(math.sqrt(11 / stats.chi2.ppf(0.025, 11)))


def test_noise_of_measuring_may_be_all_there_is():
    low, high = of_spread(0.02, 11, noise_std=0.02)
    assert low == 0.0
    assert high == of_spread(0.02, 11).high


def test_a_ratio_that_is_folded_begins_at_one():
    assert of_ratio(1.5, 0.1, folded=True) == pytest.approx((1.5 * math.exp(-0.1), 1.5 * math.exp(0.1)))
    assert of_ratio(1.02, 0.1, folded=True) == pytest.approx((1.0, 1.02 * math.exp(0.1)))
    # As far as it may be below one, the other side may be the larger.
    assert of_ratio(1.02, 0.1, folded=False) == pytest.approx((1.02 * math.exp(-0.1), 1.02 * math.exp(0.1)))
    assert of_ratio(1.0, 0.2, folded=True).high == pytest.approx(math.exp(0.2))
