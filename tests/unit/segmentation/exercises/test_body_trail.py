"""Ranges and what is no exercise, from rows made by hand."""

import json

import numpy as np
import pytest

from schemas.vocabulary import JointCentre, Side, Task
from services.segmentation.batch import COLUMNS, INDEX, Batch, Centres
from services.segmentation.exercises.body_trail import LEGS_APART, NOT_STANDING, WALKED, BodyTrail, arm_elevation
from services.segmentation.exercises.parameters import ExerciseParameters

CENTRE = {centre: i for i, centre in enumerate(JointCentre)}


def centres_of(n, seen=True, **positions):
    """Upright and still, arms hanging; the named centres elsewhere."""
    position = np.zeros((n, 15, 3))
    position[:, CENTRE["spine_mid"], 1] = 0.3
    for name in ("spine_shoulder", "shoulder_left", "shoulder_right"):
        position[:, CENTRE[name], 1] = 0.5
    for name in ("elbow_left", "elbow_right"):
        position[:, CENTRE[name], 1] = 0.2
    for name, where in positions.items():
        position[:, CENTRE[name]] = where
    return Centres(position, np.full(15, seen))


def batch_of(n=30, valid=None, centres=None, first=0, **angles):
    position = np.zeros((n, len(COLUMNS)))
    for name, values in angles.items():
        position[:, INDEX[name]] = values
    flags = np.ones(len(COLUMNS), dtype=bool) if valid is None else valid
    times = (first + np.arange(n)) * 1_000
    return Batch(times, position, np.zeros_like(position), np.full(n, np.nan), position, flags, frozenset(), centres)


def trail(task=Task.SQUAT):
    return BodyTrail(task, ExerciseParameters())


def test_ranges_are_of_what_was_seen_all_the_time():
    body = trail()
    unseen = np.ones(len(COLUMNS), dtype=bool)
    unseen[INDEX["trunk_flexion"]] = False
    body.append(batch_of(hip_flexion_left=np.linspace(0, 1, 30)))
    body.append(batch_of(first=30, valid=unseen, hip_flexion_left=np.linspace(1, 0.5, 30)))
    ranges = body.ranges(10_000, 50_000)
    assert ranges["hip_flexion_left"] == pytest.approx(1 - 10 / 29, abs=1e-6)
    assert "trunk_flexion" not in ranges
    assert "trunk_flexion" in body.ranges(0, 29_000)
    assert "arm_elevation_left" not in ranges
    assert body.ranges(100_000, 200_000) == {}


def test_arms_are_told_by_the_centres():
    aside = centres_of(2, elbow_right=np.array([[0, 0.2, 0], [0, 0.5, 0.3]]))
    np.testing.assert_allclose(arm_elevation(aside, Side.RIGHT), [0, np.pi / 2])
    np.testing.assert_allclose(arm_elevation(aside, Side.LEFT), 0)
    body = trail()
    body.append(batch_of(n=2, centres=aside))
    assert body.ranges(0, 2_000)["arm_elevation_right"] == pytest.approx(np.pi / 2, abs=1e-6)
    aside.seen[CENTRE["elbow_right"]] = False
    unseen = trail()
    unseen.append(batch_of(n=2, centres=aside))
    assert "arm_elevation_right" not in unseen.ranges(0, 2_000)
    assert "arm_elevation_left" in unseen.ranges(0, 2_000)


def test_whoever_walks_away_makes_no_repetition():
    body = trail(Task.STEPPING)
    way = np.zeros((30, 3))
    way[:, 0] = np.linspace(0, 0.6, 30)
    body.append(batch_of(centres=centres_of(30, spine_base=way)))
    assert body.flaw(0, 29_000, 0.8) == WALKED
    assert body.flaw(0, 10_000, 0.8) is None


def test_legs_that_part_make_no_squat():
    body = trail()
    beat = np.sin(np.linspace(0, 6, 30))
    body.append(batch_of(knee_flexion_left=0.5 + 0.5 * beat, knee_flexion_right=0.5 - 0.5 * beat))
    assert body.flaw(0, 29_000, 0.3) == LEGS_APART
    spared = trail()
    spared.append(batch_of(knee_flexion_left=1.0 * abs(beat), knee_flexion_right=1.6 * abs(beat)))
    assert spared.flaw(0, 29_000, 1.3) is None


def test_split_and_resume_and_forgetting():
    first, second = trail(), trail()
    lost = np.ones(len(COLUMNS), dtype=bool)
    lost[3] = False
    first.append(batch_of(valid=lost, centres=centres_of(30, seen=False)))
    first.append(batch_of(first=30, centres=centres_of(30)))
    first.forget_before(12_000)
    state = json.dumps(first.snapshot(), allow_nan=False)
    second.restore(json.loads(state))
    assert json.dumps(second.snapshot()) == state
    assert second.ranges(31_000, 50_000) == first.ranges(31_000, 50_000)
    assert second.ranges(0, 50_000) == first.ranges(12_000, 50_000)


def test_who_is_already_down_makes_no_squat():
    bounce = np.sin(np.linspace(0, np.pi, 30))
    down = trail()
    down.append(batch_of(knee_flexion_left=1.2 + 0.4 * bounce, knee_flexion_right=1.2 + 0.4 * bounce))
    assert down.flaw(0, 29_000, 0.4) == NOT_STANDING
    crouched = trail()
    crouched.append(batch_of(knee_flexion_left=0.5 + bounce, knee_flexion_right=0.5 + bounce))
    assert crouched.flaw(0, 29_000, 1.0) is None
