"""Exercises through the chain: counts, faults, splits."""

import json

import numpy as np
import pytest

from schemas.metrics import SessionMetrics
from schemas.tasks import Repetition
from schemas.vocabulary import LOWER_BODY
from services.bench.gait.joint_walks import JointTrack
from services.bench.repetitions.exercises import exercise, truths
from services.cli.assembly import build_chain
from services.ingest.source import iter_messages, open_source
from services.segmentation.node import build

SPEC = "exercise=1&tempo=20&duration=30&seed=4"
DOFS = [dof.name for dof in LOWER_BODY]


def track_of(session, keep=None):
    time_s = np.arange(session.sample_count) / session.parameters.rate
    angles = session.gait.angles(session.strides(time_s))
    position = np.column_stack([angles[name].value for name in DOFS])
    velocity = np.column_stack([angles[name].rate for name in DOFS])
    keep = np.ones(len(time_s), dtype=bool) if keep is None else keep(time_s)
    return JointTrack(time_s[keep], position[keep], velocity[keep], np.full(int(keep.sum()), np.nan))


def outputs_of(node, messages):
    return [output for message in messages for output in node.step(message)] + node.finish()


def plain(outputs):
    return [(output.signal.name, output.captured_ns, output.payload.model_dump_json()) for output in outputs]


def repetitions(outputs):
    return [output.payload for output in outputs if isinstance(output.payload, Repetition)]


@pytest.fixture(scope="module")
def session():
    return exercise(SPEC)


@pytest.fixture(scope="module")
def expected(session):
    return plain(outputs_of(build(session.description()), track_of(session).messages()))


def test_each_is_found_once(session):
    found = repetitions(outputs_of(build(session.description()), track_of(session).messages()))
    right = [one for one in found if one.side is session.side]
    assert len(found) == len(right) == len(truths(session))
    for one, truth in zip(right, truths(session), strict=True):
        assert one.valid
        assert one.start_ns / 1e9 == pytest.approx(truth.start_s, abs=0.05)
        assert one.end_ns / 1e9 == pytest.approx(truth.end_s, abs=0.05)


@pytest.mark.parametrize("ticks", [1, 2, 7, 50])
def test_batches_do_not_matter(ticks, session, expected):
    assert plain(outputs_of(build(session.description()), track_of(session).messages(ticks))) == expected


@pytest.mark.parametrize("cut", [1, 260, 401, 700])
def test_split_and_resume(cut, session, expected):
    messages = track_of(session).messages()
    first, second = build(session.description()), build(session.description())
    outputs = [output for message in messages[:cut] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    assert second.snapshot() == first.snapshot()
    assert plain(outputs + outputs_of(second, messages[cut:])) == expected


def test_a_gap_rejects_its_repetition_alone(session):
    true = truths(session)
    lost = lambda time_s: (time_s < true[3].turn_s - 0.2) | (time_s > true[3].turn_s + 0.2)  # noqa: E731
    found = repetitions(outputs_of(build(session.description()), track_of(session, lost).messages()))
    assert [one.valid for one in found if one.end_ns / 1e9 < true[3].start_s] == [True] * 3
    assert "samples are missing" in [one.rejected_because for one in found]
    after = [one for one in found if one.start_ns / 1e9 > true[3].end_s - 0.2]
    assert [one.valid for one in after] == [True] * (len(true) - 4)


def test_short_losses_cost_nothing(session):
    rng = np.random.default_rng(0)
    found = repetitions(
        outputs_of(build(session.description()), track_of(session, lambda t: rng.uniform(size=len(t)) > 0.2).messages())
    )
    assert [one.valid for one in found] == [True] * len(truths(session))


def test_a_knee_that_is_not_valid_has_none(session):
    valid = tuple(name != f"knee_flexion_{session.side}" for name in DOFS)
    found = repetitions(outputs_of(build(session.description()), track_of(session).messages(valid=valid)))
    assert [one for one in found if one.side is session.side] == []


def test_no_other_task_has_any(session):
    description = session.description().model_copy(update={"task": "walk"})
    assert repetitions(outputs_of(build(description), track_of(session).messages())) == []


def test_two_sensors_are_enough_for_the_whole_chain():
    options = "exercise=1&tempo=20&duration=30&seed=4&rate=50"
    source = open_source(f"synthetic:knee?{options}")
    chain = build_chain(source.describe())
    produced = [made.payload for message in iter_messages(source) for made in chain.push(message)]
    counted = [made for made in produced if isinstance(made, Repetition) and made.valid]
    reports = [made for made in produced if isinstance(made, SessionMetrics)]
    assert len(counted) == len(truths(exercise(options)))
    assert [report.final for report in reports] == [False] * len(counted) + [True]
    assert reports[-1].repetitions == counted
    numbers = {(metric.name, metric.side): metric.value for metric in reports[-1].metrics}
    assert numbers["repetitions_counted", "right"] == len(counted)
    assert numbers["repetition_range", "right"] == pytest.approx(1.35, abs=0.1)
    assert ("repetitions_counted", "left") not in numbers
