"""A device's clock on the session's, under the jitter, drift and jumps of real radios."""

import math

import numpy as np
import pytest

from services.ingest.clock import ClockEvent, ClockParameters, DeviceClock

MS = 1_000_000
EPOCH = 1_700_000_000_000_000_000


def walk(clock, seconds, *, ppm=0.0, latency=(5, 35), seed=0, start_s=0.0, device_jump_ns=0):
    """100 Hz samples; errors of the session time in ms, and the events."""
    rng = np.random.default_rng(seed)
    errors, events, arrival_ns = [], [], 0
    for k in range(int(seconds * 100)):
        true_ns = int(start_s * 1e9) + k * 10 * MS
        device_ns = EPOCH + int(true_ns * (1 - ppm * 1e-6)) + device_jump_ns
        # A link keeps the order of its messages.
        arrival_ns = max(arrival_ns, true_ns + int(rng.uniform(*latency) * MS))
        reading = clock.read(device_ns, arrival_ns)
        events.append(reading.event)
        if reading.captured_ns is not None:
            errors.append((reading.captured_ns - true_ns) / MS)
    return np.array(errors), events


@pytest.mark.parametrize("ppm", [0, 50, -50, 5000, -5000])
def test_offset_and_drift_are_found_through_the_jitter(ppm):
    clock = DeviceClock()
    errors, events = walk(clock, 120, ppm=ppm)
    # The smallest delay, 5 ms, stays: nothing on one side of the link shows it.
    assert np.abs(errors[3000:] - 5).max() < 0.3
    assert np.abs(errors[500:] - 5).max() < 2
    assert clock.drift == pytest.approx(ppm * 1e-6, abs=50e-6)
    assert set(events) == {ClockEvent.STEADY}
    assert 0 < clock.std_ns < 2 * MS


def test_increments_follow_the_device_and_not_the_radio():
    errors, _ = walk(DeviceClock(), 60, ppm=50, seed=3)
    assert np.abs(np.diff(errors[1000:])).max() < 2


def test_time_never_runs_back_nor_ahead_of_the_arrival():
    clock = DeviceClock()
    rng = np.random.default_rng(1)
    captured, arrival = [], 0
    for k in range(3000):
        arrival = max(arrival, k * 10 * MS + int(rng.uniform(5, 35) * MS))
        reading = clock.read(EPOCH + k * 10 * MS, arrival)
        assert reading.captured_ns <= arrival + 1000
        captured.append(reading.captured_ns)
    assert min(np.diff(captured)) > 0


def test_uncertainty_is_unknown_before_there_is_a_fit():
    clock = DeviceClock()
    walk(clock, 1)
    assert clock.std_ns == math.inf


@pytest.mark.parametrize("jump_s", [10, -10])
def test_a_clock_that_is_set_is_noticed_and_followed(jump_s):
    clock = DeviceClock()
    walk(clock, 30)
    errors, events = walk(clock, 30, start_s=30, device_jump_ns=jump_s * 1000 * MS)
    assert events.count(ClockEvent.JUMPED) == 1
    assert events.count(ClockEvent.BACKWARDS) == (1 if jump_s < 0 else 0)
    assert np.abs(errors[500:] - 5).max() < 2


def test_one_stray_stamp_changes_nothing():
    clock, undisturbed = DeviceClock(), DeviceClock()
    walk(clock, 30)
    walk(undisturbed, 30)
    assert clock.read(EPOCH + 5, 30_000 * MS).captured_ns is None
    errors, _ = walk(clock, 10, start_s=30)
    expected, _ = walk(undisturbed, 10, start_s=30)
    assert (errors == expected).all()


def test_a_stall_with_backlog_keeps_the_capture_times():
    """The link freezes for 4 s and then delivers everything at once: late, but captured when it was."""
    clock = DeviceClock()
    walk(clock, 30, latency=(5, 6))
    errors = []
    for k in range(400):
        true_ns = 30_000 * MS + k * 10 * MS
        reading = clock.read(EPOCH + true_ns, 34_010 * MS)
        assert reading.event is ClockEvent.STEADY
        errors.append((reading.captured_ns - true_ns) / MS)
    assert np.abs(np.array(errors) - 5).max() < 0.5


def test_a_disconnect_is_no_jump():
    clock = DeviceClock()
    walk(clock, 30)
    errors, events = walk(clock, 10, start_s=60)
    assert set(events) == {ClockEvent.STEADY}
    assert np.abs(errors[300:] - 5).max() < 2


def test_drift_is_bounded():
    clock = DeviceClock(ClockParameters(worst_drift=0.001))
    walk(clock, 30, ppm=5000)
    assert clock.drift == 0.001
