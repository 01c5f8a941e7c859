import itertools
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from schemas.vocabulary import GaitEventKind
from services.segmentation.gait.swing import Contact, Rotation, SwingDetector, turning_point
from services.segmentation.parameters import SegmentationParameters

PARAMETERS = SegmentationParameters()
TICK = 10_000_000


def gait(seconds: float, stride_s: float, swing_angle: float) -> list[tuple[int, float, float]]:
    """A leg as a pendulum: (time, shank rate, place of the ankle), foremost at whole strides."""
    time_s = np.arange(0, seconds, 0.01)
    phase = 2 * np.pi * time_s / stride_s
    lean = 0.5 * swing_angle * np.cos(phase)
    rate = np.gradient(lean, 0.01)
    return [(round(t * 1e9), float(r), float(0.8 * np.sin(a))) for t, r, a in zip(time_s, rate, lean, strict=True)]


def events(detector: SwingDetector, samples, other: bool = False) -> list[tuple[int, Contact]]:
    found = [(t, detector.step(t, rate, forward, other)) for t, rate, forward in samples]
    return [(t, event) for t, event in found if event is not None]


@pytest.mark.parametrize("stride_s", [0.8, 1.2, 2.0])
@pytest.mark.parametrize("swing_angle", [0.6, 1.1])
def test_contacts_follow_the_turning_points(stride_s, swing_angle):
    found = events(SwingDetector(PARAMETERS), gait(12.0, stride_s, swing_angle))
    contacts = [event.captured_ns * 1e-9 for _, event in found if event.kind is GaitEventKind.INITIAL_CONTACT]
    wanted = np.arange(1, len(contacts) + 1) * stride_s + PARAMETERS.contact_after_foremost_s
    assert len(contacts) >= int(12 / stride_s) - 1
    np.testing.assert_allclose(contacts, wanted, atol=2e-3)
    lifts = [event.captured_ns * 1e-9 for _, event in found if event.kind is GaitEventKind.TOE_OFF]
    # The shank turns round when its ankle does, and both rules have the same weight.
    both = 0.5 * (PARAMETERS.toe_off_after_hindmost_s - PARAMETERS.shank_toe_off_before_swing_s)
    np.testing.assert_allclose(lifts[1:], np.arange(1, len(lifts)) * stride_s + stride_s / 2 + both, atol=2e-3)


@pytest.mark.parametrize(("early_s", "counts"), [(-0.1, True), (0.1, True), (0.5, False)])
def test_a_rotation_that_began_far_from_where_the_ankle_turned_does_not_time_toe_off(early_s, counts):
    """Its start is half of the toe-off, unless it cannot be the swing's."""
    detector = SwingDetector(PARAMETERS)
    hindmost_ns, start_ns = 5_000_000_000, 5_000_000_000 - round(early_s * 1e9)
    found = detector._agreed(hindmost_ns, Rotation(start_ns, 0.3, 2.0, start_ns + 10**8, ended=False))
    by_ankle = hindmost_ns + round(PARAMETERS.toe_off_after_hindmost_s * 1e9)
    by_shank = start_ns - round(PARAMETERS.shank_toe_off_before_swing_s * 1e9)
    assert found == pytest.approx(0.5 * (by_ankle + by_shank) if counts else by_ankle, abs=2)


def test_kinds_alternate_and_delays_are_bounded():
    found = events(SwingDetector(PARAMETERS), gait(20.0, 1.3, 1.0))
    kinds = [event.kind for _, event in found]
    assert all(a != b for a, b in itertools.pairwise(kinds))
    assert all(0 <= now - event.captured_ns < 0.4e9 for now, event in found)


def test_shuffling_is_no_walking():
    assert events(SwingDetector(PARAMETERS), gait(20.0, 1.2, 0.14)) == []


def test_slow_rotation_is_no_swing():
    """Sitting down and rising turn the shank as far as a swing does, but slowly."""
    assert events(SwingDetector(PARAMETERS), gait(40.0, 6.0, 0.6)) == []


def test_both_shanks_turning_together_is_no_swing():
    assert events(SwingDetector(PARAMETERS), gait(20.0, 1.2, 1.0), other=True) == []


def test_a_small_movement_between_large_swings_is_ignored():
    detector = SwingDetector(PARAMETERS)
    events(detector, gait(12.0, 1.2, 1.1))
    detector.interrupt()
    later = [(t + 13_000_000_000, rate, forward) for t, rate, forward in gait(5.0, 0.6, 0.18)]
    assert events(detector, later) == []


def test_a_step_that_comes_to_rest_has_a_contact():
    time_s = np.arange(0, 3.0, 0.01)
    lean = -0.4 + 0.4 * np.clip((time_s - 1.0) / 0.4, 0, 1)
    samples = [
        (round(t * 1e9), float(r), float(0.8 * np.sin(a)))
        for t, r, a in zip(time_s, np.gradient(lean, 0.01), lean, strict=True)
    ]
    found = events(SwingDetector(PARAMETERS), samples)
    assert [event.kind for _, event in found] == [GaitEventKind.TOE_OFF, GaitEventKind.INITIAL_CONTACT]
    assert found[1][1].captured_ns * 1e-9 == pytest.approx(1.4, abs=0.06)
    assert found[1][1].std_s == PARAMETERS.resting_contact_std_s


def test_interruption_gives_up_the_swing_but_not_the_memory():
    detector = SwingDetector(PARAMETERS)
    samples = gait(12.0, 1.2, 1.1)
    events(detector, samples[:1100])
    detector.interrupt()
    assert not detector.rotating
    assert detector.state.own_angles
    assert detector.state.trail == []


@pytest.mark.parametrize("cut", [1, 333, 700, 911])
def test_split_and_resume(cut):
    samples = gait(12.0, 1.1, 1.0)
    whole = SwingDetector(PARAMETERS)
    expected = events(whole, samples)
    first, second = SwingDetector(PARAMETERS), SwingDetector(PARAMETERS)
    found = events(first, samples[:cut])
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert found + events(second, samples[cut:]) == expected
    assert second.snapshot() == whole.snapshot()


number = st.floats(-200, 200, allow_nan=False)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.integers(1, 300), number, number, st.booleans()), max_size=120))
def test_any_input_is_survived(samples):
    detector, now = SwingDetector(PARAMETERS), 0
    lifted = False
    for ticks, rate, forward, other in samples:
        now += ticks * 1_000_000
        event = detector.step(now, rate, forward, other)
        if event is not None:
            assert event.captured_ns <= now + 100_000_000
            if event.kind is GaitEventKind.INITIAL_CONTACT:
                assert lifted
            lifted = event.kind is GaitEventKind.TOE_OFF
    assert len(detector.state.trail) < 4000


def test_turning_point_of_a_parabola_is_exact():
    trail = [(k * TICK, -((k * 0.01 - 0.0533) ** 2)) for k in range(10)]
    assert turning_point(trail, 5) == pytest.approx(0.0533e9, abs=1e3)
    assert turning_point(trail, 0) == 0
    assert turning_point([(0, 1.0), (1, 1.0), (2, 1.0)], 1) == 1
