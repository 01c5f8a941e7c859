"""Metrics of squats, steps and tilts from repetitions made by hand."""

import json

import numpy as np
import pytest

from schemas.signals import REPETITION, STRIDE
from schemas.tasks import Repetition
from schemas.vocabulary import Side, Task
from services.flow.message import Envelope, Message, Stream
from services.metrics.node import build

PERIOD_S = 5.0


def made(index=0, side=None, movement="squat_depth", reach=1.4, **changes) -> Repetition:
    """Down in 1 s, up in 1.5 s, every 5 s; each range 0.01 rad smaller than the one before."""
    start = round(index * PERIOD_S * 1e9)
    knee = {"knee_flexion_right": 1.5 - 0.01 * index, "knee_flexion_left": 1.2, "hip_flexion_right": 1.0}
    fields = {
        "degree_of_freedom": movement,
        "side": side,
        "index": index,
        "start_ns": start,
        "turn_ns": start + 1_000_000_000,
        "end_ns": start + 2_500_000_000,
        "start_angle": 0.1,
        "turn_angle": 0.1 + reach - 0.01 * index,
        "end_angle": 0.1,
        "angle_std": 0.02,
        "largest_velocity": 2.0,
        "hold_s": 0.4,
        "ranges": knee | {"hip_flexion_left": 0.8, "arm_elevation_right": 1.1},
        "valid": True,
        "rejected_because": None,
    }
    return Repetition(**(fields | changes))


def session(description, task):
    return description.model_copy(update={"task": task})


def messages(repetitions):
    return [
        Message(Stream(REPETITION, "segmentation"), Envelope(0, number, one.end_ns), one)
        for number, one in enumerate(repetitions)
    ]


def run(node, given_messages):
    outputs = [output for message in given_messages for output in node.step(message)] + node.finish()
    return [output.payload for output in outputs]


def final(description, task, repetitions):
    last = run(build(session(description, task)), messages(repetitions))[-1]
    assert last.final
    return {(metric.name, metric.side): metric for metric in last.metrics}


def test_squats_are_of_the_whole_body(description):
    found = final(description, Task.SQUAT, [made(k) for k in range(6)])
    ranges = 1.4 - 0.01 * np.arange(6)
    assert found["repetitions_counted", None].value == 6.0
    assert found["repetition_range", None].value == pytest.approx(ranges.mean())
    assert found["repetition_range", None].spread == pytest.approx(ranges.std(ddof=1))
    assert found["repetition_range", None].mean_std == pytest.approx(ranges.std(ddof=1) / np.sqrt(6))
    assert found["repetition_range_sd", None].value == pytest.approx(ranges.std(ddof=1))
    assert found["repetition_range_cv", None].value == pytest.approx(ranges.std(ddof=1) / ranges.mean())
    assert found["repetition_range_slope", None].value == pytest.approx(-0.01)
    assert found["repetition_time_out", None].value == pytest.approx(1.0)
    assert found["repetition_time_back", None].value == pytest.approx(1.5)
    assert found["repetition_hold", None].value == pytest.approx(0.4)
    assert found["repetition_peak_velocity", None].value == pytest.approx(2.0)
    assert found["repetition_tempo", None].value == pytest.approx(12.0)


def test_both_legs_stand_beside_each_other_in_squats(description):
    found = final(description, Task.SQUAT, [made(k) for k in range(6)])
    right = found["repetition_knee_flexion_range", "right"]
    assert right.value == pytest.approx(1.475)
    assert right.strides == 6
    assert found["repetition_knee_flexion_range", "left"].value == pytest.approx(1.2)
    ratio = found["repetition_knee_flexion_range_ratio_larger_to_smaller", None]
    assert ratio.value == pytest.approx(1.475 / 1.2)
    assert ratio.mean_std == pytest.approx(right.mean_std / 1.2)
    assert found["repetition_hip_flexion_range_ratio_larger_to_smaller", None].value == pytest.approx(1.25)
    assert found["repetition_arm_elevation_range", "right"].value == pytest.approx(1.1)
    unseen = found["repetition_arm_elevation_range", "left"]
    assert (unseen.value, unseen.withheld_because) == (None, "0 of at least 3 repetitions")
    assert ("repetition_range_ratio_larger_to_smaller", None) not in found


@pytest.mark.parametrize(
    ("task", "movement"),
    [(Task.STEPPING, "hip_flexion_{}"), (Task.TRUNK_TILT_FRONTAL, "trunk_lean_right")],
)
def test_sides_that_move_in_turn_are_compared(description, task, movement):
    repetitions = [
        made(k, side, movement.format(side), reach=reach)
        for k in range(4)
        for side, reach in ((Side.RIGHT, 0.8), (Side.LEFT, 0.6))
    ]
    found = final(description, task, repetitions)
    assert found["repetition_range", "right"].value == pytest.approx(0.785)
    assert found["repetition_range", "left"].value == pytest.approx(0.585)
    ratio = found["repetition_range_ratio_larger_to_smaller", None]
    assert ratio.value == pytest.approx(0.785 / 0.585)
    assert ratio.strides == 4
    assert found["repetition_tempo", "left"].value == pytest.approx(12.0)
    stepping = task is Task.STEPPING
    assert (("repetition_knee_flexion_range", "left") in found) is stepping
    if stepping:
        assert found["repetition_knee_flexion_range", "left"].strides == 4, "of the leg that steps, not of both"


def test_what_does_not_count_is_told_and_in_no_mean(description):
    odd = made(3, reach=0.3, valid=False, rejected_because="less than half of the usual range")
    found = final(description, Task.SQUAT, [made(0), made(1), made(2), odd, made(4)])
    assert found["repetitions_rejected", None].value == 1.0
    assert found["repetition_range", None].strides == 4
    assert found["repetition_knee_flexion_range", "right"].strides == 4


def test_two_repetitions_are_no_mean(description):
    found = final(description, Task.TRUNK_TILT_SAGITTAL, [made(k, None, "trunk_lean_forward") for k in range(2)])
    assert found["repetition_range", None].withheld_because == "2 of at least 3 repetitions"
    assert found["repetitions_counted", None].value == 2.0


@pytest.mark.parametrize("task", [Task.SQUAT, Task.STEPPING, Task.TRUNK_TILT_SAGITTAL, Task.TRUNK_TILT_FRONTAL])
def test_nothing_of_gait_is_told(description, task, stride):
    strides = [Message(Stream(STRIDE, "segmentation"), Envelope(0, k, k), stride(index=k)) for k in range(5)]
    told = run(build(session(description, task)), strides)
    assert len(told) == 1
    assert told[0].final
    assert {metric.name.split("_")[0] for metric in told[0].metrics} <= {"repetition", "repetitions"}
    assert told[0].curves == []


def test_metrics_come_after_each_repetition_and_all_of_them_at_the_end(description):
    told = run(build(session(description, Task.SQUAT)), messages([made(k) for k in range(4)]))
    assert [one.final for one in told] == [False] * 4 + [True]
    assert [len(one.repetitions) for one in told] == [0] * 4 + [4]


@pytest.mark.parametrize("task", [Task.SQUAT, Task.STEPPING])
def test_split_and_resume(description, task):
    sides = (None,) if task is Task.SQUAT else (Side.LEFT, Side.RIGHT)
    given_messages = messages([made(k, side) for k in range(5) for side in sides])
    whole = run(build(session(description, task)), given_messages)
    first, second = build(session(description, task)), build(session(description, task))
    told = [output.payload for message in given_messages[:3] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert second.snapshot() == first.snapshot()
    assert told + run(second, given_messages[3:]) == whole
