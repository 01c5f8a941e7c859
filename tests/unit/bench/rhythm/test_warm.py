"""Scores of walks that start from a known rhythm: right, wrong, late and never."""

import numpy as np
import pytest

from services.bench.rhythm.stride_shapes import StrideShapes
from services.bench.rhythm.ten_metres import walk_spec
from services.bench.rhythm.warm import COLD, OWN, score_person, warm_rows
from services.bench.rhythm.warm_scores import score_walk

PHASE = 2.0 * np.pi * np.arange(1000) / 100.0
"""Ten strides of one second at 100 Hz."""


def readings(lock_from: int, ahead: float = 0.5) -> np.ndarray:
    result = np.zeros((1000, 4))
    result[:, 0] = PHASE + ahead
    result[lock_from:, 3] = 1.0
    return result


def test_a_phase_that_is_right_from_the_lock_on():
    score = score_walk(readings(150), PHASE, 100)
    assert score.strides_to_lock == pytest.approx(0.5)
    assert (score.wrong_s, score.locked_s) == (0.0, 8.5)
    # Stride 0 is right for exactly half of its time; the last one is cut off by a sample.
    assert (score.strides, score.strides_with_phase) == (8, 7)
    assert score.reference == pytest.approx(0.5)
    assert score.early_error == pytest.approx(0.0, abs=1e-9)


def test_a_wrong_phase_is_no_lock_yet():
    wrong = readings(150)
    wrong[150:350, 0] += 1.0
    score = score_walk(wrong, PHASE, 100)
    assert score.strides_to_lock == pytest.approx(2.5)
    assert score.wrong_s == pytest.approx(2.0)


def test_never_locked_is_infinite():
    score = score_walk(readings(1000), PHASE, 100)
    assert score.strides_to_lock == np.inf
    assert (score.locked_s, score.strides_with_phase) == (0.0, 0)
    assert np.isnan(score.reference)


def test_rows_of_a_person_set_the_own_rhythm_against_the_cold_start():
    rng = np.random.default_rng(1)
    order = np.maximum(np.arange(11), 1) ** 2.0
    drawn = (rng.standard_normal((1, 4, 11)) + 1j * rng.standard_normal((1, 4, 11))) / order
    shapes = StrideShapes(np.concatenate([drawn, drawn]))
    person = score_person(7, shapes, (0, 1, 2, 3))
    assert person[OWN].walk.strides_to_lock < 1.1 < person[COLD].walk.strides_to_lock
    rows = {row.name: row for row in warm_rows("4 joints", [person], judged=True)}
    assert rows["known rhythm, 4 joints: until right and locked, median"].baseline > 1.1
    assert all(row.met is None for row in warm_rows("x", [person], judged=False))


def test_a_trial_is_a_walk_of_ten_metres_by_its_numbers():
    assert walk_spec(3, 0) == walk_spec(3, 0) != walk_spec(3, 1)
    assert "standing=4" in walk_spec(3, 0)
