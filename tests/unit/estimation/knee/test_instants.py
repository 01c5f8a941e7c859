"""Every sensor has a sample at an instant: measured, interpolated, or known to be missing."""

import json

import numpy as np
import pytest

from services.estimation.knee.instants import CommonInstants
from services.estimation.samples import Tick

MS = 1_000_000


def tick(ms: float, *values: float | None) -> Tick:
    """All six numbers of a sensor are its value; None where it does not speak."""
    rows = [[0.0 if value is None else value] * 6 for value in values]
    return Tick(round(ms * MS), np.array(rows), np.array([value is not None for value in values]))


def through(ticks, instants=None):
    instants = instants or CommonInstants([100.0, 100.0], 0.25, 0.75)
    return [instant for each in ticks for instant in instants.add(each)]


def said(instants):
    return [(i.captured_ns // MS, *[float(row[0]) for row in i.samples], i.heard) for i in instants]


def test_complete_ticks_pass_at_once_and_to_the_bit():
    ticks = [tick(10 * k, k, 2 * k) for k in range(5)]
    instants = through(ticks)
    assert [i.captured_ns for i in instants] == [t.captured_ns for t in ticks]
    assert all(i.samples is t.samples and i.heard == (True, True) for i, t in zip(instants, ticks, strict=True))


def test_a_lost_sample_is_interpolated_by_the_next_one():
    instants = CommonInstants([100.0, 100.0], 0.25, 0.75)
    assert len(through([tick(0, 0, 0), tick(10, 1, None), tick(20, 2, None)], instants)) == 1
    assert said(through([tick(30, 3, 6)], instants)) == [
        (10, 1.0, 2.0, (True, True)), (20, 2.0, 4.0, (True, True)), (30, 3.0, 6.0, (True, True)),
    ]  # fmt: skip


def test_hubs_without_a_common_clock_share_the_instants_of_one():
    ticks = [t for k in range(6) for t in (tick(10 * k, k, None), tick(10 * k + 4, None, k))]
    found = said(through(ticks))
    assert [row[0] for row in found[1:]] == [10, 20, 30, 40, 50]
    for ms, first, second, heard in found[1:]:
        assert (first, heard) == (ms / 10, (True, True))
        assert second == pytest.approx((ms - 4) / 10)
    # Before the second sensor spoke for the first time nothing can be said of it.
    assert found[0] == (0, 0.0, 0.0, (True, False))


def test_a_slow_sensor_beside_a_fast_one():
    instants = CommonInstants([100.0, 50.0], 0.25, 0.75)
    ticks = [tick(10 * k, k, k if k % 2 == 0 else None) for k in range(9)]
    found = said(through(ticks, instants))
    assert found == [(10 * k, float(k), float(k), (True, True)) for k in range(9)]


def test_a_silent_sensor_is_not_waited_for():
    ticks = [tick(0, 0, 0), *[tick(10 * k, k, None) for k in range(1, 60)]]
    instants = CommonInstants([100.0, 100.0], 0.25, 0.75)
    found = said(through(ticks, instants))
    assert len(found) == 60
    assert {row[3] for row in found[1:]} == {(True, False)}
    # It is back: what lay in between stays unheard, and from now on it speaks.
    back = said(through([tick(600, 60, 60), tick(610, 61, 61)], instants))
    assert [row[3] for row in back] == [(True, True), (True, True)]


def test_latency_is_bounded_by_the_silence_that_is_tolerated():
    instants = CommonInstants([100.0, 100.0], 0.25, 0.75)
    late = []
    for k in range(60):
        for instant in instants.add(tick(10 * k, k, 0 if k == 0 else None)):
            late.append(10 * k - instant.captured_ns // MS)
    assert max(late) == 250


def test_the_end_gives_up_waiting():
    instants = CommonInstants([100.0, 100.0], 0.25, 0.75)
    through([tick(0, 0, 0), tick(10, 1, None)], instants)
    assert said(instants.finish()) == [(10, 1.0, 0.0, (True, False))]
    assert instants.finish() == []


@pytest.mark.parametrize("split", range(1, 30, 4))
def test_resumed_instants_are_the_same(split):
    rng = np.random.default_rng(3)
    ticks = [
        tick(10 * k + rng.uniform(0, 2), *[rng.normal() if rng.random() > 0.3 else None for _ in range(2)])
        for k in range(60)
    ]
    ticks = [t for t in ticks if t.fresh.any()]
    whole = said(through(ticks))
    first, second = (CommonInstants([100.0, 100.0], 0.25, 0.75) for _ in range(2))
    begun = said(through(ticks[:split], first))
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    assert begun + said(through(ticks[split:], second)) == whole
