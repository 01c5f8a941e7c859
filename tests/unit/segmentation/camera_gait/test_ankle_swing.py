"""Swings of an ankle made by hand, at 30 Hz."""

import json
from itertools import pairwise

import numpy as np
import pytest

from schemas.vocabulary import GaitEventKind
from services.segmentation.camera_gait.ankle_swing import AnkleSwingDetector
from services.segmentation.camera_gait.parameters import CameraGaitParameters

IC, TO = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF
STRIDE_S, REACH = 1.2, 0.3


def ahead(time_s, reach=REACH):
    """m: foremost at whole strides, hindmost half-way between."""
    return reach * np.cos(2 * np.pi * time_s / STRIDE_S)


def found_in(values, times_s, detector=None):
    detector = detector or AnkleSwingDetector(CameraGaitParameters())
    events = [detector.step(round(t * 1e9), float(v)) for t, v in zip(times_s, values, strict=True)]
    return [event for event in events if event is not None]


def times(seconds, from_s=0.3):
    return np.arange(from_s, from_s + seconds, 1 / 30)


@pytest.mark.parametrize("noise", [0.0, 0.006])
def test_contact_and_toe_off_are_at_the_turning_points(noise):
    p, at = CameraGaitParameters(), times(20)
    found = found_in(ahead(at) + np.random.default_rng(0).normal(0, noise, len(at)), at)
    contacts = np.array([one.captured_ns / 1e9 for one in found if one.kind is IC]) - p.contact_after_foremost_s
    lifts = np.array([one.captured_ns / 1e9 for one in found if one.kind is TO]) - p.toe_off_after_hindmost_s
    assert len(contacts) == 16
    assert len(lifts) in (16, 17)
    late = contacts - STRIDE_S * np.round(contacts / STRIDE_S)
    later = lifts - STRIDE_S * (np.round(lifts / STRIDE_S - 0.5) + 0.5)
    assert abs(late.mean()) < 0.01
    assert abs(later.mean()) < 0.01
    assert max(late.std(), later.std()) < (0.006 if noise == 0.0 else 0.02)


def test_no_foot_comes_down_twice_whatever_comes():
    rng = np.random.default_rng(2)
    at = times(60)
    values = np.cumsum(rng.normal(0, 0.08, len(at)))
    kinds = [one.kind for one in found_in(values, at)]
    assert len(kinds) > 10
    assert not any(a is IC and b is IC for a, b in pairwise(kinds))


def test_shuffles_and_noise_are_no_swings():
    at = times(10)
    assert found_in(ahead(at, reach=0.04), at) == []
    assert found_in(np.random.default_rng(1).normal(0, 0.012, len(at)), at) == []


def test_a_foot_that_comes_to_rest_is_put_down_where_it_stopped():
    p, at = CameraGaitParameters(), times(6)
    stop_s = 4 * STRIDE_S
    values = np.where(at < stop_s, ahead(at), REACH)
    last = found_in(values, at)[-1]
    assert last.kind is IC
    assert last.std_s == p.resting_contact_std_s
    assert last.captured_ns / 1e9 >= stop_s


def test_an_interruption_gives_up_the_swing_and_keeps_what_is_usual():
    detector, at = AnkleSwingDetector(CameraGaitParameters()), times(6)
    found_in(ahead(at), at, detector)
    usual = list(detector.state.own_swings)
    detector.interrupt()
    assert detector.state.own_swings == usual
    assert not detector.state.swinging
    again = found_in(ahead(times(6, 8.0)), times(6, 8.0), detector)
    assert {one.kind for one in again} == {IC, TO}


@pytest.mark.parametrize("cut", [5, 22, 40, 61])
def test_split_and_resume(cut):
    at = times(6)
    whole = found_in(ahead(at), at)
    first, second = (AnkleSwingDetector(CameraGaitParameters()) for _ in range(2))
    found = found_in(ahead(at[:cut]), at[:cut], first)
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert found + found_in(ahead(at[cut:]), at[cut:], second) == whole
