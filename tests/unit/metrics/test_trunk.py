"""Autocorrelation of the lower back: one for even steps, less where every other step differs, none in standing."""

import json

import numpy as np
import pytest

from schemas.kinematics import SegmentMotion, SegmentSamples
from schemas.signals import SEGMENT_MOTION
from schemas.vocabulary import Segment
from services.bench.gait.worn import wearing
from services.metrics.node import build
from services.metrics.parameters import TrunkParameters
from services.metrics.trunk import NO_STRIDE_TIME, NO_WINDOW, TrunkRegularity

RATE_HZ, STRIDE_S = 100.0, 1.1
TIME_S = np.arange(0.0, 30.0, 1.0 / RATE_HZ)
STEPS = np.cos(2 * np.pi * 2 * TIME_S / STRIDE_S)
LIMP = np.cos(2 * np.pi * TIME_S / STRIDE_S)


def motion(upward, time_s=TIME_S) -> SegmentMotion:
    captured_ns = np.round(time_s * 1e9).astype(int).tolist()
    samples = SegmentSamples(
        segment=Segment.PELVIS,
        captured_ns=captured_ns,
        acceleration=[[0.0, float(value), 0.0] for value in upward],
        angular_velocity=[[0.0, 0.0, 0.0]] * len(captured_ns),
    )
    return SegmentMotion(captured_ns=captured_ns, segments=[samples])


def regularity(upward, stride_time_s: float | None = STRIDE_S) -> dict:
    trunk = TrunkRegularity(RATE_HZ, TrunkParameters())
    trunk.take(motion(upward))
    return {metric.name: metric for metric in trunk.metrics(stride_time_s, 40)}


def test_even_steps_repeat_after_each_step():
    found = regularity(STEPS)
    for name in ("trunk_step_regularity", "trunk_stride_regularity", "trunk_symmetry"):
        assert found[name].value == pytest.approx(1.0, abs=0.02)


def test_a_limp_repeats_after_a_stride_only():
    """Steps of amplitude 1 beside a limp of 0.6: after a step (1 - 0.36) / (1 + 0.36)."""
    found = regularity(STEPS + 0.6 * LIMP)
    assert found["trunk_step_regularity"].value == pytest.approx(0.64 / 1.36, abs=0.05)
    assert found["trunk_stride_regularity"].value == pytest.approx(1.0, abs=0.05)


def test_what_does_not_repeat_is_less_regular():
    noise = np.random.default_rng(1).normal(0.0, 0.7, len(TIME_S))
    assert regularity(STEPS + noise)["trunk_stride_regularity"].value < 0.6


def test_standing_is_no_walk_and_without_strides_there_is_no_lag():
    assert regularity(0.05 * STEPS)["trunk_step_regularity"].withheld_because == NO_WINDOW
    assert regularity(STEPS, None)["trunk_step_regularity"].withheld_because == NO_STRIDE_TIME


def test_batches_decide_nothing_and_a_restart_neither():
    whole, parts = TrunkRegularity(RATE_HZ, TrunkParameters()), TrunkRegularity(RATE_HZ, TrunkParameters())
    whole.take(motion(STEPS))
    for first in range(0, len(TIME_S), 7):
        parts.take(motion(STEPS[first : first + 7], TIME_S[first : first + 7]))
        if first == 700:
            kept, parts = json.loads(json.dumps(parts.snapshot())), TrunkRegularity(RATE_HZ, TrunkParameters())
            parts.restore(kept)
    assert parts.metrics(STRIDE_S, 40) == whole.metrics(STRIDE_S, 40)
    assert parts.snapshot() == whole.snapshot()


def test_a_hole_begins_a_new_window():
    trunk = TrunkRegularity(RATE_HZ, TrunkParameters())
    for first in range(0, len(TIME_S), 500):
        trunk.take(motion(STEPS[first : first + 500], TIME_S[first : first + 500] + first * 1e-3))
    assert {metric.withheld_because for metric in trunk.metrics(STRIDE_S, 40)} == {NO_WINDOW}


def test_only_a_lumbar_sensor_alone_is_listened_to(description):
    signals = {stream.signal for stream in build(wearing(description, {Segment.PELVIS})).streams}
    assert SEGMENT_MOTION in signals
    assert SEGMENT_MOTION not in {stream.signal for stream in build(description).streams}
