"""The comparison by exchanged signs."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from services.biomech.spm.paired import compare
from services.biomech.spm.sign_flips import compare_by_flips


def noise(generator: np.random.Generator, people: int) -> np.ndarray:
    return gaussian_filter1d(generator.normal(size=(people, 101)), 8.0, axis=1)


def test_a_clear_difference_has_the_least_p_there_is() -> None:
    generator = np.random.default_rng(0)
    found = compare_by_flips(noise(generator, 8) + 1.0, noise(generator, 8))
    assert found.least_p == 2 / 256
    assert found.p == found.least_p
    assert found.clusters[0].p == found.least_p
    assert found.clusters[0].positive


def test_chance_is_significant_as_often_as_said() -> None:
    generator = np.random.default_rng(1)
    p = np.array([compare_by_flips(noise(generator, 6), noise(generator, 6)).p for _ in range(400)])
    assert (p <= 0.0625).mean() == pytest.approx(0.0625, abs=0.03)
    assert (p <= 0.5).mean() == pytest.approx(0.5, abs=0.07)


def test_the_threshold_is_near_that_of_random_field_theory() -> None:
    generator = np.random.default_rng(2)
    first, second = noise(generator, 20), noise(generator, 20)
    assert compare_by_flips(first, second).threshold == pytest.approx(compare(first, second).threshold, rel=0.08)


def test_it_is_the_same_every_time_though_signs_are_drawn() -> None:
    generator = np.random.default_rng(3)
    first, second = noise(generator, 15), noise(generator, 15)
    assert compare_by_flips(first, second) == compare_by_flips(first, second)


def test_with_three_pairs_nothing_can_be_significant() -> None:
    generator = np.random.default_rng(4)
    found = compare_by_flips(noise(generator, 3) + 5.0, noise(generator, 3))
    assert found.least_p == 0.25
    assert not found.clusters
