"""Phases of a timed up and go out of joint states that are the truth, by everything that may be worn."""

import json
import random
from functools import cache

import pytest

from schemas.tasks import TaskPhase
from schemas.vocabulary import TASK_PHASES, Task, TaskPhaseKind
from services.bench.tug.joint_tugs import joint_tug
from services.bench.tug.scores import boundaries_s, is_complete
from services.flow.message import Message
from services.segmentation.node import SegmentationNode

SLOW = "speed=0.4&seed=21&turn_time=4&turn_steps=4&rise_time=2.5"
USUAL = "speed=1.0&seed=22"
FAST = "speed=1.4&seed=23&rise_time=1.2&turn_time=1.5"
BATCH = 25
WORN = {"all": "", "left leg": "&worn=1&seated_start=1", "right leg": "&worn=2&seated_start=1", "pelvis": "&worn=3"}


@cache
def outputs(query: str) -> list:
    return through(query, joint_tug(query).messages(BATCH))


def through(query: str, messages: list[Message]) -> list:
    node = SegmentationNode(joint_tug(query).description)
    return [output for message in messages for output in node.step(message)] + node.finish()


def phases(found: list) -> list[TaskPhase]:
    return [output.payload for output in found if isinstance(output.payload, TaskPhase)]


def ended(found: list) -> dict[int, list[TaskPhase]]:
    attempts: dict[int, list[TaskPhase]] = {}
    for phase in phases(found):
        if phase.end_ns is not None:
            attempts.setdefault(phase.attempt, []).append(phase)
    return attempts


def lines(found: list) -> list[tuple[int, str]]:
    return [
        (output.captured_ns, output.payload.model_dump_json()) for output in found if output.signal.name == "task_phase"
    ]


@pytest.mark.parametrize("worn", list(WORN))
@pytest.mark.parametrize("motion", [SLOW, USUAL, FAST], ids=["slow", "usual", "fast"])
def test_every_boundary_is_found_where_it_is(motion: str, worn: str) -> None:
    query = motion + WORN[worn]
    attempts = ended(outputs(query))
    assert list(attempts) == [0]
    assert [phase.phase for phase in attempts[0]] == list(TASK_PHASES[Task.TIMED_UP_AND_GO])
    assert is_complete(attempts[0])
    truth = joint_tug(query).phases
    true_s = [truth[0].start_s, *(phase.end_s for phase in truth)]
    stds = [attempts[0][0].start_std_s, *(phase.end_std_s for phase in attempts[0])]
    for at, true, std in zip(boundaries_s(attempts[0]), true_s, stds, strict=True):
        assert abs(at - true) < 3 * std
        # A leg does not see the trunk lead the rise.
        assert abs(at - true) < 0.3 or ("leg" in worn and true == truth[0].start_s)


def test_each_phase_is_told_when_it_begins_and_again_when_it_has_ended() -> None:
    found = phases(outputs(USUAL))
    assert [(phase.phase, phase.end_ns is None) for phase in found] == [
        (kind, begins) for kind in TASK_PHASES[Task.TIMED_UP_AND_GO] for begins in (True, False)
    ]
    for begun in (phase for phase in found if phase.end_ns is None):
        over = next(phase for phase in found if phase.phase is begun.phase and phase.end_ns is not None)
        assert (begun.start_ns, begun.start_std_s) == (over.start_ns, over.start_std_s)
        assert (begun.task, begun.steps) == (Task.TIMED_UP_AND_GO, None)


def test_phases_are_told_live() -> None:
    sent = {
        (output.payload.phase, output.payload.end_ns is None): output.captured_ns
        for output in outputs(USUAL)
        if isinstance(output.payload, TaskPhase)
    }
    truth = {phase.phase: phase for phase in joint_tug(USUAL).phases}
    assert sent[TaskPhaseKind.TURN, True] * 1e-9 < truth[TaskPhaseKind.TURN].end_s
    assert sent[TaskPhaseKind.TURN_TO_SIT, False] * 1e-9 < truth[TaskPhaseKind.TURN_TO_SIT].end_s + 1.0


def test_rates_and_steps_are_those_of_the_body() -> None:
    attempt = {phase.phase: phase for phase in ended(outputs(USUAL))[0]}
    assert 2.0 < (attempt[TaskPhaseKind.TURN].largest_turn_rate or 0.0) < 4.0
    assert 1.5 < (attempt[TaskPhaseKind.SIT_TO_STAND].largest_thigh_rate or 0.0) < 3.5
    assert 3 <= (attempt[TaskPhaseKind.WALK_OUT].steps or 0) <= 8
    leg = {phase.phase: phase for phase in ended(outputs(USUAL + WORN["left leg"]))[0]}
    assert leg[TaskPhaseKind.WALK_OUT].steps is None


@pytest.mark.parametrize("worn", list(WORN))
def test_rising_without_walking_is_no_attempt(worn: str) -> None:
    assert phases(outputs("speed=1.0&seed=24&attempts=0&false_starts=3" + WORN[worn])) == []


@pytest.mark.parametrize("worn", list(WORN))
def test_an_attempt_that_ends_on_another_chair_is_closed_with_what_is_known(worn: str) -> None:
    attempts = ended(outputs("speed=1.0&seed=25&aborted=1&attempts=1" + WORN[worn]))
    assert [phase.phase for phase in attempts[0]] == [TaskPhaseKind.SIT_TO_STAND, TaskPhaseKind.WALK_OUT]
    true_s = joint_tug("speed=1.0&seed=25&aborted=1&attempts=1" + WORN[worn]).phases[1].end_s
    assert (attempts[0][1].end_ns or 0) * 1e-9 == pytest.approx(true_s, abs=0.5)
    assert is_complete(attempts[1])


def test_several_attempts_are_counted() -> None:
    attempts = ended(outputs("speed=1.2&seed=26&attempts=3"))
    assert list(attempts) == [0, 1, 2]
    assert all(is_complete(attempt) for attempt in attempts.values())


def test_a_session_that_ends_on_the_way_closes_its_phase_without_a_deviation() -> None:
    tug = joint_tug(USUAL)
    turn = tug.phases[2]
    cut = [message for message in tug.messages(5) if message.envelope.captured_ns < (turn.end_s + 0.2) * 1e9]
    last = ended(through(USUAL, cut))[0][-1]
    assert (last.phase, last.end_std_s) == (TaskPhaseKind.TURN, None)


def test_a_turn_with_lost_samples_is_less_sure() -> None:
    tug = joint_tug(USUAL)
    turn = tug.phases[2]
    lost = (turn.start_s * 1e9, (turn.start_s + 0.5) * 1e9)
    kept = [message for message in tug.messages(1) if not lost[0] < message.envelope.captured_ns < lost[1]]
    attempt, whole = ended(through(USUAL, kept))[0], ended(outputs(USUAL))[0]
    assert is_complete(attempt)
    assert attempt[2].start_std_s > whole[2].start_std_s + 0.1
    assert abs(attempt[2].start_ns * 1e-9 - turn.start_s) < 3 * attempt[2].start_std_s


def test_silence_on_the_way_gives_the_attempt_up_where_it_was_last_seen() -> None:
    tug = joint_tug(SLOW)
    out = tug.phases[1]
    lost = ((out.start_s + 3.0) * 1e9, (out.start_s + 6.5) * 1e9)
    kept = [message for message in tug.messages(1) if not lost[0] < message.envelope.captured_ns < lost[1]]
    attempts = ended(through(SLOW, kept))
    last = attempts[0][-1]
    assert (last.phase, last.end_std_s) == (TaskPhaseKind.WALK_OUT, None)
    assert last.end_ns == pytest.approx(lost[0], abs=2e7)
    assert not any(is_complete(attempt) for attempt in attempts.values())


@pytest.mark.parametrize("worn", ["all", "pelvis"])
@pytest.mark.parametrize("batch", [3, 7])
def test_batches_decide_nothing(worn: str, batch: int) -> None:
    query = FAST + WORN[worn]
    found = through(query, joint_tug(query).messages(batch))
    assert lines(found) == lines(outputs(query))


@pytest.mark.parametrize("worn", ["all", "left leg", "pelvis"])
def test_split_and_resume_is_bit_identical(worn: str) -> None:
    query = FAST + WORN[worn]
    messages = joint_tug(query).messages(BATCH)
    node = SegmentationNode(joint_tug(query).description)
    resumed = []
    at = sorted(random.Random(3).sample(range(len(messages)), 12))
    for i, message in enumerate(messages):
        if i in at:
            state = json.loads(json.dumps(node.snapshot()))
            node = SegmentationNode(joint_tug(query).description)
            node.restore(state)
        resumed += node.step(message)
    resumed += node.finish()
    assert lines(resumed) == lines(outputs(query))
    assert lines(resumed)
