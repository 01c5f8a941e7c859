"""Repetitions of one knee from angles made by hand."""

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from schemas.vocabulary import Side
from services.segmentation.repetitions import knee_watch, movement_watch
from services.segmentation.repetitions.knee_watch import KneeWatch
from services.segmentation.repetitions.movement_watch import range_of
from services.segmentation.repetitions.parameters import RepetitionParameters
from services.segmentation.repetitions.trail import Sample

RATE_HZ = 100.0
SEATED, STANDING = 1.5, 0.05
UPRIGHT, LEVEL = 0.0, math.pi / 2


def held(angle, seconds):
    return np.full(round(seconds * RATE_HZ), angle)


def moved(start, end, seconds):
    """A minimum-jerk movement."""
    u = np.linspace(0.0, 1.0, round(seconds * RATE_HZ), endpoint=False)
    return start + (end - start) * u**3 * (10 - 15 * u + 6 * u**2)


def there_and_back(start, turn, seconds, *, hold_s=0.0, rest_s=1.0):
    half = seconds / 2
    return np.concatenate([moved(start, turn, half), held(turn, hold_s), moved(turn, start, half), held(start, rest_s)])


def samples(angle, thigh=None):
    thigh = np.zeros_like(angle) if thigh is None else thigh
    rate = np.gradient(angle, 1 / RATE_HZ)
    return [
        Sample(round(i * 1e9 / RATE_HZ), float(angle[i]), float(rate[i]), 0.02, float(thigh[i]))
        for i in range(len(angle))
    ]


def found_in(angle, thigh=None):
    knee = KneeWatch(Side.LEFT, RepetitionParameters())
    return [made for sample in samples(angle, thigh) for made in knee.take(sample)] + knee.finish()


def valid(repetitions):
    return [made for made in repetitions if made.valid]


@pytest.mark.parametrize(("rest", "turn"), [(SEATED, 0.1), (STANDING, 1.4)], ids=["seated extension", "squat"])
@pytest.mark.parametrize(("seconds", "hold_s", "rest_s"), [(2, 0, 1), (2, 0, 0), (4, 5, 2), (10, 0, 0), (0.7, 0, 0)])
def test_each_repetition_is_found_from_its_resting_side(rest, turn, seconds, hold_s, rest_s):
    each = there_and_back(rest, turn, seconds, hold_s=hold_s, rest_s=rest_s)
    angle = np.concatenate([held(rest, 3.0), *[each] * 6, held(rest, 3.0)])
    made = found_in(angle)
    assert [one.valid for one in made] == [True] * 6
    assert [one.index for one in made] == list(range(6))
    period_s = len(each) / RATE_HZ
    for k, one in enumerate(made):
        assert one.turn_angle == pytest.approx(turn, abs=0.01)
        assert (one.start_angle, one.end_angle) == pytest.approx((rest, rest), abs=0.03)
        starts_s = 3.0 + k * period_s
        assert one.start_ns / 1e9 == pytest.approx(starts_s, abs=0.1 * seconds)
        assert one.turn_ns / 1e9 == pytest.approx(starts_s + seconds / 2 + hold_s / 2, abs=0.03)
        assert one.end_ns / 1e9 == pytest.approx(starts_s + seconds + hold_s, abs=0.1 * seconds)
        assert one.largest_velocity == pytest.approx(1.875 * abs(turn - rest) / (seconds / 2), rel=0.02)
        assert one.angle_std == pytest.approx(0.02)


@pytest.mark.parametrize("hz", [0.1, 0.5, 1.0, 1.5])
@pytest.mark.parametrize("tremor_hz", [4.0, 5.0, 6.0])
def test_tremor_and_noise_add_none_and_hide_none(hz, tremor_hz):
    time_s = np.arange(0.0, 6.0 + 8 / hz, 1 / RATE_HZ)
    moving = (time_s > 3.0) & (time_s < 3.0 + 8 / hz)
    clean = 0.1 + np.where(moving, 0.6 * (1 - np.cos(2 * np.pi * hz * (time_s - 3.0))), 0.0)
    rng = np.random.default_rng(3)
    angle = clean + 0.05 * np.sin(2 * np.pi * tremor_hz * time_s) + 0.01 * rng.standard_normal(len(time_s))
    assert [one.valid for one in found_in(angle)] == [True] * 8


@pytest.mark.parametrize("level", [SEATED, STANDING])
def test_a_resting_knee_makes_none(level):
    rng = np.random.default_rng(1)
    time_s = np.arange(0.0, 120.0, 1 / RATE_HZ)
    drift = 0.3 * time_s / time_s[-1]
    angle = level + drift + 0.05 * np.sin(2 * np.pi * 5 * time_s) + 0.02 * rng.standard_normal(len(time_s))
    assert found_in(angle) == []


def test_a_partial_repetition_is_told_and_does_not_count():
    whole, part = there_and_back(SEATED, 0.1, 2.0), there_and_back(SEATED, 1.0, 2.0)
    made = found_in(np.concatenate([held(SEATED, 2.0), *[whole] * 4, part, whole]))
    assert [one.rejected_because for one in made] == [None] * 4 + [movement_watch.PARTIAL, None]


def test_a_hesitation_is_part_of_its_repetition():
    hesitating = np.concatenate(
        [moved(SEATED, 0.8, 1.0), held(0.8, 0.6), moved(0.8, 1.0, 0.5), moved(1.0, 0.1, 1.0), moved(0.1, SEATED, 1.0)]
    )
    whole = there_and_back(SEATED, 0.1, 2.0)
    made = found_in(np.concatenate([held(SEATED, 2.0), *[whole] * 3, hesitating, held(SEATED, 1.0), whole]))
    assert [one.valid for one in made] == [True] * 5


def test_what_is_left_of_a_partial_one_that_stopped_half_way_is_none():
    whole = there_and_back(SEATED, 0.2, 2.0)
    stops = np.concatenate([moved(SEATED, 1.3, 1.0), held(1.3, 1.0), moved(1.3, 1.1, 1.0), moved(1.1, SEATED, 1.0)])
    made = found_in(np.concatenate([held(SEATED, 2.0), *[whole] * 3, stops, held(SEATED, 3.0), *[whole] * 2]))
    assert all(one.start_angle > one.turn_angle for one in made)
    assert len(valid(made)) == 5


def test_another_exercise_may_rest_on_the_other_side():
    extension, squat = there_and_back(SEATED, STANDING, 2.0), there_and_back(STANDING, SEATED, 2.0)
    angle = np.concatenate(
        [held(SEATED, 2.0), *[extension] * 3, moved(SEATED, STANDING, 1.0), held(STANDING, 16.0), *[squat] * 3]
    )
    assert [one.valid for one in found_in(angle)] == [True] * 3 + [False] + [True] * 3


def test_a_repetition_that_began_half_way_does_not_count():
    whole = there_and_back(STANDING, 1.5, 2.0, rest_s=0.0)
    made = found_in(np.concatenate([held(0.8, 1.0), moved(0.8, 1.5, 1.0), moved(1.5, STANDING, 1.0), *[whole] * 3]))
    assert [one.rejected_because for one in made] == [movement_watch.ENDS_APART, None, None, None]


def test_missing_samples_close_a_repetition():
    whole = there_and_back(SEATED, 0.1, 2.0)
    fed = samples(np.concatenate([held(SEATED, 2.0), *[whole] * 4]))
    knee = KneeWatch(Side.LEFT, RepetitionParameters())
    # Cut out from the middle of the second way back.
    made = [one for sample in fed[:650] for one in knee.take(sample)]
    made += knee.interrupt(movement_watch.MISSING)
    made += [one for sample in fed[690:] for one in knee.take(sample)] + knee.finish()
    assert [one.rejected_because for one in made] == [None, movement_watch.MISSING, None, None]
    assert all(one.start_angle > one.turn_angle for one in made)


def test_a_new_zero_is_no_movement():
    whole = there_and_back(SEATED, 0.1, 2.0)
    fed = samples(np.concatenate([held(SEATED, 2.0), *[whole] * 6]))
    # At rest after the second, and on the way out of the fourth.
    fed = [one._replace(angle=one.angle - 0.3 * (i >= 750) + 0.25 * (i >= 1150)) for i, one in enumerate(fed)]
    knee = KneeWatch(Side.LEFT, RepetitionParameters())
    made = [one for sample in fed for one in knee.take(sample)] + knee.finish()
    halves = [movement_watch.SET_ANEW, movement_watch.ENDS_APART]
    assert [one.rejected_because for one in made] == [None, None, None, *halves, None, None]


def test_sitting_down_changes_the_resting_side():
    each = there_and_back(SEATED, STANDING, 2.0, hold_s=3.0)
    knees = np.concatenate([held(STANDING, 4.0), moved(STANDING, SEATED, 2.0), held(SEATED, 3.0), *[each] * 5])
    thighs = np.concatenate([held(UPRIGHT, 4.0), moved(UPRIGHT, LEVEL, 2.0), held(LEVEL, (len(knees) - 600) / RATE_HZ)])
    made = found_in(knees, thighs)
    assert [one.rejected_because for one in made] == ["the person sat down or stood up"] + [None] * 5
    assert all(one.start_angle > one.turn_angle for one in valid(made))


def test_a_seated_knee_first_seen_in_a_hold_still_rests_bent():
    each = there_and_back(SEATED, STANDING, 2.0, hold_s=5.0, rest_s=2.0)
    knees = np.concatenate([held(STANDING, 3.0), moved(STANDING, SEATED, 1.0), held(SEATED, 2.0), *[each] * 4])
    made = found_in(knees, held(LEVEL, len(knees) / RATE_HZ))
    assert [one.rejected_because for one in made] == [movement_watch.ENDS_APART] + [None] * 4
    assert all(one.start_angle > one.turn_angle for one in valid(made))


@pytest.mark.parametrize("most", [SEATED, 0.6])
def test_a_heel_slides_out_from_an_extended_knee(most):
    knees = np.concatenate([held(STANDING, 3.0), *[there_and_back(STANDING, most, 3.0, hold_s=3.0)] * 4])
    thighs = LEVEL + 0.5 * (knees - STANDING)
    made = found_in(knees, thighs)
    assert [one.valid for one in made] == [True] * 4
    assert all(one.start_angle < one.turn_angle for one in made)


def test_whoever_sits_down_first_stands_up_from_the_chair():
    knees = np.concatenate(
        [held(STANDING, 5.0), moved(STANDING, SEATED, 2.0), held(SEATED, 5.0)]
        + [there_and_back(SEATED, STANDING, 3.0, rest_s=0.4)] * 5
    )
    made = found_in(knees, LEVEL * (knees - STANDING) / (SEATED - STANDING))
    assert [one.rejected_because for one in made] == ["the person sat down or stood up"] + [None] * 5
    assert all(one.start_angle > one.turn_angle for one in valid(made))


def test_sit_to_stand_is_a_repetition():
    knees = np.concatenate([held(SEATED, 3.0), *[there_and_back(SEATED, STANDING, 3.0, hold_s=2.0)] * 5])
    thighs = LEVEL * (knees - STANDING) / (SEATED - STANDING)
    assert [one.valid for one in found_in(knees, thighs)] == [True] * 5


def test_a_new_resting_position_is_none():
    made = found_in(np.concatenate([held(STANDING, 3.0), moved(STANDING, SEATED, 1.0), held(SEATED, 20.0)]))
    assert [one.rejected_because for one in made] == ["the knee came to rest elsewhere"]


def test_steps_are_none():
    phase = 2 * np.pi * np.arange(0.0, 12.0, 1 / RATE_HZ)
    # The knee is most flexed at 73 % of a stride, the thigh furthest forward at 93 %.
    knee = np.concatenate([held(0.1, 2.0), 0.1 + 0.5 * (1 + np.cos(phase - np.pi))])
    thigh = np.concatenate([held(0.0, 2.0), 0.1 + 0.35 * np.cos(phase - np.pi - 2 * np.pi * 0.2)])
    made = found_in(knee, thigh)
    assert len(made) >= 10
    assert valid(made) == []


def test_the_end_of_the_session_is_told():
    whole = there_and_back(SEATED, 0.1, 2.0)
    angle = np.concatenate([held(SEATED, 2.0), *[whole] * 2])
    assert [one.valid for one in found_in(angle[:-80])] == [True, True]
    assert [one.rejected_because for one in found_in(angle[:-190])] == [None, knee_watch.ENDED]


@settings(max_examples=25, deadline=None)
@given(
    ranges=st.lists(st.floats(0.9, 1.3), min_size=3, max_size=8),
    seconds=st.floats(0.8, 6.0),
    rest_s=st.sampled_from([0.0, 0.3, 2.0]),
    flexing=st.booleans(),
    seed=st.integers(0, 1000),
)
def test_counted_are_those_that_were_made(ranges, seconds, rest_s, flexing, seed):
    home, sign = (STANDING, 1) if flexing else (SEATED, -1)
    parts = [there_and_back(home, home + sign * way, seconds, rest_s=rest_s) for way in ranges]
    angle = np.concatenate([held(home, 2.0), *parts, held(home, 1.5)])
    angle += 0.01 * np.random.default_rng(seed).standard_normal(len(angle))
    made = found_in(angle)
    assert [one.valid for one in made] == [True] * len(ranges)
    assert [range_of(one) for one in made] == pytest.approx(ranges, abs=0.08)
    times = [ns for one in made for ns in (one.start_ns, one.turn_ns, one.end_ns)]
    assert times == sorted(times)


@settings(max_examples=40, deadline=None)
@given(steps=st.lists(st.floats(-0.3, 0.3), min_size=2, max_size=120), gap=st.integers(0, 100))
def test_any_course_gives_sound_repetitions(steps, gap):
    angle = np.repeat(np.cumsum(steps), 7)
    knee = KneeWatch(Side.RIGHT, RepetitionParameters())
    made = []
    for i, sample in enumerate(samples(angle)):
        made += knee.interrupt(movement_watch.MISSING) if gap and i % (7 * gap) == 0 else []
        made += knee.take(sample)
    made += knee.finish()
    assert [one.index for one in made] == list(range(len(made)))
    for one in made:
        assert one.start_ns <= one.turn_ns <= one.end_ns
        assert one.valid == (one.rejected_because is None)
        assert all(map(math.isfinite, (one.start_angle, one.turn_angle, one.end_angle, one.largest_velocity)))


@pytest.mark.parametrize("cut", [1, 150, 260, 333, 480, 700])
def test_split_and_resume(cut):
    angle = np.concatenate([held(SEATED, 1.5), *[there_and_back(SEATED, 0.1, 1.7, rest_s=0.4)] * 3])
    fed = samples(angle + 0.01 * np.random.default_rng(2).standard_normal(len(angle)))
    whole = KneeWatch(Side.LEFT, RepetitionParameters())
    expected = [one for sample in fed for one in whole.take(sample)] + whole.finish()
    first, second = (KneeWatch(Side.LEFT, RepetitionParameters()) for _ in range(2))
    made = [one for sample in fed[:cut] for one in first.take(sample)]
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    assert second.snapshot() == first.snapshot()
    assert made + [one for sample in fed[cut:] for one in second.take(sample)] + second.finish() == expected
    assert len(expected) == 3


def test_the_state_stays_small():
    knee = KneeWatch(Side.LEFT, RepetitionParameters())
    sizes = []
    for sample in samples(np.concatenate([held(SEATED, 2.0), *[there_and_back(SEATED, 0.1, 2.0)] * 40])):
        knee.take(sample)
        sizes.append(len(knee.snapshot()["trail"]["captured_ns"]))
    assert max(sizes) < 5 * RATE_HZ
