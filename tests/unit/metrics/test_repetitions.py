import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from schemas.metrics import SessionMetrics
from schemas.signals import REPETITION, STRIDE
from schemas.tasks import Repetition
from schemas.vocabulary import Side, Task
from services.flow.message import Envelope, Message, Stream
from services.metrics.node import build
from services.metrics.trend import Trend

PERIOD_S = 4.0


def made(index=0, side=Side.RIGHT, **changes) -> Repetition:
    """A seated extension of 2 s with a way out of 0.8 s, every 4 s; each range 0.01 rad smaller than the one before."""
    start = round(index * PERIOD_S * 1e9)
    fields = {
        "degree_of_freedom": f"knee_flexion_{side}",
        "side": side,
        "index": index,
        "start_ns": start,
        "turn_ns": start + 800_000_000,
        "end_ns": start + 2_000_000_000,
        "start_angle": 1.5,
        "turn_angle": 0.1 + 0.01 * index,
        "end_angle": 1.5,
        "angle_std": 0.02,
        "largest_velocity": 3.0,
        "valid": True,
        "rejected_because": None,
    }
    return Repetition(**(fields | changes))


def rejected(index, **changes):
    return made(index, valid=False, rejected_because="less than half of the usual range", **changes)


@pytest.fixture
def exercise(description):
    return description.model_copy(update={"task": Task.KNEE_FLEXION})


def messages(repetitions):
    return [
        Message(Stream(REPETITION, "segmentation"), Envelope(0, number, repetition.end_ns), repetition)
        for number, repetition in enumerate(repetitions)
    ]


def run(node, given_messages):
    outputs = [output for message in given_messages for output in node.step(message)] + node.finish()
    return [output.payload for output in outputs]


def final(description, repetitions, side=Side.RIGHT):
    last = run(build(description), messages(repetitions))[-1]
    assert last.final
    return {metric.name: metric for metric in last.metrics if metric.side == side.value}


def test_the_numbers_are_those_of_the_repetitions(exercise):
    found = final(exercise, [made(index) for index in range(10)])
    ranges = 1.4 - 0.01 * np.arange(10)
    assert found["repetitions_counted"].value == 10.0
    assert found["repetitions_rejected"].value == 0.0
    assert found["repetition_range"].value == pytest.approx(ranges.mean())
    assert found["repetition_range"].spread == pytest.approx(ranges.std(ddof=1))
    assert found["repetition_range"].mean_std == pytest.approx(ranges.std(ddof=1) / np.sqrt(10))
    assert found["repetition_range_sd"].value == pytest.approx(ranges.std(ddof=1))
    assert found["repetition_range_cv"].value == pytest.approx(ranges.std(ddof=1) / ranges.mean())
    assert found["repetition_flexion_largest"].value == pytest.approx(1.5)
    assert found["repetition_flexion_smallest"].value == pytest.approx(0.145)
    assert found["repetition_time_extending"].value == pytest.approx(0.8)
    assert found["repetition_time_flexing"].value == pytest.approx(1.2)
    assert found["repetition_tempo"].value == pytest.approx(15.0)
    assert found["repetition_peak_velocity"].value == pytest.approx(3.0)
    assert found["repetition_range_slope"].value == pytest.approx(-0.01)
    assert found["repetition_range_slope"].mean_std == pytest.approx(0.0, abs=1e-9)


def test_flexing_comes_first_in_a_squat(exercise):
    squats = [made(index, start_angle=0.1, turn_angle=1.5, end_angle=0.1) for index in range(3)]
    assert final(exercise, squats)["repetition_time_flexing"].value == pytest.approx(0.8)


def test_rejected_repetitions_are_counted_and_told_but_in_no_mean(exercise):
    repetitions = [made(0), made(1), rejected(2, turn_angle=1.0), made(3), made(4)]
    found = final(exercise, repetitions)
    assert (found["repetitions_counted"].value, found["repetitions_rejected"].value) == (4.0, 1.0)
    assert found["repetition_range"].strides == 4
    assert found["repetition_tempo"].strides == 2
    assert run(build(exercise), messages(repetitions))[-1].repetitions == repetitions


def test_a_rest_between_sets_is_in_no_tempo(exercise):
    late = [made(index, start_ns=made(index).start_ns + 60 * 10**9, end_ns=made(index).end_ns + 60 * 10**9)
            for index in range(3, 6)]  # fmt: skip
    late = [one.model_copy(update={"turn_ns": one.start_ns + 800_000_000}) for one in late]
    found = final(exercise, [*(made(index) for index in range(3)), *late])
    assert found["repetition_tempo"].value == pytest.approx(15.0)
    assert found["repetition_tempo"].strides == 4


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_are_withheld_with_the_reason(count, exercise):
    found = final(exercise, [made(index) for index in range(count)])
    assert found["repetitions_counted"].value == count
    withheld = [metric for name, metric in found.items() if name.startswith("repetition_")]
    assert len(withheld) == 10
    assert all(metric.value is None for metric in withheld)
    assert found["repetition_range"].withheld_because == f"{count} of at least 3 repetitions"


def test_walks_have_no_such_metrics(description):
    [last] = run(build(description), [])
    assert not [metric for metric in last.metrics if metric.name.startswith("repetition")]


def test_reports_come_after_each_and_do_not_depend_on_strides(exercise, stride):
    told = messages([made(index) for index in range(5)])
    strides = [
        Message(Stream(STRIDE, "segmentation"), Envelope(0, number, one.end_ns), one)
        for number, one in enumerate(stride(side, index) for index in range(6) for side in Side)
    ]
    first = [payload.model_dump_json() for payload in run(build(exercise), told + strides)]
    last = [payload.model_dump_json() for payload in run(build(exercise), strides + told)]
    assert first == last
    assert len(first) == 6


@pytest.mark.parametrize("cut", [0, 1, 4, 7])
def test_split_and_resume(cut, exercise):
    told = messages([made(0), made(1), rejected(2), made(3), made(0, Side.LEFT), made(4), made(5)])
    expected = run(build(exercise), told)
    first, second = build(exercise), build(exercise)
    outputs = [output.payload for message in told[:cut] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    assert second.snapshot() == first.snapshot()
    assert outputs + run(second, told[cut:]) == expected


def test_the_table_ends_at_a_thousand(exercise):
    many = messages([made(index, turn_angle=0.1) for index in range(1100)])
    last = run(build(exercise), many)[-1]
    assert SessionMetrics.model_validate_json(last.model_dump_json()) == last
    assert len(last.repetitions) == 1000
    assert next(m for m in last.metrics if m.name == "repetitions_counted" and m.side == "right").value == 1100


@given(st.lists(st.floats(-10, 10), min_size=3, max_size=30))
def test_the_running_line_is_the_fitted_one(values):
    trend = Trend()
    for x, y in enumerate(values):
        trend.add(float(x), y)
    (slope, _), residuals, *_ = np.polyfit(np.arange(len(values)), values, 1, full=True)
    found = trend.slope()
    assert found is not None
    assert found[0] == pytest.approx(slope, abs=1e-9)
    x = np.arange(len(values))
    unexplained = float(residuals[0]) if len(residuals) else 0.0
    error = np.sqrt(unexplained / (len(values) - 2) / np.sum((x - x.mean()) ** 2))
    assert found[1] == pytest.approx(error, abs=1e-6)


def test_a_line_through_two_points_has_no_error():
    trend = Trend()
    trend.add(0.0, 1.0)
    trend.add(1.0, 2.0)
    assert trend.slope() is None
