"""Orientation filters made into a knee: on a synthetic leg with known headings and axes."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.bench.knee.hinge_peer import heading_between, tie_headings
from services.bench.knee.legs import Sensors, orientation, record, walking
from services.bench.knee.orientation_filters import FILTERS
from services.bench.knee.peers import missing

RATE_HZ = 50.0
Z_UP = Rotation.from_rotvec([np.pi / 2, 0.0, 0.0])
"""From the leg's world, y up, to one with z up."""


def leg():
    sensors = Sensors(Rotation.random(2, rng=3).as_matrix())
    motion = walking(start_s=1.0)
    samples = record(motion, 15.0, RATE_HZ, sensors)
    t = np.arange(1, len(samples.flexion) + 1) / RATE_HZ
    return samples, [(Z_UP * orientation(motion, sensors, s, t)).as_matrix() for s in range(2)]


@pytest.mark.parametrize("start", [None, 0.6])
def test_lost_headings_and_axes_are_found(start):
    samples, (thigh, shank) = leg()
    turned = Rotation.from_rotvec([0.0, 0.0, -0.7]).as_matrix() @ shank
    relative, axes = tie_headings(thigh, turned, samples.rate, RATE_HZ, start)
    known = np.swapaxes(thigh, 1, 2) @ shank
    off = Rotation.from_matrix(np.swapaxes(relative, 1, 2) @ known).magnitude()
    assert np.degrees(np.median(off)) < 3.0
    assert np.abs(np.sum(axes * samples.axes, axis=1)) == pytest.approx(1.0, abs=0.003)
    assert np.prod(np.sign(np.sum(axes * samples.axes, axis=1))) > 0


def test_the_heading_between_two_worlds():
    _, (thigh, shank) = leg()
    turned = Rotation.from_rotvec([0.0, 0.0, -0.7]).as_matrix() @ shank[100]
    assert heading_between(thigh[100], turned, thigh[100], shank[100]) == pytest.approx(0.7)


@pytest.mark.parametrize("name", FILTERS)
def test_every_filter_knows_up(name):
    filtered, library = FILTERS[name]
    reason = missing(library)
    if reason is not None:
        pytest.skip(reason)
    samples, known = leg()
    found = filtered(samples.rate[:, 0], samples.force[:, 0], RATE_HZ)
    tilt = np.degrees(np.arccos(np.clip(np.sum(found[:, 2] * known[0][:, 2], axis=1), -1.0, 1.0)))
    assert np.median(tilt[100:]) < 6.0
