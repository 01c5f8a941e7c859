"""Steps by the lower back alone, on accelerations made up for it."""

import json
from itertools import pairwise

import numpy as np
import pytest

from schemas.vocabulary import GaitEventKind, Side
from services.segmentation.gait.back_steps import BackStepDetector
from services.segmentation.parameters import SegmentationParameters

PARAMETERS = SegmentationParameters()
STEP_S = 0.55


def walk(
    seconds: float = 12.0, rate_hz: float = 100.0, step_s: float = STEP_S, size: float = 2.0, sway: float = 1.0
) -> list[tuple[int, float, float]]:
    """(ns, up, right): the trunk is caught once a step and pushed to the right while the left foot stands."""
    time_s = np.arange(0.0, seconds, 1 / rate_hz)
    up = -size * np.cos(2 * np.pi * time_s / step_s)
    right = sway * np.sin(np.pi * time_s / step_s)
    return list(zip(np.round(time_s * 1e9).astype(int).tolist(), up.tolist(), right.tolist(), strict=True))


def events(rows, detector=None):
    detector = detector or BackStepDetector(PARAMETERS)
    return [(ns, step) for ns, up, right in rows for step in detector.step(ns, up, right)]


def found(rows, detector=None):
    """The contacts alone."""
    return [(ns, step) for ns, step in events(rows, detector) if step.contact.kind is GaitEventKind.INITIAL_CONTACT]


@pytest.mark.parametrize("rate_hz", [40.0, 100.0, 204.8])
@pytest.mark.parametrize("step_s", [0.45, 0.55, 0.9])
def test_every_step_is_found_a_constant_after_the_steepest_rise(rate_hz, step_s):
    steps = [step for _, step in found(walk(rate_hz=rate_hz, step_s=step_s))]
    times = np.array([step.contact.captured_ns * 1e-9 for step in steps])
    # -cos rises steepest a quarter of a period after each whole one.
    expected = (np.arange(len(times)) + 0.25) * step_s + PARAMETERS.back_contact_after_rise_s
    first = round((times[0] - expected[0]) / step_s)
    assert first <= 1
    np.testing.assert_allclose(times, expected + first * step_s, atol=0.02)
    assert len(times) >= 12.0 / step_s - 3


def test_sides_alternate_and_follow_the_push():
    steps = [step for _, step in found(walk())]
    # Rightward acceleration changes from negative to positive at even steps: the left foot comes down.
    for step in steps:
        number = round((step.contact.captured_ns * 1e-9 - PARAMETERS.back_contact_after_rise_s) / STEP_S - 0.25)
        assert step.side is (Side.LEFT if number % 2 == 0 else Side.RIGHT)
    assert all(a.side is not b.side for a, b in pairwise(steps))


def test_events_come_after_their_time_and_within_bounds():
    steps = found(walk())
    late = [(ns - step.contact.captured_ns) * 1e-9 for ns, step in steps]
    assert min(late) > 0
    assert max(late[PARAMETERS.back_fewest_contacts :]) < 0.5
    assert max(late) < 0.5 + PARAMETERS.back_fewest_contacts * STEP_S
    assert {step.contact.std_s for _, step in steps} == {PARAMETERS.back_contact_std_s}


def test_the_other_foot_leaves_the_ground_after_each_contact():
    all_events = [step for _, step in events(walk())]
    for landed, lifted in zip(all_events[::2], all_events[1::2], strict=True):
        assert lifted.contact.kind is GaitEventKind.TOE_OFF
        assert lifted.side is landed.side.other
        # From the steepest rise to the top is a quarter of a period.
        after_s = STEP_S / 4 + PARAMETERS.back_toe_off_after_top_s - PARAMETERS.back_contact_after_rise_s
        assert (lifted.contact.captured_ns - landed.contact.captured_ns) * 1e-9 == pytest.approx(after_s, abs=0.03)
    assert all(step.contact.captured_ns <= ns for ns, step in events(walk()))


def test_standing_is_no_step():
    random = np.random.default_rng(4)
    rows = [(k * 10_000_000, *(0.3 * random.normal(size=2)).tolist()) for k in range(3000)]
    assert events(rows) == []


def test_two_movements_are_no_walk():
    """Sitting down and getting up again."""
    rows = [(ns, up if 2.0 < ns * 1e-9 < 3.1 else 0.0, 0.0) for ns, up, _ in walk()]
    assert events(rows) == []


def test_a_step_that_is_small_for_the_person_is_no_step():
    loud = walk(seconds=8.0, size=6.0)
    faint = [(ns + 8_000_000_000, up, right) for ns, up, right in walk(seconds=6.0, size=0.5)]
    assert max(step.contact.captured_ns for _, step in found(loud + faint)) < 9e9


def test_a_missed_step_does_not_swap_the_feet():
    rows = [(ns, 0.0 if 5.4 <= ns * 1e-9 < 5.95 else up, right) for ns, up, right in walk()]
    for _, step in found(rows):
        number = round((step.contact.captured_ns * 1e-9 - PARAMETERS.back_contact_after_rise_s) / STEP_S - 0.25)
        assert step.side is (Side.LEFT if number % 2 == 0 else Side.RIGHT)


@pytest.mark.parametrize("cut", [1, 60, 333, 700])
def test_a_resumed_detector_goes_on_alike(cut):
    rows = walk()
    first, resumed = BackStepDetector(PARAMETERS), BackStepDetector(PARAMETERS)
    steps = events(rows[:cut], first)
    resumed.restore(json.loads(json.dumps(first.snapshot())))
    assert steps + events(rows[cut:], resumed) == events(rows)


def test_an_interruption_begins_anew():
    detector = BackStepDetector(PARAMETERS)
    found(walk(seconds=5.0), detector)
    detector.interrupt()
    later = [(ns + 9_000_000_000, up, right) for ns, up, right in walk(seconds=5.0)]
    times = [step.contact.captured_ns * 1e-9 for _, step in found(later, detector)]
    assert min(times) > 9.0
    assert len(times) >= 7
