"""Turns made by hand: a heading over time, with the pelvis's swing to and fro."""

import math

import numpy as np
import pytest

from services.segmentation.timed_up_and_go.instants import Instant
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters
from services.segmentation.timed_up_and_go.trace import Trace
from services.segmentation.timed_up_and_go.turns import TurnWatch

P = TimedUpAndGoParameters()
STEP_S = P.instant_s


def swung(time_s: float, size: float = 0.08, hz: float = 0.9) -> float:
    return size * math.sin(2 * math.pi * hz * time_s)


def ramp(time_s: float, start_s: float, length_s: float, angle: float = math.pi) -> float:
    u = min(1.0, max(0.0, (time_s - start_s) / length_s))
    return angle * u * u * (3 - 2 * u)


def through(heading, until_s: float, least: float = P.turn_begins):
    """Begin of the first turn, its end, and the split if there was one, in s."""
    trace, watch = Trace(P.memory_s), TurnWatch(P)
    begun = ended = split = None
    watch.start(0, None)
    for time_s in np.arange(0.0, until_s, STEP_S).tolist():
        trace.append(Instant(round(time_s * 1e9), heading(time_s), None, None, None, None, None, None))
        if begun is None:
            begun = watch.begun(trace, least)
        elif ended is None and split is None:
            ended = watch.ended(trace)
            split = watch.split(trace, P.turn_to_sit_begins) if ended is None else None
    return begun, ended, split


@pytest.mark.parametrize("length_s", [1.2, 2.0, 4.0])
@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("from_rad", [0.0, 40.0])
def test_a_turn_is_timed_whichever_way_and_from_wherever(length_s: float, way: float, from_rad: float) -> None:
    begun, ended, split = through(lambda t: from_rad + way * ramp(t, 5.0, length_s) + swung(t), 14.0)
    assert split is None
    assert abs(begun.at_ns * 1e-9 - 5.0) < max(0.2, 2 * begun.std_s)
    assert abs(ended.at_ns * 1e-9 - 5.0 - length_s) < max(0.2, 2 * ended.std_s)


def test_slower_turns_are_less_sure() -> None:
    quick, _, _ = through(lambda t: ramp(t, 5.0, 1.2) + swung(t), 12.0)
    slow, _, _ = through(lambda t: ramp(t, 5.0, 6.0) + swung(t), 14.0)
    assert slow.std_s > 2 * quick.std_s


@pytest.mark.parametrize("size", [0.0, 0.08, 0.12])
def test_swinging_to_and_fro_is_no_turn(size: float) -> None:
    begun, _, _ = through(lambda t: swung(t, size), 20.0)
    assert begun is None


def test_a_corner_is_no_turn_at_the_marker() -> None:
    begun, _, _ = through(lambda t: ramp(t, 5.0, 1.5, math.pi / 2) + swung(t), 14.0)
    assert begun is None


def test_veering_slowly_is_no_turn() -> None:
    begun, _, _ = through(lambda t: 0.1 * t + swung(t), 25.0)
    assert begun is None


@pytest.mark.parametrize("back", [1.0, -1.0], ids=["onward", "back"])
def test_two_turns_with_hardly_a_walk_between_are_split_where_the_heading_pauses(back: float) -> None:
    begun, ended, split = through(lambda t: ramp(t, 5.0, 1.5) + back * ramp(t, 6.7, 1.5) + swung(t, 0.04), 12.0)
    assert begun is not None
    assert ended is None
    first, second = split
    assert first.at_ns <= second.at_ns
    assert first.at_ns * 1e-9 == pytest.approx(6.5, abs=0.4)
    assert second.at_ns * 1e-9 == pytest.approx(6.7, abs=0.4)


def test_lost_samples_beside_a_boundary_widen_it() -> None:
    trace, watch = Trace(P.memory_s), TurnWatch(P)
    watch.start(0, 0.0)
    begun = None
    for time_s in np.arange(0.0, 8.0, STEP_S).tolist():
        if not 5.0 < time_s < 5.5:
            heading = ramp(time_s, 5.0, 2.0)
            trace.append(Instant(round(time_s * 1e9), heading, None, None, None, None, None, None))
            begun = begun or watch.begun(trace, P.turn_begins)
    assert begun is not None
    assert begun.std_s > 0.2
