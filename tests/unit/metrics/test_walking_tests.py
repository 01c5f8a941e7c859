"""Walking tests in the metrics node: live from their phases alone, at the end with the strides."""

import json

import pytest

from schemas.signals import STRIDE, TASK_PHASE
from schemas.tasks import TaskPhase
from schemas.vocabulary import Side, Task, TaskPhaseKind
from services.flow.message import Envelope, Message, Stream
from services.ingest.source import open_source
from services.metrics.attempts import AttemptTotals
from services.metrics.node import MetricsNode
from services.metrics.parameters import MetricsParameters
from services.metrics.six_minute_walk import SixMinuteTotals
from services.metrics.ten_metre_walk import TenMetreTotals
from services.metrics.walking_tests import timed_test_totals
from tests.unit.metrics.conftest import made

WALK = open_source("synthetic:walk").describe()
KINDS = {
    Task.TIMED_UP_AND_GO: AttemptTotals,
    Task.SIX_MINUTE_WALK: SixMinuteTotals,
    Task.TEN_METRE_WALK: TenMetreTotals,
}


def described(task: Task):
    return WALK.model_copy(update={"task": task, "walkway_m": 10.0})


def messages() -> tuple[list[Message], list[Message]]:
    """Two trials of three phases, and strides."""
    kinds = (TaskPhaseKind.RUN_UP, TaskPhaseKind.TIMED_ZONE, TaskPhaseKind.RUN_OUT)
    phases = [
        TaskPhase(
            task=Task.TEN_METRE_WALK, attempt=attempt, phase=kind, start_ns=start, start_std_s=0.05,
            end_ns=end, end_std_s=None if end is None else 0.05, steps=4, distance_m=6.0, distance_std_m=0.0,
        )
        for attempt in (0, 1)
        for number, kind in enumerate(kinds)
        for start in [(20 * attempt + 5 * number) * 10**9]
        for end in (None, start + 5 * 10**9)
    ]  # fmt: skip
    told = [
        Message(Stream(TASK_PHASE, "segmentation"), Envelope(0, i, phase.end_ns or phase.start_ns), phase)
        for i, phase in enumerate(phases)
    ]
    strides = [made(side, index) for index in range(12) for side in Side]
    walked = [Message(Stream(STRIDE, "segmentation"), Envelope(0, i, s.end_ns), s) for i, s in enumerate(strides)]
    return told, walked


def run(fed: list[Message], split: int | None = None) -> list[str]:
    node, found = MetricsNode(described(Task.TEN_METRE_WALK)), []
    for i, message in enumerate(fed):
        if i == split:
            state = json.loads(json.dumps(node.snapshot()))
            node = MetricsNode(described(Task.TEN_METRE_WALK))
            node.restore(state)
        found += node.step(message)
    return [output.payload.model_dump_json() for output in [*found, *node.finish()]]


@pytest.mark.parametrize("task", list(Task))
def test_timed_tests_and_no_others_have_totals(task: Task) -> None:
    totals = timed_test_totals(described(task), MetricsParameters())
    assert type(totals) is KINDS.get(task, type(None))


def test_a_message_after_each_phase_that_ended_with_all_phases_so_far() -> None:
    told, walked = messages()
    found = [json.loads(each) for each in run([*told, *walked])]
    assert [len(each["phases"]) for each in found] == [1, 2, 3, 4, 5, 6, 6]
    assert [each["final"] for each in found] == [False] * 6 + [True]
    assert all(metric["name"].startswith("ten_metre_walk_") for metric in found[0]["metrics"])
    names = {metric["name"]: metric["value"] for metric in found[-1]["metrics"]}
    assert names["ten_metre_walk_speed"] == pytest.approx(1.2)
    assert names["walking_speed"] == pytest.approx(1.2)


def test_how_strides_and_phases_interleave_decides_nothing() -> None:
    told, walked = messages()
    mixed = [message for pair in zip(told, walked, strict=False) for message in pair] + walked[len(told) :]
    assert run([*told, *walked]) == run(mixed) == run([*walked, *told])


def test_split_and_resume() -> None:
    told, walked = messages()
    fed = [*told, *walked]
    assert run(fed, split=7) == run(fed)
    assert run(fed, split=17) == run(fed)
