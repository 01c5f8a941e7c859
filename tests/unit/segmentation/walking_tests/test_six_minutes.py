"""Walks, turns and rests of a walk for time."""

from itertools import pairwise

import pytest

from schemas.vocabulary import Task, TaskPhaseKind
from services.bench.walking_tests.joint_corridors import joint_corridor
from services.bench.walking_tests.six_minutes import turns_in_time, unmatched
from tests.unit.segmentation.walking_tests.walks import ended, interleaved, lines, outputs, phases, resumed, through

SHORT = "six_minutes?corridor=9&duration=60&rests=1&rate=50&seed=31"
OTHER = "ten_metres?trials=1&rate=50&seed=32"


def spans(found: list, kind: TaskPhaseKind) -> list[tuple[float, float]]:
    return [(each.start_ns * 1e-9, each.end_ns * 1e-9) for each in ended(found) if each.phase is kind]


def test_turns_and_rests_are_those_that_were_made() -> None:
    truth, found = joint_corridor(SHORT).truth, outputs(SHORT)
    assert unmatched(turns_in_time(truth), spans(found, TaskPhaseKind.TURN)) == (0, 0)
    assert unmatched(list(truth.rests), spans(found, TaskPhaseKind.REST)) == (0, 0)
    [(begun, over)], [(true_begun, true_over)] = spans(found, TaskPhaseKind.REST), truth.rests
    assert (begun, over) == pytest.approx((true_begun, true_over), abs=0.6)


def test_phases_follow_each_other_and_the_time_ends_the_last() -> None:
    truth, found = joint_corridor(SHORT).truth, ended(outputs(SHORT))
    for one, after in pairwise(found):
        assert one.end_ns == after.start_ns
        assert (one.task, one.attempt) == (Task.SIX_MINUTE_WALK, 0)
    assert found[0].start_ns * 1e-9 == pytest.approx(truth.start_s, abs=0.3)
    assert (found[-1].end_ns - found[0].start_ns) == 60 * 10**9
    assert found[-1].end_std_s is not None


def test_the_steps_add_up_to_the_distance() -> None:
    truth, found = joint_corridor(SHORT).truth, ended(outputs(SHORT))
    assert sum(phase.distance_m for phase in found) == pytest.approx(truth.distance_m, rel=0.06)
    walks = [phase for phase in found if phase.phase is TaskPhaseKind.WALK]
    assert all(phase.steps is not None for phase in found)
    assert all(0 < phase.distance_std_m < 0.2 * phase.distance_m for phase in walks if phase.distance_m > 2)


def test_each_phase_is_told_when_it_begins_and_again_when_it_has_ended() -> None:
    told = phases(outputs(SHORT))
    # One ends where the next begins, so both are told at once.
    assert [phase.end_ns is None for phase in told] == [True, False] * (len(told) // 2)
    assert [one.start_ns for one in told[::2]] == [one.start_ns for one in told[1::2]]
    assert all(phase.distance_m is None for phase in told if phase.end_ns is None)


def test_a_session_that_ends_before_the_time_closes_its_phase_without_a_deviation() -> None:
    cut = [each for each in joint_corridor(SHORT).messages() if each.envelope.captured_ns < 30e9]
    last = ended(through(SHORT, cut))[-1]
    assert last.end_std_s is None
    assert last.end_ns * 1e-9 == pytest.approx(30.0, abs=0.6)


def test_time_without_samples_is_no_rest() -> None:
    truth = joint_corridor(SHORT).truth
    from_s = truth.turns[0][1] + 1.0
    kept = [
        each
        for each in joint_corridor(SHORT).messages(1)
        if not from_s * 1e9 < each.envelope.captured_ns < (from_s + 3.0) * 1e9
    ]
    found = through(SHORT, kept)
    assert len(spans(found, TaskPhaseKind.REST)) == 1
    lost = sum(phase.distance_m for phase in ended(found))
    assert lost == pytest.approx(truth.distance_m, rel=0.1)


def test_batches_decide_nothing() -> None:
    found = through(SHORT, joint_corridor(SHORT).messages(11))
    assert lines(found) == lines(outputs(SHORT))


def test_split_and_resume_is_bit_identical() -> None:
    assert lines(resumed(SHORT)) == lines(outputs(SHORT))


def test_two_sessions_at_once_are_each_as_if_alone() -> None:
    one, other = interleaved(SHORT, OTHER)
    assert lines(one) == lines(outputs(SHORT))
    assert lines(other) == lines(outputs(OTHER))
