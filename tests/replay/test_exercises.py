"""Tasks of the whole body on recorded people: what a Kinect saw of a squat, and an optical trunk that leans aside."""

import numpy as np
import pytest

from schemas.tasks import Repetition
from schemas.vocabulary import Side, Task
from services.bench.kinect.recordings import keraal
from services.cli.assembly import build_chain
from services.ingest.errors import MissingFile
from services.ingest.source import iter_messages, open_source
from services.segmentation.batch import COLUMNS, INDEX, Batch
from services.segmentation.exercises.body_trail import LEGS_APART
from services.segmentation.exercises.segmenter import ExerciseSegmenter


def through_chain(name: str, task: Task) -> list[Repetition]:
    source = open_source(name, task=task)
    chain = build_chain(source.describe())
    produced = [output.payload for message in iter_messages(source) for output in chain.push(message)]
    return [payload for payload in produced if isinstance(payload, Repetition)]


def test_knees_that_the_camera_guesses_are_no_squats() -> None:
    # The person is down from the first frame on, and the raw knees differ by up to 90 deg: nothing there is a squat.
    try:
        found = through_chain("kimore_squat", Task.SQUAT)
    except MissingFile as missing:
        pytest.skip(str(missing))
    assert len(found) >= 5
    assert not any(one.valid for one in found)
    assert sum(one.rejected_because == LEGS_APART for one in found) >= 5


def test_whoever_stands_and_lifts_the_arms_makes_no_squat() -> None:
    try:
        found = through_chain("kimore_arm_lift", Task.SQUAT)
    except MissingFile as missing:
        pytest.skip(str(missing))
    assert found == []


def test_a_measured_trunk_leans_to_the_left_and_then_to_the_right() -> None:
    try:
        lean = keraal().frontal
    except MissingFile as missing:
        pytest.skip(str(missing))
    position = np.zeros((len(lean), len(COLUMNS)))
    position[:, INDEX["pelvis_obliquity"]] = -lean
    velocity, n = np.gradient(position, 1 / 30, axis=0), len(lean)
    times_ns = np.round(np.arange(n) * 1e9 / 30).astype(np.int64)
    std, valid = np.full_like(position, 0.02), np.ones(len(COLUMNS), dtype=bool)
    batch = Batch(times_ns, position, velocity, np.full(n, np.nan), std, valid, frozenset())
    segmenter = ExerciseSegmenter(Task.TRUNK_TILT_FRONTAL)
    found = [output.payload for output in segmenter.take(batch) + segmenter.finish()]
    assert [one.side for one in found if one.valid] == [Side.LEFT, Side.RIGHT]
    for one, extreme in zip(found, (lean.argmin(), lean.argmax()), strict=True):
        assert one.turn_ns / 1e9 == pytest.approx(extreme / 30, abs=0.5)
        assert one.turn_angle == pytest.approx(lean[extreme], abs=0.01)


def test_no_lean_is_told_that_the_optical_trunk_did_not_make() -> None:
    # The camera saw half of the optical lean, so none has to be found; but none may be invented.
    try:
        found, lean = through_chain("keraal_torso_rotation", Task.TRUNK_TILT_FRONTAL), keraal().frontal
    except MissingFile as missing:
        pytest.skip(str(missing))
    for one in (one for one in found if one.valid):
        near = lean[max(0, round(one.turn_ns * 30 / 1e9) - 15) : round(one.turn_ns * 30 / 1e9) + 15]
        assert (near.max() > 0.1) if one.side is Side.RIGHT else (near.min() < -0.1)
