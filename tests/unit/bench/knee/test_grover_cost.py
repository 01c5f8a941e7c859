"""The compiled forms are the library's filters; what is counted is what they do."""

import numpy as np
import pytest

from services.bench.knee.grover_cost import (
    Cost,
    noise_of,
    operations,
    over_a_session,
    run_conventional,
    run_conventional_legs,
    run_simplified,
    run_simplified_legs,
)
from services.bench.knee.grover_recorded import mean_of_intervals
from services.bench.knee.grover_scores import LITERAL, PlanarSample, motions, synthetic
from services.bench.knee.grover_scores import run_conventional as library_conventional
from services.bench.knee.grover_scores import run_simplified as library_simplified
from services.biomech.two_sensor_knee.grover import constant_part

START, NOISE = LITERAL.start_variance, noise_of(LITERAL)


@pytest.fixture(scope="module")
def samples() -> list[PlanarSample]:
    return synthetic(motions()["walking"], 2)[:1100]


def test_the_compiled_conventional_filter_is_the_librarys(samples):
    plain = np.array(samples)
    one, many = np.empty(len(plain)), np.empty((len(plain), 3))
    run_conventional(plain, START, NOISE, one)
    run_conventional_legs(plain, START, NOISE, many)
    expected = library_conventional(samples)
    assert one == pytest.approx(expected, abs=1e-9)
    assert many == pytest.approx(np.tile(expected[:, None], 3), abs=1e-9)


def test_the_compiled_simplified_filter_is_the_librarys(samples):
    plain, first = np.array(samples), LITERAL.debias_samples
    biases = constant_part(plain[:first, [0, 2]])
    one, many = np.empty(len(plain) - first), np.empty((len(plain) - first, 3))
    run_simplified(plain[first:], biases, START, NOISE, one)
    run_simplified_legs(plain[first:], biases, START, NOISE, many)
    expected = library_simplified(samples)[first:]
    assert one == pytest.approx(expected, abs=1e-9)
    assert many == pytest.approx(np.tile(expected[:, None], 3), abs=1e-9)


def test_one_state_needs_fewer_operations_than_two():
    counts = operations(LITERAL)
    # Two filters: each one division for every gain; the bias enters through its own gain.
    assert counts["simplified"]["divide"] == 2
    assert counts["conventional"]["divide"] == 4
    assert counts["conventional"]["multiply"] > 3 * counts["simplified"]["multiply"]
    assert counts["conventional"]["add"] > 2 * counts["simplified"]["add"]


def test_learning_is_paid_for_over_a_session():
    free, dear = Cost(2e-8, 1e-8, 2.0, 0.0), Cost(2e-8, 1e-8, 2.0, 1.2e-4)
    assert over_a_session(free, LITERAL) == pytest.approx(2.0 * 12000 / 11000)
    assert over_a_session(dear, LITERAL) == pytest.approx(2.4e-4 / (1.1e-4 + 1.2e-4))


@pytest.mark.parametrize("from_hz", [100.0, 50.0])
def test_means_of_longer_intervals_keep_the_integral(from_hz):
    values = np.random.default_rng(0).normal(size=(200, 2, 3))
    means = mean_of_intervals(values, from_hz, 20.0)
    assert means.shape == (int(200 * 20 / from_hz), 2, 3)
    assert means.sum(axis=0) / 20.0 == pytest.approx(values.sum(axis=0) / from_hz)
    assert mean_of_intervals(values, 20.0, 20.0) == pytest.approx(values)
