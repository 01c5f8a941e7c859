import math

import numpy as np
import pytest

from schemas.tasks import Repetition
from schemas.vocabulary import Side
from services.bench.repetitions.exercises import EXERCISES, Truth, exercise, truths
from services.bench.repetitions.scores import Tally, mean_absolute, true_phase


def found(start_s, turn_s, end_s, *, valid=True, reach=1.0):
    return Repetition(
        degree_of_freedom="knee_flexion_right", side=Side.RIGHT, index=0, start_ns=round(start_s * 1e9),
        turn_ns=round(turn_s * 1e9), end_ns=round(end_s * 1e9), start_angle=0.0, turn_angle=reach, end_angle=0.0,
        angle_std=0.0, largest_velocity=1.0, valid=valid, rejected_because=None if valid else "a reason of its own",
    )  # fmt: skip


TRUTHS = [Truth(1.0, 2.0, 3.0, 1.0, False), Truth(4.0, 5.0, 6.0, 0.4, True), Truth(7.0, 8.0, 9.0, 1.0, False)]


def test_all_found_and_none_too_many():
    tally = Tally()
    tally.add([found(1.1, 2.0, 3.0), found(4.0, 5.0, 6.0, valid=False), found(7.0, 8.1, 9.3, reach=1.2)], TRUTHS)
    assert (tally.true, tally.missed, tally.extra, tally.partial, tally.partial_counted) == (2, 0, 0, 1, 0)
    assert tally.wrong_percent == 0.0
    assert tally.right_percent == 50.0
    assert tally.range_errors == pytest.approx([0.0, 0.2])
    assert tally.start_errors == pytest.approx([0.1, 0.0])
    assert tally.end_errors == pytest.approx([0.0, 0.3])
    assert mean_absolute(tally.turn_errors) == pytest.approx(0.05)


def test_missed_doubled_and_invented_ones_are_wrong():
    tally = Tally()
    tally.add([found(1.0, 1.5, 2.0), found(2.0, 2.5, 3.0), found(4.0, 5.0, 6.0), found(10.0, 11.0, 12.0)], TRUTHS)
    assert (tally.missed, tally.extra, tally.partial_counted) == (1, 2, 1)
    assert tally.wrong_percent == 150.0


def test_nothing_at_all():
    tally = Tally()
    tally.add([], [])
    assert tally.wrong_percent == 0.0
    assert math.isnan(mean_absolute(tally.range_errors))


def test_the_true_phase_turns_once_a_repetition():
    phase = true_phase(np.array([0.0, 1.0, 4.0, 7.0, 9.0]), TRUTHS)
    assert phase == pytest.approx(2 * np.pi * np.array([0.0, 0.0, 1.0, 2.0, 3.0]))


@pytest.mark.parametrize("name", EXERCISES)
def test_truth_is_the_schedule_s(name):
    session = exercise(f"{EXERCISES[name]}&seed=5")
    for truth, repetition in zip(truths(session), session.repetitions, strict=True):
        assert repetition.start_s <= truth.start_s < truth.turn_s < truth.end_s <= repetition.end_s
        assert truth.start_s - repetition.start_s < 0.2 * (repetition.end_s - repetition.start_s)
        assert truth.reach == pytest.approx(session.reach * repetition.reach, rel=0.08)
        assert truth.is_partial == repetition.is_partial
