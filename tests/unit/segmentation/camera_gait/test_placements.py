"""Steps on a floor and on a belt, of walkers made by hand."""

import json

import numpy as np
import pytest

from schemas.vocabulary import Side
from services.segmentation.camera_gait.direction import Walker
from services.segmentation.camera_gait.parameters import CameraGaitParameters
from services.segmentation.camera_gait.placements import Placements

SPEED, STRIDE_S, LONGER = 1.0, 1.2, 0.1
STRIDE_M = SPEED * STRIDE_S
HEADING = (0.6, 0.8)


def foot_m(time_s, side):
    """On the ground: still for 0.6 of the stride from each contact, then forward by a stride. Contacts of the right
    foot at whole strides, of the left half a stride later and LONGER / 2 further than the middle."""
    shift_s, shift_m = (0.0, 0.0) if side is Side.RIGHT else (0.5 * STRIDE_S, 0.5 * STRIDE_M + 0.5 * LONGER)
    u, whole = np.modf((time_s - shift_s) / STRIDE_S + 10.0)
    swing = np.clip((u - 0.6) / 0.4, 0.0, 1.0)
    return shift_m + STRIDE_M * (whole - 10.0 + swing**2 * (3 - 2 * swing))


def walked(belt, seconds=12.0, drift=0.0, noise=0.0):
    """Placements after a walk; the person drifts on the belt by `drift`, m/s."""
    placements, rng = Placements(CameraGaitParameters()), np.random.default_rng(3)
    ahead, across = np.array(HEADING), np.array([-HEADING[1], HEADING[0]])
    stood = {Side.RIGHT: 0.0, Side.LEFT: 0.5 * STRIDE_S}
    for time_s in np.arange(0.0, seconds, 1 / 30):
        carried = belt * time_s

        def place(way, aside, carried=carried):
            x, z = (way - carried) * ahead + aside * across + rng.normal(0, noise, 2)
            return float(x), float(z)

        ankles = tuple(place(foot_m(time_s, side), aside) for side, aside in ((Side.LEFT, -0.1), (Side.RIGHT, 0.1)))
        pelvis = place((SPEED + drift) * time_s, 0.0)
        placements.append(round(time_s * 1e9), Walker(pelvis, ankles, (0.0, 0.3)), HEADING)
        for side, contact_s in stood.items():
            if time_s > contact_s + 0.75 * STRIDE_S:
                placements.stood(side, round(contact_s * 1e9), round((contact_s + 0.6 * STRIDE_S) * 1e9))
                stood[side] = contact_s + STRIDE_S
    return placements


def step(placements, leading, number):
    contact_s = number * STRIDE_S + (0.0 if leading is Side.RIGHT else 0.5 * STRIDE_S)
    return placements.step(leading, round(contact_s * 1e9), round((contact_s - 0.5 * STRIDE_S) * 1e9), None)


@pytest.mark.parametrize(("belt", "drift"), [(0.0, 0.0), (SPEED, 0.0), (SPEED, 0.05), (0.7 * SPEED, 0.0)])
def test_steps_are_the_same_on_any_ground(belt, drift):
    placements = walked(belt, drift=drift)
    assert placements.ground_speed == pytest.approx(-belt, abs=1e-6)
    right, left = step(placements, Side.RIGHT, 8), step(placements, Side.LEFT, 8)
    assert right.length_m == pytest.approx(0.5 * (STRIDE_M - LONGER), abs=1e-6)
    assert left.length_m == pytest.approx(0.5 * (STRIDE_M + LONGER), abs=1e-6)


@pytest.mark.parametrize("belt", [0.0, SPEED])
@pytest.mark.parametrize("leading", list(Side))
def test_feet_are_as_far_apart_sideways_on_any_ground(belt, leading):
    placements = walked(belt, drift=0.05)
    contact_ns = round((8.0 if leading is Side.RIGHT else 8.5) * STRIDE_S * 1e9)
    trailing_ns = contact_ns - round(0.5 * STRIDE_S * 1e9)
    assert placements.width(leading, contact_ns, trailing_ns) == pytest.approx(0.2, abs=1e-6)
    assert placements.width(leading, contact_ns, contact_ns + 10**11) is None


@pytest.mark.parametrize("belt", [0.0, SPEED])
def test_the_deviation_covers_noise(belt):
    placements = walked(belt, noise=0.1)
    errors = [
        step(placements, side, k).length_m - 0.5 * (STRIDE_M + sign * LONGER)
        for k in range(5, 9)
        for side, sign in ((Side.RIGHT, -1), (Side.LEFT, 1))
    ]
    std = step(placements, Side.RIGHT, 8).std_m
    assert 0.4 * std < np.sqrt(np.mean(np.square(errors))) < 1.5 * std


def test_a_contact_that_is_told_early_or_late_changes_nothing():
    placements = walked(SPEED)
    contact_ns, trailing_ns = round(8 * STRIDE_S * 1e9), round(7.5 * STRIDE_S * 1e9)
    for off_ns in (0, 60_000_000):
        late = placements.step(Side.RIGHT, contact_ns + off_ns, trailing_ns, None)
        assert late.length_m == pytest.approx(0.5 * (STRIDE_M - LONGER), abs=1e-6)


def test_nothing_is_told_without_a_stance_or_a_place():
    empty = Placements(CameraGaitParameters())
    assert empty.ground_speed is None
    assert empty.step(Side.LEFT, 10**9, 5 * 10**8, None) is None
    placements = walked(0.0)
    assert placements.step(Side.LEFT, round(60e9), round(59e9), None) is None


def test_split_and_resume():
    placements, resumed = walked(SPEED, noise=0.01), Placements(CameraGaitParameters())
    resumed.restore(json.loads(json.dumps(placements.snapshot())))
    assert resumed.snapshot() == placements.snapshot()
    assert step(resumed, Side.RIGHT, 8) == step(placements, Side.RIGHT, 8)
