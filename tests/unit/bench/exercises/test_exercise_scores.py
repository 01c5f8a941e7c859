"""How found repetitions are compared with true ones, and what is taken for true."""

import numpy as np
import pytest

from schemas.tasks import Repetition
from schemas.vocabulary import Side, Task
from services.bench.exercises import board
from services.bench.exercises.scores import Tally
from services.bench.exercises.sessions import SeenSession
from services.bench.exercises.truths import TrueRepetition, true_repetitions


def true(start_s, side=None, **changes):
    fields = {"is_partial": False, "end_s": start_s + 2.0, "reach": 1.2, "hold_s": 0.3}
    joints = {"knee_flexion_right": 1.2, "knee_flexion_left": 1.0}
    return TrueRepetition(side=side, start_s=start_s, joints=joints, **(fields | changes))


def found(start_s, side=None, valid=True, reach=1.3, **ranges):
    return Repetition(
        degree_of_freedom="squat_depth", side=side, index=0, start_ns=round(start_s * 1e9),
        turn_ns=round((start_s + 1.0) * 1e9), end_ns=round((start_s + 2.2) * 1e9), start_angle=0.0, turn_angle=reach,
        end_angle=0.1, angle_std=0.0, largest_velocity=1.0, hold_s=0.5, ranges=ranges, valid=valid,
        rejected_because=None if valid else "less than half of the usual range",
    )  # fmt: skip


def test_missed_and_invented_ones_are_counted():
    tally = Tally()
    tally.add([found(0.0), found(10.0), found(20.0, valid=False)], [true(0.0), true(5.0), true(20.0)])
    assert (tally.true, tally.missed, tally.extra) == (3, 2, 1)
    assert tally.wrong_percent == pytest.approx(100.0)


def test_one_repetition_is_not_found_twice():
    tally = Tally()
    tally.add([found(0.0)], [true(0.0), true(0.1)])
    assert (tally.missed, tally.extra) == (1, 0)


def test_a_repetition_to_the_other_side_is_another_one():
    tally = Tally()
    tally.add([found(0.0, Side.LEFT)], [true(0.0, Side.RIGHT)])
    assert (tally.missed, tally.extra) == (1, 1)


def test_errors_are_found_minus_true():
    tally = Tally()
    tally.add([found(0.1, knee_flexion_right=1.5)], [true(0.0)])
    assert tally.ranges == pytest.approx([0.1])
    assert tally.starts == pytest.approx([0.1])
    assert tally.ends == pytest.approx([0.3])
    assert tally.holds == pytest.approx([0.2])
    assert tally.knees == pytest.approx([0.3])
    assert tally.knees_asked == 2
    assert tally.symmetries == []


def test_symmetry_is_of_the_means_of_both_sides():
    tally = Tally()
    tally.add(
        [found(0.0, Side.RIGHT, reach=1.2), found(4.0, Side.LEFT, reach=0.8)],
        [true(0.0, Side.RIGHT, reach=1.0), true(4.0, Side.LEFT, reach=1.0)],
    )
    assert tally.symmetries == pytest.approx([0.5])


def test_partial_ones_are_neither_missed_nor_invented():
    tally = Tally()
    tally.add([found(0.0)], [true(0.0, is_partial=True), true(5.0, is_partial=True)])
    assert (tally.true, tally.extra, tally.partial, tally.partial_counted) == (0, 0, 2, 1)


def test_truth_is_cut_where_the_simulation_says():
    at = np.linspace(0.0, 1.0, 61)
    depth = 0.5 - 0.5 * np.cos(2 * np.pi * at)
    number = [0.0] * 10 + [1.0] * 61 + [0.0] * 5 + [-2.0] * 61 + [0.0] * 5
    knee = np.concatenate([np.zeros(10), 1.2 * depth, np.zeros(5), 0.4 * depth, np.zeros(5)])
    session = SeenSession(["repetition", "knee_flexion_right", "knee_flexion_left"])
    session._times_ns = [round(k * 1e9 / 30) for k in range(len(number))]
    session._values = [[n, k, 0.5 * k] for n, k in zip(number, knee.tolist(), strict=True)]
    first, second = true_repetitions(session, Task.SQUAT)
    assert (first.side, first.is_partial, second.is_partial) == (None, False, True)
    assert first.start_s == pytest.approx(10 / 30)
    assert first.end_s == pytest.approx(70 / 30)
    assert first.reach == pytest.approx(0.9)
    assert first.hold_s == pytest.approx(0.144 * 2, abs=0.04)
    assert first.joints == pytest.approx({"knee_flexion_right": 1.2, "knee_flexion_left": 0.6})


def test_an_unknown_part_is_refused():
    with pytest.raises(ValueError, match="jumping"):
        board.run(None, "jumping")
