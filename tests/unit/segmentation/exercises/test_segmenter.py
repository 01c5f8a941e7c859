"""Repetitions of squats, steps and tilts from angles made by hand, at 30 Hz."""

import numpy as np
import pytest

from schemas.tasks import Repetition
from schemas.vocabulary import Side, Task
from services.segmentation.batch import COLUMNS, INDEX, Batch
from services.segmentation.exercises import segmenter
from services.segmentation.exercises.segmenter import ExerciseSegmenter
from services.segmentation.repetitions.movement_watch import PARTIAL, range_of

RATE_HZ = 30.0


def still(seconds):
    return np.zeros(round(seconds * RATE_HZ))


def bump(seconds, hold_s=0.0):
    """0 to 1 and back, held in between; zero speed at both ends."""
    half = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, round(seconds / 2 * RATE_HZ)))
    return np.concatenate([half, np.ones(round(hold_s * RATE_HZ)), half[::-1]])


def repeated(each, times, *, standing_s=2.0, pause_s=0.5):
    return np.concatenate([still(standing_s), *[np.concatenate([each, still(pause_s)])] * times, still(standing_s)])


def batches(angles, rows=1, valid=None, missing=()):
    """Of arrays (n,) by name; `valid` (n,) tells in which samples all of it is."""
    n = len(next(iter(angles.values())))
    position = np.zeros((n, len(COLUMNS)))
    for name, values in angles.items():
        position[:, INDEX[name]] = values
    velocity = np.gradient(position, 1 / RATE_HZ, axis=0)
    kept = [i for i in range(n) if i not in set(missing)]
    for start in range(0, len(kept), rows):
        at = kept[start : start + rows]
        flags = np.full(len(COLUMNS), True if valid is None else bool(valid[at[0]]))
        yield Batch(
            np.array([round(i * 1e9 / RATE_HZ) for i in at]), position[at], velocity[at], np.full(len(at), np.nan),
            np.full((len(at), len(COLUMNS)), 0.02), flags, frozenset(),
        )  # fmt: skip


def found_in(task, angles, **how) -> list[Repetition]:
    made = ExerciseSegmenter(task)
    outputs = [output for batch in batches(angles, **how) for output in made.take(batch)] + made.finish()
    return [output.payload for output in outputs]


def squat(depth, share_left=1.0):
    return {
        "knee_flexion_right": 0.1 + depth,
        "knee_flexion_left": 0.1 + share_left * depth,
        "hip_flexion_right": 0.8 * depth,
        "hip_flexion_left": 0.8 * depth,
    }


def aside(lean):
    return {"pelvis_obliquity": -lean}


@pytest.mark.parametrize(("seconds", "hold_s"), [(2, 0), (1.2, 0), (10, 0), (3, 5), (3, 15)])
def test_squats_are_counted_and_measured(seconds, hold_s):
    made = found_in(Task.SQUAT, squat(1.4 * repeated(bump(seconds, hold_s), 5)))
    assert [one.rejected_because for one in made] == [None] * 5
    period_s = seconds + hold_s + 0.5
    for k, one in enumerate(made):
        assert (one.degree_of_freedom, one.side, one.index) == ("squat_depth", None, k)
        assert one.turn_ns / 1e9 == pytest.approx(2 + k * period_s + (seconds + hold_s) / 2, abs=0.07)
        assert range_of(one) == pytest.approx(1.4, abs=0.02)
        # Within 5 % of the range a raised cosine stays for 0.144 of its period.
        assert one.hold_s == pytest.approx(hold_s + 0.144 * seconds, abs=0.12)
        assert one.ranges["knee_flexion_left"] == pytest.approx(1.4, abs=0.02)
        assert one.ranges["hip_flexion_right"] == pytest.approx(1.12, abs=0.02)
        assert one.largest_velocity == pytest.approx(1.4 * np.pi / seconds, rel=0.05)


def test_a_spared_leg_shows_in_the_ranges():
    made = found_in(Task.SQUAT, squat(1.2 * repeated(bump(2.5), 4), share_left=0.6))
    assert [one.valid for one in made] == [True] * 4
    for one in made:
        assert one.ranges["knee_flexion_left"] / one.ranges["knee_flexion_right"] == pytest.approx(0.6, abs=0.01)


def test_partial_ones_do_not_count():
    depth = 1.4 * np.concatenate([repeated(bump(2), 3), 0.4 * repeated(bump(2), 1), repeated(bump(2), 2)])
    made = found_in(Task.SQUAT, squat(depth))
    assert [one.rejected_because for one in made] == [None, None, None, PARTIAL, None, None]


def test_steps_of_each_leg_are_its_own():
    right, left = repeated(bump(0.7), 8, pause_s=0.9), repeated(bump(0.7), 8, standing_s=2.8, pause_s=0.9)[: 30 * 17]
    n = min(len(right), len(left))
    made = found_in(Task.STEPPING, {"hip_flexion_right": 0.8 * right[:n], "hip_flexion_left": 0.6 * left[:n]})
    for side, reach in ((Side.RIGHT, 0.8), (Side.LEFT, 0.6)):
        own = [one for one in made if one.side is side]
        assert [one.valid for one in own] == [True] * 8
        assert {one.degree_of_freedom for one in own} == {f"hip_flexion_{side}"}
        assert [one.index for one in own] == list(range(8))
        assert np.mean([range_of(one) for one in own]) == pytest.approx(reach, abs=0.02)


@pytest.mark.parametrize("upright", [0.0, 0.08, -0.1])
@pytest.mark.parametrize("pause_s", [0.0, 1.0])
def test_leans_to_both_sides_are_repetitions_of_their_own(upright, pause_s):
    sway = np.concatenate([bump(2.0), -0.7 * bump(2.0)])
    lean = upright + 0.3 * repeated(sway, 4, pause_s=pause_s)
    made = found_in(Task.TRUNK_TILT_FRONTAL, aside(lean))
    assert [one.side for one in made] == [Side.RIGHT, Side.LEFT] * 4
    assert {one.degree_of_freedom for one in made} == {"trunk_lean_right"}
    assert all(one.valid for one in made)
    for one in made:
        out = 0.3 if one.side is Side.RIGHT else -0.21
        assert one.turn_angle == pytest.approx(upright + out, abs=0.01)
        assert range_of(one) == pytest.approx(abs(out), abs=0.04)


@pytest.mark.parametrize("hold_s", [0.0, 15.0])
def test_bows_are_counted(hold_s):
    bow = 0.9 * repeated(bump(3.4, hold_s), 3)
    made = found_in(Task.TRUNK_TILT_SAGITTAL, {"pelvis_tilt": 0.6 * bow, "trunk_flexion": 0.4 * bow})
    assert [(one.valid, one.side) for one in made] == [(True, None)] * 3
    assert {one.degree_of_freedom for one in made} == {"trunk_lean_forward"}


@pytest.mark.parametrize("task", [Task.SQUAT, Task.TRUNK_TILT_SAGITTAL, Task.TRUNK_TILT_FRONTAL])
def test_noise_and_a_camera_that_drops_frames_add_none_and_hide_none(task):
    rng = np.random.default_rng(4)
    move = repeated(bump(2.8), 6)
    angles = squat(1.3 * move) | {"pelvis_tilt": 0.8 * move, "pelvis_obliquity": -0.25 * move}
    keep = np.exp(-1 / (RATE_HZ * 0.5))
    for name in ("knee_flexion_right", "knee_flexion_left", "pelvis_tilt", "pelvis_obliquity"):
        noise = np.zeros(len(move))
        for i in range(1, len(move)):
            noise[i] = keep * noise[i - 1] + np.sqrt(1 - keep**2) * rng.normal(0, 0.025)
        angles[name] = angles[name] + noise
    missing = np.flatnonzero(rng.random(len(move)) < 0.05)
    made = found_in(task, angles, missing=missing.tolist())
    assert sum(one.valid for one in made) == 6
    assert len(made) == 6


def test_tremor_is_no_repetition():
    time_s = np.arange(0, 30, 1 / RATE_HZ)
    for hz in (4.0, 5.0, 6.0):
        depth = np.concatenate([still(2), 1.3 * bump(3, 10), still(15)])
        depth = depth + 0.06 * np.sin(2 * np.pi * hz * time_s[: len(depth)])
        assert [one.valid for one in found_in(Task.SQUAT, squat(depth))] == [True]


def test_an_angle_that_is_not_valid_for_a_moment_is_followed():
    depth = 1.3 * repeated(bump(2.5), 4)
    valid = np.ones(len(depth), dtype=bool)
    valid[::11] = valid[::13] = False
    valid[round(6.0 * RATE_HZ) : round(6.8 * RATE_HZ)] = False
    made = found_in(Task.SQUAT, squat(depth), valid=valid)
    assert [one.valid for one in made] == [True] * 4


def test_out_of_view_in_the_middle_of_a_squat_rejects_it_alone():
    depth = 1.3 * repeated(bump(2.5), 4)
    valid = np.ones(len(depth), dtype=bool)
    valid[round(5.5 * RATE_HZ) : round(7.0 * RATE_HZ)] = False
    made = found_in(Task.SQUAT, squat(depth), valid=valid)
    assert next(one.rejected_because for one in made if not one.valid) == segmenter.UNSEEN
    assert sum(one.valid for one in made) == 3


def test_missing_samples_in_the_middle_of_a_squat_reject_it():
    depth = 1.3 * repeated(bump(2.5), 4)
    made = found_in(Task.SQUAT, squat(depth), missing=range(round(6.0 * RATE_HZ), round(6.8 * RATE_HZ)))
    assert next(one.rejected_because for one in made if not one.valid) == segmenter.MISSING
    assert sum(one.valid for one in made) == 3


def test_a_squat_that_never_ends_does_not_count():
    depth = 1.3 * np.concatenate([still(2), bump(2, 2)[: round(2 * RATE_HZ)]])
    assert [one.rejected_because for one in found_in(Task.SQUAT, squat(depth))] == [segmenter.ENDED]


def test_walking_to_the_place_is_no_squat():
    time_s = np.arange(0, 12, 1 / RATE_HZ)
    swing = np.maximum(np.sin(2 * np.pi * time_s), 0)
    other = np.maximum(-np.sin(2 * np.pi * time_s), 0)
    made = found_in(Task.SQUAT, {"knee_flexion_right": 1.0 * swing, "knee_flexion_left": 1.0 * other})
    assert not any(one.valid for one in made)


def test_how_samples_were_batched_decides_nothing():
    sway = 0.3 * repeated(np.concatenate([bump(2.0), -bump(1.7)]), 3)
    one, many = (found_in(Task.TRUNK_TILT_FRONTAL, aside(sway), rows=rows) for rows in (1, 9))
    assert [each.model_dump() for each in one] == [each.model_dump() for each in many]
    assert len(one) == 6


def test_coming_back_to_a_lean_again_and_again_is_no_rest_there():
    sway = np.concatenate([bump(2.2), -bump(2.2)])
    angle = 0.3 * np.concatenate([*[sway] * 8, still(2)])
    made = found_in(Task.TRUNK_TILT_FRONTAL, aside(angle))
    assert [one.side for one in made] == [Side.RIGHT, Side.LEFT] * 8
    assert all(one.valid and abs(one.start_angle) < 0.05 and abs(one.end_angle) < 0.05 for one in made)
