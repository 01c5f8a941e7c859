"""The timed up and go through the whole chain, with the faults of a clinic."""

from functools import cache

import pytest

from schemas.metrics import SessionMetrics
from schemas.tasks import TaskPhase
from schemas.vocabulary import TASK_PHASES, Task, TaskPhaseKind
from services.bench.tug.sessions import truth_of
from services.cli.assembly import build_chain
from services.faults.faults import HubGap, SensorOff
from services.faults.inject import inject
from services.ingest.source import iter_messages, open_source

SPEC = "synthetic:tug?speed=1.2&seed=31&sit_time=1.4&pause=3"
KNEE = SPEC + "&worn=1&seated_start=1&aborted=1"


@cache
def recorded(spec: str):
    source = open_source(spec)
    return source.describe(), tuple(iter_messages(source))


def run(spec: str, *faults) -> list:
    description, messages = recorded(spec)
    sensors = [sensor.name for sensor in description.hubs[0].sensors]
    samples = [message for message in messages if message.stream.signal.name == "imu"]
    chain = build_chain(description)
    return [made.payload for message in inject(samples, sensors, faults) for made in chain.push(message)]


@cache
def undisturbed() -> tuple:
    return tuple(run(SPEC))


def final(payloads) -> SessionMetrics:
    return [payload for payload in payloads if isinstance(payload, SessionMetrics)][-1]


def metric(payloads, name: str) -> float | None:
    return next(metric.value for metric in final(payloads).metrics if metric.name == name)


def true_time_s(spec: str) -> float:
    phases = truth_of(spec).phases
    last = phases[-1].attempt
    whole = [phase for phase in phases if phase.attempt == last]
    return whole[-1].end_s - whole[0].start_s


def test_the_report_has_the_time_and_every_phase():
    payloads = undisturbed()
    assert final(payloads).final
    assert metric(payloads, "tug_time") == pytest.approx(true_time_s(SPEC), abs=0.2)
    assert [phase.phase for phase in final(payloads).phases] == list(TASK_PHASES[Task.TIMED_UP_AND_GO])
    assert metric(payloads, "tug_attempts") == 1.0
    assert metric(payloads, "tug_steps") > 6


def test_the_gait_is_found_beside_the_test():
    assert metric(undisturbed(), "cadence") is not None


def test_phases_are_counted_while_the_session_runs():
    running = [payload for payload in undisturbed() if isinstance(payload, SessionMetrics) and not payload.final]
    assert len(running) == len(TASK_PHASES[Task.TIMED_UP_AND_GO])
    assert [sum(phase.end_ns is not None for phase in each.phases) for each in running] == [1, 2, 3, 4, 5]


def test_half_a_second_lost_in_the_turn_costs_only_certainty():
    turn = truth_of(SPEC).phases[2]
    payloads = run(SPEC, HubGap(turn.start_s + 0.3, turn.start_s + 0.8))
    assert metric(payloads, "tug_time") == pytest.approx(true_time_s(SPEC), abs=0.2)
    phases = {phase.phase: phase for phase in final(payloads).phases}
    found = phases[TaskPhaseKind.TURN]
    assert abs(found.start_ns * 1e-9 - turn.start_s) < 3 * found.start_std_s


def test_a_silent_thigh_leaves_the_other_to_tell():
    phases = truth_of(SPEC).phases
    payloads = run(SPEC, SensorOff("thigh_left", phases[1].start_s, phases[4].end_s + 2.0))
    assert metric(payloads, "tug_time") == pytest.approx(true_time_s(SPEC), abs=0.3)


def test_a_knee_session_tells_both_attempts_apart():
    payloads = run(KNEE)
    assert metric(payloads, "tug_attempts") == 1.0
    assert metric(payloads, "tug_attempts_aborted") == 1.0
    assert metric(payloads, "tug_time") == pytest.approx(true_time_s(KNEE), abs=0.4)
    assert metric(payloads, "tug_steps") is None
    told = [payload for payload in payloads if isinstance(payload, TaskPhase)]
    assert {phase.attempt for phase in told} == {0, 1}
