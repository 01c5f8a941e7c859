import numpy as np
import pytest

from services.progress.estimates import Estimate
from services.progress.trend import trend


def estimates(values, half):
    return [Estimate(value, value - half, value + half) for value in values]


def test_a_line_is_found_and_weighted():
    days = [0.0, 14.0, 28.0, 42.0]
    found = trend(days, estimates([0.5 + 0.002 * day for day in days], 0.02))
    assert found.slope_per_day == pytest.approx(0.002)
    values = [*estimates([0.5, 0.5, 0.5], 0.001), *estimates([0.9], 0.5)]
    assert abs(trend(days, values).slope_per_day) < 1e-4


def test_the_interval_holds_the_slope_as_often_as_it_says():
    rng = np.random.default_rng(1)
    days, inside = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0], 0
    for _ in range(400):
        values = 0.5 + 0.001 * np.array(days) + rng.normal(0, 0.01, 6)
        found = trend(days, estimates(values, 0.0196))
        inside += found.low <= 0.001 <= found.high
    assert inside >= 0.95 * 400


def test_scatter_beyond_the_intervals_widens_it():
    days = [0.0, 14.0, 28.0, 42.0]
    calm, wild = trend(days, estimates([0.5] * 4, 0.01)), trend(days, estimates([0.4, 0.6, 0.4, 0.6], 0.01))
    assert wild.high - wild.low > 5 * (calm.high - calm.low)


def test_two_visits_or_one_day_have_no_slope():
    assert trend([0.0, 14.0], estimates([0.5, 0.6], 0.01)) is None
    assert trend([3.0, 3.0, 3.0], estimates([0.5, 0.6, 0.7], 0.01)) is None
    assert trend([0.0, 1.0, 2.0], estimates([0.5, 0.5, 0.5], 0.0)).slope_per_day == 0.0
