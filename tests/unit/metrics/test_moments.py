import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.metrics.moments import Moments


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=60))
def test_equal_to_two_passes(values):
    moments = Moments.empty()
    for value in values:
        moments.add(value)
    assert moments.count == len(values)
    assert float(moments.mean) == pytest.approx(np.mean(values), rel=1e-9, abs=1e-6)
    assert float(moments.spread()) == pytest.approx(np.std(values, ddof=1), rel=1e-6, abs=1e-4)


def test_a_small_spread_on_a_large_mean_survives():
    moments = Moments.empty()
    for value in (1e9, 1e9 + 1, 1e9 + 2):
        moments.add(value)
    assert float(moments.spread()) == pytest.approx(1.0)


def test_curves_point_by_point():
    curves = np.random.default_rng(0).normal(size=(12, 101))
    moments = Moments.empty(101)
    for curve in curves:
        moments.add(curve)
    np.testing.assert_allclose(moments.mean, curves.mean(axis=0), atol=1e-12)
    np.testing.assert_allclose(moments.spread(), curves.std(axis=0, ddof=1), atol=1e-12)


def test_one_value_has_no_spread():
    moments = Moments.empty()
    assert moments.spread() is None
    moments.add(1.0)
    assert moments.spread() is None


@pytest.mark.parametrize("shape", [(), (101,)])
def test_snapshot_to_the_bit(shape):
    moments = Moments.empty(*shape)
    for value in (0.1, 0.2, 0.7):
        moments.add(np.full(shape, value))
    resumed = Moments.restored(json.loads(json.dumps(moments.snapshot())))
    moments.add(np.full(shape, 0.3))
    resumed.add(np.full(shape, 0.3))
    np.testing.assert_array_equal(resumed.mean, moments.mean)
    np.testing.assert_array_equal(resumed.squares, moments.squares)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(-1e6, 1e6), max_size=30), st.lists(st.floats(-1e6, 1e6), max_size=30))
def test_two_sets_merged_are_one_set(first, second):
    parts = Moments.empty(), Moments.empty()
    for values, moments in zip((first, second), parts, strict=True):
        for value in values:
            moments.add(value)
    merged = parts[0].merged(parts[1])
    assert (parts[0].count, parts[1].count, merged.count) == (len(first), len(second), len(first) + len(second))
    if merged.count:
        assert float(merged.mean) == pytest.approx(np.mean(first + second), rel=1e-9, abs=1e-6)
        assert float(merged.squares) == pytest.approx(np.var(first + second) * merged.count, rel=1e-6, abs=1e-2)
