"""Run-up, timed zone and run-out of each length of a walkway."""

import pytest

from schemas.vocabulary import TASK_PHASES, Task, TaskPhaseKind
from services.bench.walking_tests.joint_corridors import joint_corridor
from tests.unit.segmentation.walking_tests.walks import ended, lines, outputs, phases, resumed, through

TWICE = "ten_metres?trials=2&rate=50&pause=6&seed=33"
ON = "ten_metres?trials=2&start=1&rate=50&seed=34"
WHOLE = "ten_metres?trials=1&zone_from=0&zone_to=10&rate=50&seed=35"


def newest(found: list) -> dict[tuple[int, TaskPhaseKind], object]:
    return {(phase.attempt, phase.phase): phase for phase in phases(found)}


def zones(found: list) -> list:
    return [phase for (_, kind), phase in newest(found).items() if kind is TaskPhaseKind.TIMED_ZONE and phase.end_std_s]


@pytest.mark.parametrize("what", [TWICE, ON], ids=["from standing", "turning at the ends"])
def test_the_lines_are_crossed_when_the_toes_cross_them(what: str) -> None:
    truth, found = joint_corridor(what).truth, zones(outputs(what))
    assert len(found) == len(truth.trials)
    for zone, trial in zip(found, truth.trials, strict=True):
        assert abs(zone.start_ns * 1e-9 - trial.enters_s) < max(3 * zone.start_std_s, 0.3)
        assert abs(zone.end_ns * 1e-9 - trial.leaves_s) < max(3 * zone.end_std_s, 0.3)
        assert (zone.distance_m, zone.distance_std_m) == (6.0, 0.0)
        assert zone.steps in (8, 9, 10, 11)


def test_a_trial_has_its_phases_in_order_and_the_last_word_fits_the_walkway() -> None:
    told = newest(outputs(TWICE))
    for attempt in (0, 1):
        parts = [told[attempt, kind] for kind in TASK_PHASES[Task.TEN_METRE_WALK]]
        assert [one.end_ns for one in parts[:2]] == [after.start_ns for after in parts[1:]]
        assert sum(part.distance_m for part in parts) == pytest.approx(10.0)
        assert all(part.end_std_s is not None for part in parts)


def test_it_is_told_live_and_once_more_when_the_length_is_known() -> None:
    told = [phase for phase in phases(outputs(TWICE)) if phase.attempt == 0]
    kinds = [(phase.phase, phase.end_ns is None) for phase in told]
    up, zone, out = TASK_PHASES[Task.TEN_METRE_WALK]
    live = [(up, True), (up, False), (zone, True), (zone, False), (out, True)]
    assert kinds == [*live, (up, False), (zone, False), (out, False)]
    sent = {output.captured_ns for output in outputs(TWICE) if output.signal.name == "task_phase"}
    assert min(sent) * 1e-9 < joint_corridor(TWICE).truth.trials[0].enters_s + 0.5


def test_without_a_declared_walkway_the_steps_alone_place_the_lines() -> None:
    messages = joint_corridor(TWICE).messages()
    alone, known = (zones(through(TWICE, messages, walkway_m=m)) for m in (None, 10.0))
    for a, b in zip(alone, known, strict=True):
        assert a.end_std_s > b.end_std_s
        assert a.end_ns * 1e-9 == pytest.approx(b.end_ns * 1e-9, abs=0.8)


def test_a_walkway_that_was_not_walked_scales_nothing() -> None:
    messages = joint_corridor(TWICE).messages()
    wrong, none = (zones(through(TWICE, messages, walkway_m=m)) for m in (14.0, None))
    assert [zone.end_ns for zone in wrong] == [zone.end_ns for zone in none]


def test_all_of_the_walkway_can_be_timed() -> None:
    [zone] = zones(outputs(WHOLE))
    [trial] = joint_corridor(WHOLE).truth.trials
    assert zone.distance_m == 10.0
    assert (zone.end_ns - zone.start_ns) * 1e-9 == pytest.approx(trial.end_s - trial.start_s, abs=0.8)


def test_whoever_stops_about_the_last_line_stops_at_it_where_no_walkway_is_declared() -> None:
    [zone] = zones(through(WHOLE, joint_corridor(WHOLE).messages(), walkway_m=None))
    [known] = zones(outputs(WHOLE))
    assert zone.end_ns == known.end_ns


def test_a_trial_that_stops_within_the_zone_is_given_up() -> None:
    truth = joint_corridor(TWICE).truth
    cut = [
        each
        for each in joint_corridor(TWICE).messages()
        if each.envelope.captured_ns < 1e9 * (truth.trials[0].enters_s + 2)
    ]
    last = ended(through(TWICE, cut))[-1]
    assert (last.phase, last.end_std_s) == (TaskPhaseKind.TIMED_ZONE, None)


def test_batches_decide_nothing() -> None:
    assert lines(through(ON, joint_corridor(ON).messages(7))) == lines(outputs(ON))


@pytest.mark.parametrize("what", [TWICE, ON])
def test_split_and_resume_is_bit_identical(what: str) -> None:
    assert lines(resumed(what)) == lines(outputs(what))
