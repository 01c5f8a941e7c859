"""What a person's upright is, from leans made by hand."""

import json

import pytest

from services.segmentation.exercises.parameters import ExerciseParameters
from services.segmentation.exercises.upright import Upright


def stand(upright, lean, *, from_s, seconds):
    for i in range(round(seconds * 30)):
        upright.take(round((from_s + i / 30) * 1e9), lean)


def test_the_first_rest_is_upright_where_it_is_near_the_vertical():
    upright = Upright(ExerciseParameters())
    stand(upright, 0.5, from_s=0, seconds=3)
    assert upright.lean == 0.0
    stand(upright, 0.12, from_s=3, seconds=3)
    assert upright.lean == pytest.approx(0.12)


def test_a_held_lean_is_no_upright():
    upright = Upright(ExerciseParameters())
    stand(upright, 0.03, from_s=0, seconds=3)
    stand(upright, 0.25, from_s=3, seconds=15)
    assert upright.lean == pytest.approx(0.03)


def test_it_follows_a_person_who_comes_to_rest_a_little_aside():
    upright = Upright(ExerciseParameters())
    for k, lean in enumerate((0.0, 0.05, 0.06, 0.05, 0.06)):
        stand(upright, lean, from_s=10 * k, seconds=3)
        stand(upright, 0.3, from_s=10 * k + 3, seconds=0.2)
    assert upright.lean == pytest.approx(0.05)


def test_small_held_leans_do_not_drag_it_along():
    upright = Upright(ExerciseParameters())
    for k in range(30):
        stand(upright, min(0.02 * k, 0.3), from_s=10 * k, seconds=3)
        stand(upright, -0.3, from_s=10 * k + 3, seconds=0.2)
    assert upright.lean <= 0.06


def test_moving_and_short_rests_tell_nothing():
    upright = Upright(ExerciseParameters())
    for i in range(300):
        upright.take(round(i / 30 * 1e9), 0.1 * (i % 30) / 30)
    stand(upright, 0.05, from_s=10, seconds=1.0)
    assert upright.lean == 0.0


def test_a_rest_does_not_go_on_over_a_gap():
    upright = Upright(ExerciseParameters())
    stand(upright, 0.1, from_s=0, seconds=1.0)
    upright.interrupt()
    stand(upright, 0.1, from_s=60, seconds=1.0)
    assert upright.lean == 0.0


def test_split_and_resume():
    whole, first, second = (Upright(ExerciseParameters()) for _ in range(3))
    stand(whole, 0.06, from_s=0, seconds=2)
    stand(first, 0.06, from_s=0, seconds=1)
    second.restore(json.loads(json.dumps(first.snapshot())))
    stand(second, 0.06, from_s=1, seconds=1)
    assert second.snapshot() == whole.snapshot()
