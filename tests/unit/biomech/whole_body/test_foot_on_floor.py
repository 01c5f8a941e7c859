"""Ankles told by the floor: a shank over a foot that stands flat."""

import json

import numpy as np
import pytest

from services.biomech.whole_body.foot_on_floor import ANKLE_PLACES, FlatFeet
from services.biomech.whole_body.model import DOF

DT_S = 1.0 / 30.0
ALL = np.ones(15, dtype=np.bool_)


def leaning(person, angle: float, turned: float = 0.0) -> np.ndarray:
    """q (25,) of shanks that lean forward by `angle`, thighs upright, ankles where they are with upright shanks."""
    q = np.zeros(25)
    q[3] = turned
    for side in ("right", "left"):
        q[3 + DOF[f"hip_flexion_{side}"]] = 0.0
        q[3 + DOF[f"knee_flexion_{side}"]] = angle
    upright = np.zeros(25)
    upright[3] = turned
    q[:3] = (person.centres(upright) - person.centres(q))[ANKLE_PLACES[0]]
    return q


def step(feet: FlatFeet, person, q: np.ndarray, seen: np.ndarray = ALL):
    pose = person.body.pose(q, person.lengths)
    return feet.step(DT_S, pose.centre, pose.rotation, seen)


def stood(person, turned: float = 0.0) -> FlatFeet:
    feet = FlatFeet(None)
    feet.begin(standing=True)
    for _ in range(30):
        step(feet, person, leaning(person, 0.0, turned))
    return feet


@pytest.mark.parametrize("turned", [0.0, 0.7])
def test_dorsiflexion_is_the_inclination_of_the_shank_over_the_foot(person, turned) -> None:
    feet = stood(person, turned)
    for lean in np.linspace(0.0, 0.5, 60):
        found = step(feet, person, leaning(person, lean, turned))
    assert found.valid.all()
    assert found.angle == pytest.approx([0.5, 0.5], abs=1e-6)
    assert (found.std >= np.radians(4.0)).all()


def test_a_foot_that_is_lifted_has_none_until_it_stands_again(person) -> None:
    feet = stood(person)
    q = leaning(person, 0.2)
    for _ in range(30):
        step(feet, person, q)
    lifted = q.copy()
    lifted[3 + DOF["hip_flexion_right"]] += 0.8
    lifted[3 + DOF["knee_flexion_right"]] += 1.0
    flags = [step(feet, person, lifted).valid for _ in range(30)]
    assert not flags[-1][0]
    assert flags[-1][1]
    flags = [step(feet, person, q).valid for _ in range(30)]
    assert flags[-1].all()
    assert step(feet, person, q).angle == pytest.approx([0.2, 0.2], abs=1e-6)


def test_what_is_not_seen_is_not_valid(person) -> None:
    feet = stood(person)
    hidden = ALL.copy()
    hidden[ANKLE_PLACES[1]] = False
    assert step(feet, person, leaning(person, 0.0), hidden).valid.tolist() == [True, False]


def test_without_a_standing_second_the_cameras_floor_tells_or_nothing_does(person) -> None:
    q = leaning(person, 0.3)
    floor_m = person.centres(q)[ANKLE_PLACES[0]][1] - 0.09
    for known, valid in ((None, False), (floor_m, True), (floor_m - 0.3, False)):
        feet = FlatFeet(known)
        for _ in range(30):
            found = step(feet, person, q)
        assert found.valid.all() == valid
        if valid:
            assert found.angle == pytest.approx([0.3, 0.3], abs=1e-6)


def test_split_and_resume_is_identical(person) -> None:
    generator = np.random.default_rng(3)
    postures = [leaning(person, 0.3 * k / 60) + generator.normal(0.0, 0.003, 25) for k in range(60)]
    whole, first, second = FlatFeet(None), FlatFeet(None), FlatFeet(-1.0)
    for feet in (whole, first):
        feet.begin(standing=True)
    expected = [step(whole, person, q) for q in postures]
    found = [step(first, person, q) for q in postures[:13]]
    second.restore(json.loads(json.dumps(first.snapshot())))
    found += [step(second, person, q) for q in postures[13:]]
    for a, b in zip(expected, found, strict=True):
        assert (a.angle == b.angle).all()
        assert (a.std == b.std).all()
        assert (a.valid == b.valid).all()
