"""Synthetic patients walk as planned: feet stand still where they were put, sensors feel what the body does."""

import dataclasses
import json
import math

import numpy as np
import pytest

from schemas.vocabulary import LOWER_BODY, Segment, Side
from services.ingest.errors import InvalidOption
from services.ingest.source import open_source
from services.ingest.synthetic.gait import BALL_FROM_ANKLE, HEEL_FROM_ANKLE
from services.ingest.synthetic.motions import parse_motion
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.patients.footfalls import LATERAL
from services.ingest.synthetic.patients.walk import PatientWalk
from services.ingest.synthetic.sensors import measure

CASES = {
    "healthy": "patient=healthy&speed=1.2&seed=21",
    "healthy slow": "patient=healthy&speed=0.3&seed=22",
    "hemiparetic": "patient=hemiparetic&speed=0.4&seed=23&affected=left",
    "stiff knee": "patient=stiff_knee&speed=0.8&seed=24",
    "steppage": "patient=steppage&speed=1.4&seed=25&affected=left",
}
FROM_S, TO_S = 7.0, 13.0


@pytest.fixture(scope="module", params=list(CASES))
def walk(request: pytest.FixtureRequest) -> PatientWalk:
    return PatientWalk(WalkParameters.parse(f"{CASES[request.param]}&duration=20&feet=1"))


def standing(walk: PatientWalk, side: Side, time_s: np.ndarray) -> list[np.ndarray]:
    """Which instants lie within each stance."""
    falls = walk.footfalls.by_side[side]
    within = [(time_s >= fall.contact_s) & (time_s < fall.toe_off_s) for fall in falls]
    return [stance for stance in within if stance.any()]


@pytest.mark.parametrize("side", list(Side))
def test_a_foot_turns_about_heel_or_ball_and_never_slides(walk, side):
    time_s = np.arange(FROM_S, TO_S, 0.002)
    foot = walk.body(time_s).segments[Segment(f"foot_{side}")]
    heel, ball = (foot.point(lever).position for lever in (HEEL_FROM_ANKLE, BALL_FROM_ANKLE))
    assert min(heel[:, 1].min(), ball[:, 1].min()) > -0.01
    for stance in standing(walk, side, time_s):
        # One of the two is on the floor all the time, and that one does not move.
        low = np.where(heel[stance, 1] < ball[stance, 1], 0, 1)
        points = np.stack([heel[stance], ball[stance]])
        assert np.abs(points[low, np.arange(len(low)), 1]).max() < 1e-3
        for which in (0, 1):
            on_the_floor = points[which][low == which][:, [0, 2]]
            if len(on_the_floor):
                assert np.ptp(on_the_floor, axis=0).max() < 1e-3


def test_contacts_and_placements_are_those_of_the_plan(walk):
    """Truth that travels with the samples tells the same footfalls."""
    time_s = np.arange(FROM_S, TO_S, 0.001)
    body = walk.body(time_s)
    start = walk.body(np.array([0.0, FROM_S])).pelvis.position[1]
    for side in Side:
        rises = time_s[1:][np.diff(body.contact[side]) > 0]
        planned = [at for at in walk.footfalls.contacts_s(side) if FROM_S < at < TO_S]
        assert rises == pytest.approx(planned, abs=0.0015)
        for fall in walk.footfalls.by_side[side][1:-1]:
            flat_s = fall.contact_s + 0.45 * (fall.toe_off_s - fall.contact_s)
            if FROM_S < flat_s < TO_S:
                ankle = body.ankle(side).position[round((flat_s - FROM_S) * 1000)] + start * [1, 0, 1]
                assert ankle[[0, 2]] == pytest.approx([fall.forward, fall.aside], abs=0.002)


def test_sensors_agree_with_differences_of_their_own_path(walk):
    h = 5e-4
    time_s = np.arange(FROM_S, FROM_S + 2.0, h)
    strides = walk.strides(time_s)
    body = walk.moved(strides, time_s)
    for mount in walk.mounts:
        segment = body.segments[mount.segment]
        _, force = measure(dataclasses.replace(mount, wobble=0.0), segment, strides.phase, strides.amplitude)
        path = segment.point(mount.position).position
        R_world_from_sensor = segment.R_world_from_body @ mount.R_segment_from_sensor
        second = (path[:-2] - 2 * path[1:-1] + path[2:]) / h**2 + [0.0, 9.81, 0.0]
        felt = np.einsum("nij,nj->ni", R_world_from_sensor[1:-1], force[1:-1])
        # The plan's splines change their third derivative every 4 ms; in the mean that does not matter.
        assert np.sqrt(np.mean((felt - second) ** 2)) < 0.05


def test_knees_never_bend_backward_and_the_body_stands_straight_first(walk):
    time_s = np.arange(0.0, 19.0, 0.01)
    body = walk.body(time_s)
    for side in Side:
        assert body.angles[f"knee_flexion_{side}"].value.min() > -1e-3
    first = {dof.name: body.angles[dof.name].value[:300] for dof in LOWER_BODY}
    assert max(float(np.abs(angle).max()) for angle in first.values()) < 1e-6
    assert np.abs(body.pelvis.acceleration[:300]).max() < 1e-6


def test_speed_is_as_asked_and_steps_follow_the_manner(walk):
    steps = walk.footfalls.steps()[1:-2]
    speed = sum(step.length for step in steps) / sum(step.time_s for step in steps)
    assert speed == pytest.approx(walk.speed, rel=0.05)
    if walk.manner.affected is not None:
        longer = np.mean([s.length for s in steps if s.side is walk.affected])
        other = np.mean([s.length for s in steps if s.side is not walk.affected])
        assert math.log(longer / other) == pytest.approx(walk.manner.step_shift, abs=0.08)


def test_a_stiff_leg_goes_round_and_a_dropped_foot_is_lifted():
    def swing(kind: str) -> tuple[float, float]:
        """Largest knee flexion, rad, and outward swing, m, of the affected leg."""
        walk = PatientWalk(WalkParameters.parse(f"patient={kind}&speed=0.8&seed=5&duration=16"))
        body = walk.body(np.arange(0.0, 15.0, 0.01))
        ankle = LATERAL[walk.affected] * body.ankle(walk.affected).position[700:1000, 2]
        return float(body.angles[f"knee_flexion_{walk.affected}"].value[700:1000].max()), float(np.ptp(ankle))

    healthy, stiff, dropped = (swing(kind) for kind in ("healthy", "stiff_knee", "steppage"))
    assert stiff[0] < healthy[0] - 0.2
    assert stiff[1] > healthy[1] + 0.03
    assert dropped[0] > healthy[0] + 0.15


def test_people_differ_and_are_the_same_again():
    def made(options: str) -> list[np.ndarray]:
        walk = parse_motion("walk", f"patient=hemiparetic&speed=0.5&duration=12&{options}")
        return [block.reference.values for block in walk.samples()]

    once, again, other = made("seed=1"), made("seed=1"), made("seed=2")
    assert all(np.array_equal(a, b) for a, b in zip(once, again, strict=True))
    assert not np.array_equal(once[0], other[0])
    lengths = {PatientWalk(WalkParameters(patient=1, seed=seed)).lengths for seed in range(8)}
    assert len(lengths) == 8


def test_the_tape_is_wrong_about_the_body_but_not_about_the_walk():
    exact, taped = (
        open_source(f"synthetic:walk?patient=healthy&seed=3&duration=10&tape={tape}", session="s").describe()
        for tape in (0, 0.03)
    )
    walk = PatientWalk(WalkParameters(patient=1, seed=3))
    assert exact.anthropometry.thigh_length_m == walk.lengths.thigh
    wrong = taped.anthropometry.thigh_length_m / walk.lengths.thigh - 1.0
    assert 0.0 < abs(wrong) < 0.08


def test_a_hemiparetic_patient_says_which_side():
    for word, side in (("left", Side.LEFT), ("right", Side.RIGHT)):
        described = open_source(f"synthetic:walk?patient=hemiparetic&affected={word}", session="s").describe()
        assert described.conditions.paretic_side is side
        assert "hemiparetic" in described.title
    healthy = open_source("synthetic:walk?patient=healthy", session="s").describe()
    assert healthy.conditions.paretic_side is None
    json.loads(healthy.model_dump_json())


@pytest.mark.parametrize(
    "options",
    ["patient=limping", "patient=healthy&turn_every=9", "patient=healthy&camera=1", "patient=1&duration=9000"],
)
def test_what_patients_cannot_do_is_refused(options):
    with pytest.raises(InvalidOption):
        parse_motion("walk", options)
