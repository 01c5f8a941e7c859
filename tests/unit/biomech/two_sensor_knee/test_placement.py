"""Sensors worn otherwise than declared."""

import numpy as np
import pytest

from schemas.vocabulary import Misplacement, Side
from services.bench.knee.legs import Sensors, record, walking
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.biomech.two_sensor_knee.placement import is_upside_down, leg_worn_on, misplacements

UP = np.tile([0.0, 1.0, 0.0], (2, 1))
OUTWARD_RIGHT = np.tile([0.0, 0.0, 1.0], (2, 1))
OVER = np.diag([-1.0, -1.0, 1.0])


def worn(R=None, *, swap=False):
    leg = record(walking(), 20.0, 100.0, Sensors() if R is None else Sensors(R))
    order = [1, 0] if swap else [0, 1]
    estimator = KneeAxis()
    estimator.run(leg.rate[:, order], leg.force[:, order], 0.01)
    return estimator


def found(estimator, side=Side.RIGHT):
    return misplacements(estimator.arms, estimator.up, estimator.axes, UP, OUTWARD_RIGHT, side)


def test_nothing_is_found_where_all_is_well():
    assert found(worn()) == ()


def test_swapped_sensors_are_named():
    assert Misplacement.SWAPPED in found(worn(swap=True))


@pytest.mark.parametrize(
    ("segment", "name"), [(0, Misplacement.THIGH_UPSIDE_DOWN), (1, Misplacement.SHANK_UPSIDE_DOWN)]
)
def test_a_sensor_upside_down_is_named(segment, name):
    R = np.tile(np.eye(3), (2, 1, 1))
    R[segment] = OVER
    assert found(worn(R)) == (name,)


def test_the_other_leg_is_named():
    assert found(worn(), Side.LEFT) == (Misplacement.OTHER_LEG,)


def test_a_sensor_in_front_tells_no_leg():
    assert leg_worn_on(np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.1])) is None


def test_a_tilted_sensor_is_not_upside_down():
    assert not is_upside_down(np.array([0.8, 0.6, 0.0]), np.array([0.0, 1.0, 0.0]))
