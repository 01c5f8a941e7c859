"""Synthetic exercises: consistent motion, and truth that says what was done."""

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest

from schemas.vocabulary import LOWER_BODY, Segment, Side, Task
from services.ingest.errors import InvalidOption
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic import KneeParameters, SyntheticKnee, write_recording
from services.ingest.synthetic.knee_flexion import REPETITION_CHANNEL
from services.ingest.synthetic.knee_postures import DEFAULT_RANGE, Exercise
from services.ingest.units import LOCAL_GRAVITY

EVERY = list(Exercise)
TOLD = [exercise.name.lower() for exercise in EVERY]
CALM = KneeParameters(duration=40.0, jitter=0.0)


def made(exercise, **changes):
    return SyntheticKnee(dataclasses.replace(CALM, exercise=int(exercise), **changes))


def knee_of(session, time_s, side=None):
    return session.strides(time_s).posture[f"knee_flexion_{side or session.side}"]


@pytest.mark.parametrize("exercise", EVERY, ids=TOLD)
@pytest.mark.parametrize("standing", [0.0, 4.0])
def test_rates_and_accelerations_are_derivatives(exercise, standing):
    session = made(exercise, standing=standing, tremor=0.02, hesitations=0.5)
    time_s = np.arange(0.0, 14.0, 1e-3)
    for name, angle in session.gait.angles(session.strides(time_s)).items():
        for of, derivative in ((angle.value, angle.rate), (angle.rate, angle.acceleration)):
            slope = (of[2:] - of[:-2]) / 2e-3
            off = np.abs(slope - derivative[1:-1])
            # The pedals begin with a jolt.
            assert np.quantile(off, 0.999) <= 2e-3 * max(1.0, np.abs(derivative).max()), name


@pytest.mark.parametrize("exercise", EVERY, ids=TOLD)
def test_each_repetition_goes_as_far_as_asked(exercise):
    session = made(exercise)
    assert len(session.repetitions) >= 7
    for repetition in session.repetitions:
        time_s = np.linspace(repetition.start_s, repetition.end_s, 400)
        knee = knee_of(session, time_s).value
        assert np.ptp(knee) == pytest.approx(DEFAULT_RANGE[exercise], rel=0.01)
        assert abs(knee[0] - knee[-1]) < 0.01


def test_seated_thighs_are_level_and_the_pelvis_is_still():
    session = made(Exercise.SEATED_EXTENSION)
    body = session.body(np.arange(0.0, 30.0, 0.01))
    assert np.ptp(body.pelvis.position, axis=0) == pytest.approx(0.0, abs=1e-9)
    along = body.segments[Segment.THIGH_RIGHT].R_world_from_body[:, 1, 1]
    assert np.degrees(np.arccos(along)) == pytest.approx(84.3, abs=0.1)
    assert np.ptp(knee_of(session, np.arange(0.0, 30.0, 0.01), Side.LEFT).value) == 0.0


def test_heels_slide_along_the_floor():
    body = made(Exercise.HEEL_SLIDE).body(np.arange(0.0, 30.0, 0.01))
    heights = body.ankle(Side.RIGHT).position[:, 1] - body.pelvis.position[:, 1]
    assert heights == pytest.approx(0.0, abs=1e-6)
    assert np.ptp(body.ankle(Side.RIGHT).position[:, 0]) > 0.2


@pytest.mark.parametrize("exercise", [Exercise.SQUAT, Exercise.SIT_TO_STAND])
def test_feet_stay_on_the_floor_while_the_pelvis_goes_down(exercise):
    body = made(exercise).body(np.arange(0.0, 30.0, 0.01))
    assert np.ptp(body.pelvis.position[:, 1]) > 0.2
    for side in Side:
        assert np.ptp(body.ankle(side).position, axis=0) == pytest.approx(0.0, abs=1e-6)


def test_pedals_turn_half_a_cycle_apart():
    session = made(Exercise.CYCLING, tempo=60.0)
    inner = session.repetitions[2:-2]
    right = [float(knee_of(session, np.array([one.turn_s]), Side.RIGHT).value[0]) for one in inner]
    left = [float(knee_of(session, np.array([one.turn_s]), Side.LEFT).value[0]) for one in inner]
    assert right == pytest.approx([1.7] * len(inner), abs=0.02)
    assert left == pytest.approx([0.5] * len(inner), abs=0.02)


@pytest.mark.parametrize("exercise", EVERY, ids=TOLD)
def test_a_resting_sensor_feels_gravity_alone(exercise):
    session = made(exercise, gyro_noise=0.0, accel_noise=0.0, gyro_bias=0.0, accel_bias=0.0)
    block = next(iter(session.samples()))
    for track in block.sensors:
        assert track.angular_velocity[:300] == pytest.approx(0.0, abs=1e-9)
        assert np.linalg.norm(track.specific_force[:300], axis=1) == pytest.approx(LOCAL_GRAVITY, abs=1e-6)


def test_dials_do_what_they_say():
    tired = made(Exercise.SQUAT, fatigue=0.5, slowing=0.5, duration=120.0)
    reaches = [one.reach for one in tired.repetitions]
    lasting = [one.end_s - one.start_s for one in tired.repetitions]
    assert reaches[-1] < 0.6 < 0.95 < reaches[0]
    assert lasting[-1] > 1.6 * lasting[0]
    sets = made(Exercise.SQUAT, set_of=3, rest=7.0).repetitions
    pauses = [later.start_s - sooner.end_s for sooner, later in pairwise(sets)]
    assert pauses[:5] == pytest.approx([0.4, 0.4, 7.0, 0.4, 0.4])
    partial = made(Exercise.SQUAT, partials=0.4, duration=200.0).repetitions
    assert 0.2 < np.mean([one.is_partial for one in partial]) < 0.6
    assert all(one.reach < 0.5 for one in partial if one.is_partial)
    held = made(Exercise.SEATED_EXTENSION, hold=5.0, tempo=6.0)
    first = held.repetitions[0]
    around = knee_of(held, first.turn_s + np.array([-2.4, 0.0, 2.4])).value
    assert np.ptp(around) < 1e-9
    hesitant = made(Exercise.SQUAT, hesitations=1.0).repetitions
    assert all(len(one.moves) == 3 for one in hesitant)


def test_standing_comes_first_when_it_is_asked_for():
    session = made(Exercise.SEATED_EXTENSION, standing=6.0)
    body = session.body(np.arange(0.0, 15.0, 0.01))
    assert all(np.abs(angle.value[:600]).max() < 1e-12 for angle in body.angles.values())
    assert session.repetitions[0].start_s > 6.0 + CALM.rest


def test_the_source_says_what_it_is():
    source = open_source("synthetic:knee?exercise=1&seed=3&duration=20")
    description = source.describe()
    assert description.task is Task.KNEE_FLEXION
    assert [sensor.segment for sensor in description.hubs[0].sensors] == [Segment.THIGH_RIGHT, Segment.SHANK_RIGHT]
    names = [channel.name for channel in description.reference]
    assert REPETITION_CHANNEL in names
    at = names.index(REPETITION_CHANNEL)
    numbers = {
        int(row[at])
        for message in iter_messages(source)
        if hasattr(message.payload, "values")
        for row in message.payload.values
    }
    assert numbers == set(range(len(SyntheticKnee(KneeParameters(seed=3, duration=20.0)).repetitions) + 1))


def test_the_left_knee_exercises_where_the_left_leg_alone_wears_sensors():
    assert made(Exercise.SEATED_EXTENSION, worn=1).side is Side.LEFT
    assert made(Exercise.SEATED_EXTENSION, worn=0).side is Side.RIGHT


def test_it_replays_from_a_folder(tmp_path):
    write_recording(tmp_path, "exercise=3&duration=12&seed=2", motion="knee")
    description = open_source(str(tmp_path)).describe()
    assert description.task is Task.KNEE_FLEXION
    assert len(description.reference) == len(SyntheticKnee(KneeParameters()).description().reference)
    assert len(LOWER_BODY) < len(description.reference)


@pytest.mark.parametrize("options", ["exercise=0", "exercise=6", "exercise=1.5", "tempo=0", "hold=-1", "knee=1"])
def test_wrong_options_are_refused(options):
    with pytest.raises(InvalidOption):
        KneeParameters.parse(options)


@pytest.mark.parametrize("exercise", EVERY, ids=TOLD)
def test_samples_do_not_depend_on_blocks(exercise):
    session = made(exercise, duration=25.0)
    whole = session.body(np.arange(session.sample_count) / CALM.rate).angles["knee_flexion_right"].value
    at = [channel.name for channel in session.description().reference].index("knee_flexion_right")
    told = np.concatenate([block.reference.values[:, at] for block in session.samples()])
    assert told == pytest.approx(whole, abs=1e-12)
    assert math.isfinite(float(np.sum(told)))
