"""Inclinations out of angles: the same as of the body's joint centres, with deviations that hold."""

import numpy as np
import pytest

from services.biomech.whole_body.directions import DIRECTIONS, directions
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, WholeBodyModel
from services.biomech.whole_body.observability import arm_elevations, trunk_lean
from services.biomech.whole_body.parameters import lengths_of

ALL = [True] * len(CENTRE_NAMES)
LENGTHS = lengths_of(1.75)


@pytest.fixture(scope="module")
def body() -> WholeBodyModel:
    return WholeBodyModel()


def postures(count: int) -> np.ndarray:
    angles = np.random.default_rng(3).uniform(-0.6, 0.6, (count, len(DOF)))
    angles[:, [DOF["shoulder_adduction_right"], DOF["shoulder_adduction_left"]]] -= 0.7
    angles[:, DOF["pelvis_rotation"]] = 0.0
    return angles


def test_directions_are_those_of_the_joint_centres(body):
    for angles in postures(20):
        q = np.r_[np.zeros(3), angles]
        told = directions(angles, np.zeros(len(angles)), ALL)
        forward, right = trunk_lean(body.centres(q, LENGTHS))
        np.testing.assert_allclose([told[f"trunk_lean_{way}"][0] for way in ("forward", "right")], [forward, right])
        elevations = [told[f"arm_elevation_{side}"][0] for side in ("right", "left")]
        np.testing.assert_allclose(elevations, arm_elevations(body, q, LENGTHS), atol=1e-7)


def test_the_deviation_is_that_of_many_draws():
    rng = np.random.default_rng(5)
    std = np.full(len(DOF), 0.02)
    for angles in postures(3):
        told = directions(angles, std, ALL)
        drawn = [directions(angles + rng.normal(0.0, std), std, ALL) for _ in range(1500)]
        for name, (_, deviation) in told.items():
            assert deviation == pytest.approx(np.std([each[name][0] for each in drawn]), rel=0.1), name


def test_an_arm_that_hangs_is_not_told_as_certain():
    told = directions(np.zeros(22), np.full(22, 0.05), ALL)
    assert told["arm_elevation_right"][1] >= 0.05


def test_what_the_camera_does_not_see_is_not_told():
    seen = [name != "elbow_left" for name in CENTRE_NAMES]
    assert set(directions(np.zeros(22), np.zeros(22), seen)) == set(DIRECTIONS) - {"arm_elevation_left"}
    seen = [name != "spine_shoulder" for name in CENTRE_NAMES]
    assert directions(np.zeros(22), np.zeros(22), seen) == {}
