"""A misplacement is named after many looks, and not for a posture."""

import json

import numpy as np
import pytest

from schemas.session import Placement
from schemas.vocabulary import Misplacement, Side
from services.biomech.worn_legs import worn_legs
from services.estimation.knee.estimator import Evidence
from services.estimation.knee.placement_watch import PlacementWatch
from services.estimation.parameters import KneeParameters
from tests.unit.estimation.knee import knee_legs as legs

P = KneeParameters()
UP = np.array([[1.0, 0.0, 0.0]] * 2)
ARMS = np.array([[-0.2, 0.0, -0.05], [0.15, 0.0, -0.05]])
LEFT = np.array([[0.0, 0.0, 1.0]] * 2)
RIGHTLY_WORN = Evidence(ARMS, UP, LEFT)
SWAPPED = Evidence(-ARMS, UP, LEFT)


def watch(side: Side = Side.LEFT, **options) -> PlacementWatch:
    return PlacementWatch(side, worn_legs(legs.describe(side, **options))[0].sensors, P)


def looks(watching: PlacementWatch, evidence: Evidence, count: int) -> list[Misplacement]:
    for _ in range(count):
        watching.look(evidence)
    return watching.found


@pytest.mark.parametrize(
    ("evidence", "found"),
    [
        (RIGHTLY_WORN, []),
        (SWAPPED, [Misplacement.SWAPPED]),
        (Evidence(ARMS, UP * [[-1.0], [1.0]], LEFT), [Misplacement.THIGH_UPSIDE_DOWN]),
        (Evidence(ARMS * [[1.0], [-1.0]], UP * [[1.0], [-1.0]], LEFT), [Misplacement.SHANK_UPSIDE_DOWN]),
        (Evidence(ARMS, UP, -LEFT), [Misplacement.OTHER_LEG]),
        (Evidence(None, UP, None), []),
        (Evidence(ARMS, np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]), LEFT), []),
    ],
    ids=["right", "swapped", "thigh", "shank", "other leg", "nothing known", "seated"],
)
def test_what_is_seen_again_and_again_is_named(evidence, found):
    watching = watch()
    if evidence.arms is not None and found == [Misplacement.THIGH_UPSIDE_DOWN]:
        evidence = evidence._replace(arms=ARMS * [[-1.0], [1.0]])
    assert looks(watching, evidence, int(P.votes) - 2) == []
    assert looks(watching, evidence, 6) == found


def test_a_leg_that_was_seen_the_right_way_up_is_not_swapped():
    """Raised for half a minute of motion by somebody who lies."""
    watching = watch(upward=None)
    looks(watching, RIGHTLY_WORN, 30)
    assert looks(watching, SWAPPED, 60) == []


def test_a_whole_leg_that_points_up_says_nothing():
    raised = Evidence(-ARMS, -UP, LEFT)
    assert looks(watch(), Evidence(ARMS, -UP, LEFT)._replace(arms=ARMS), 0) == []
    assert looks(watch(), Evidence(ARMS, -UP, LEFT), 40) == []
    assert looks(watch(), raised, 0) == []


def test_exchanged_sensors_are_withdrawn():
    watching = watch()
    assert looks(watching, SWAPPED, 20) == [Misplacement.SWAPPED]
    assert watching.suspects_swap
    assert looks(watching, RIGHTLY_WORN, 10) == [Misplacement.SWAPPED]
    assert looks(watching, RIGHTLY_WORN, 12) == []
    assert not watching.suspects_swap


def test_the_inner_side_of_a_leg_is_the_outer_one_of_the_other():
    assert looks(watch(placement=Placement.MEDIAL), RIGHTLY_WORN, 20) == [Misplacement.OTHER_LEG]
    assert looks(watch(Side.RIGHT, placement=Placement.MEDIAL), RIGHTLY_WORN, 20) == []
    assert looks(watch(placement=Placement.ANTERIOR), Evidence(ARMS, UP, -LEFT), 20) == []


def test_a_resting_leg_is_not_looked_at():
    watching = watch()
    assert not any(watching.is_due(0.1, 0.02) for _ in range(200))
    assert watching.is_due(1.0, 0.02)
    assert [watching.is_due(1.0, 0.25) for _ in range(4)] == [False, True, False, True]


def test_votes_survive_a_restart():
    first, second = watch(), watch()
    looks(first, SWAPPED, 7)
    first.is_due(1.0, 0.1)
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert second.snapshot() == first.snapshot()
    assert looks(second, SWAPPED, 4) == [Misplacement.SWAPPED]
