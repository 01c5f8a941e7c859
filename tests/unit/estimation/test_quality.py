"""What a session tells of its own data: counted by captured time, so that batching and restarts decide nothing."""

import json
from dataclasses import replace

import numpy as np
import pytest

from schemas.imu import SensorSamples
from schemas.quality import DataQuality
from schemas.signals import IMU, SKELETON
from schemas.vocabulary import Segment
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.node import build
from services.estimation.parameters import EstimationParameters, QualityParameters
from services.ingest.source import iter_messages, open_source
from tests.unit.estimation.estimation_walks import describe, messages, run, text, walk

EVERY_TWO = replace(EstimationParameters(), quality=QualityParameters(period_s=2.0))
NOTHING = SensorSamples(captured_ns=[], angular_velocity=[], specific_force=[])


def told(outputs) -> list[DataQuality]:
    return [output.payload for output in outputs if isinstance(output.payload, DataQuality)]


def node(description) -> LowerBodyNode:
    return LowerBodyNode(description, EVERY_TWO)


@pytest.fixture(scope="module")
def undisturbed():
    description = describe()
    return run(node(description), messages(description, walk()[1]))


def test_a_whole_session_is_told_now_and_then_and_at_its_end(undisturbed):
    qualities = told(undisturbed)
    # The last sample before each 2 s, and the last of all.
    assert [round(each.captured_ns * 1e-9, 2) for each in qualities] == [1.99, 3.99, 5.99, 7.99, 8.99]
    assert not qualities[0].calibrated
    assert qualities[0].spanned_s == 0.0
    last = qualities[-1]
    assert last.calibrated
    assert last.absolute
    assert (last.late, [source.rejected for source in last.sources]) == (0, [0] * 5)
    assert [(source.expected, source.used) for source in last.sources] == [(900, 900)] * 5
    assert all(source.longest_silence_s == pytest.approx(0.01) for source in last.sources)
    assert last.estimated_s == last.spanned_s
    # Two seconds of standing stand before the walk.
    assert last.spanned_s - 2.5 < last.moving_s < last.spanned_s - 1.0
    assert 0 <= last.locked_s <= last.moving_s


@pytest.mark.parametrize("ticks", [7, 90, 900])
def test_how_samples_were_batched_decides_nothing(undisturbed, ticks):
    description = describe()
    samples = walk()[1][: 900 // ticks * ticks]
    whole = run(node(description), messages(description, samples)) if len(samples) < 900 else undisturbed
    found = run(node(description), messages(description, samples, ticks=ticks))
    assert told(found) == told(whole)


@pytest.mark.parametrize("cut", [100, 399, 400, 777])
def test_split_and_resume(undisturbed, cut):
    description = describe()
    stream = messages(description, walk()[1])
    first, second = node(description), node(description)
    outputs = [output for message in stream[:cut] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert text([*outputs, *run(second, stream[cut:])]) == text(undisturbed)


def test_a_silent_sensor_shows_beside_those_that_speak():
    """The left shank is lost from 5 s on, and stays lost."""
    samples = walk()[1].copy()
    description = describe()
    stream = messages(description, samples)
    place = [sensor.segment for sensor in description.hubs[0].sensors].index(Segment.SHANK_LEFT)
    for message in stream[500:]:
        message.payload.sensors[place] = NOTHING
    last = told(run(node(description), stream))[-1]
    by_name = {source.name: source for source in last.sources}
    assert by_name["shank_left"].used == 500
    assert by_name["shank_left"].expected == 900
    assert by_name["shank_left"].longest_silence_s == pytest.approx(4.0)
    assert by_name["shank_right"].used == 900
    assert last.estimated_s == pytest.approx(last.spanned_s - 4.0, abs=0.3)


def test_refused_samples_are_counted_where_they_were_refused():
    samples = walk()[1].copy()
    samples[300:310, 2, 0] = np.nan
    description = describe()
    by_one, by_many = (told(run(node(description), messages(description, samples, ticks=ticks))) for ticks in (1, 50))
    assert by_one == by_many
    assert [each.sources[2].rejected for each in by_one] == [0, 10, 10, 10, 10]
    assert by_one[-1].sources[2].used == 890


def test_what_never_spoke_was_silent_all_the_time():
    description = describe()
    stream = messages(description, walk()[1])
    for message in stream:
        message.payload.sensors[0] = NOTHING
    source = told(run(node(description), stream))[-1].sources[0]
    assert (source.expected, source.used) == (0, 0)
    assert source.longest_silence_s == pytest.approx(8.99)


def test_a_session_without_a_sample_ends_with_nothing():
    [last] = told(node(describe()).finish())
    assert last.captured_ns == 0
    assert all((source.expected, source.used) == (0, 0) for source in last.sources)


@pytest.mark.parametrize("estimator", ["knee_axis", "body_cekf", "fusion"])
def test_every_estimator_tells_it(estimator):
    source = open_source("synthetic:walk?camera=1&duration=14&seed=7", estimator=estimator)
    stream = [m for m in iter_messages(source, 1) if m.payload is not None and m.stream.signal in (IMU, SKELETON)]
    played = build(source.describe())
    names = set(played.streams)
    stream = [message for message in stream if message.stream in names]
    first, second = build(source.describe()), build(source.describe())
    outputs = [output for message in stream[:500] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot())))
    resumed = [*outputs, *run(second, stream[500:])]
    qualities = told(resumed)
    assert qualities == told(run(played, stream))
    assert [each.captured_ns // 5_000_000_000 for each in qualities[:2]] == [0, 1]
    assert all(each.used > 0.97 * each.expected for each in qualities[-1].sources)
    assert 0 < qualities[-1].estimated_s <= qualities[-1].spanned_s
