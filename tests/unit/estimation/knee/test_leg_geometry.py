"""Frames from an axis, what a thigh does, and the chain of angles: against rotations of a moving leg."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from schemas.session import Anthropometry, Placement
from schemas.vocabulary import Segment, Side
from services.biomech.forward_kinematics import segment_poses
from services.biomech.lower_body import LowerBodyModel
from services.biomech.rhythm.trusted import TrustedRhythm
from services.biomech.worn_legs import worn_legs
from services.estimation.knee.chain_of_angles import ChainOfAngles
from services.estimation.knee.estimator import KneeSample, frame_from_axis_and_up, thigh_motion
from services.estimation.knee.leg import LegState
from services.estimation.knee.mounting import leftward, upward
from services.estimation.knee.plane import plane_of
from services.estimation.parameters import KneeParameters
from tests.unit.estimation.knee import knee_legs as legs

SENSOR = Rotation.random(rng=3)
LEFT, UP = np.array([0.0, 0.0, -1.0]), np.array([0.0, 1.0, 0.0])


def test_a_frame_has_its_axis_exactly():
    axis = SENSOR.apply(LEFT)
    R = frame_from_axis_and_up(axis, SENSOR.apply(UP) + 0.3 * axis)
    np.testing.assert_allclose(R, SENSOR.inv().as_matrix(), atol=1e-12)
    for degenerate in (axis, -2.0 * axis):
        frame = frame_from_axis_and_up(axis, degenerate)
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
        assert frame[2] @ axis == pytest.approx(-1.0)


@pytest.mark.parametrize("lean", [0.0, 0.3, -0.4])
def test_inclination_and_heading_of_a_thigh_are_those_of_its_rotations(lean):
    """World from thigh = Ry(heading) Rx(lean) Rz(inclination), each of them moving."""

    def pose(t):
        return Rotation.from_euler("YXZ", [0.4 + 0.5 * t, lean + 0.2 * t, 0.7 + 1.5 * t])

    def measured(t):
        h = 1e-6
        rate_in_thigh = (pose(t - h).inv() * pose(t + h)).as_rotvec() / (2 * h)
        return SENSOR.apply(rate_in_thigh), SENSOR.apply(pose(t).inv().apply(UP))

    rate, up = measured(0.1)
    inclination, forward_rate, turn_rate = thigh_motion(SENSOR.apply(LEFT), SENSOR.apply(UP), up, rate)
    assert inclination == pytest.approx(0.7 + 0.15, abs=1e-9)
    assert turn_rate == pytest.approx(0.5, abs=1e-6)
    assert forward_rate == pytest.approx(float(SENSOR.inv().apply(rate)[2]), abs=1e-12)


def test_a_leg_on_its_side_has_no_heading():
    up = SENSOR.apply(LEFT)
    assert thigh_motion(SENSOR.apply(LEFT), SENSOR.apply(UP), up, up)[2] == 0.0


def test_the_plane_tells_how_a_resting_segment_leans():
    plane = plane_of(np.stack([LEFT, LEFT]), np.stack([UP, UP + 0.2 * LEFT]))
    back = Rotation.from_rotvec(0.3 * LEFT)
    assert plane.tilts(9.8 * np.stack([UP, back.inv().apply(UP)])) == pytest.approx((0.0, 0.3))


def state(flexion, inclination, rates=(0.0, 0.0), turn=0.0, valid=True):
    return LegState(KneeSample(flexion, 0.05, rates[0], inclination, rates[1], turn, valid), valid, 0.01)


def chain(*sides):
    return ChainOfAngles(sides, TrustedRhythm(4), KneeParameters())


@pytest.mark.parametrize("side", list(Side))
def test_the_chain_of_angles_gives_thigh_and_shank_their_tilt(side):
    rows = chain(side)
    rows.row(0, [state(0.5, 0.3, turn=1.0)])
    row = rows.row(1_000_000_000, [state(0.5, 0.3, turn=1.0)])
    body = Anthropometry(
        height_m=None, mass_kg=None, thigh_length_m=0.4, shank_length_m=0.4, hip_width_m=0.2, source="default"
    )
    poses = segment_poses(LowerBodyModel(body), np.array(row.position))
    for segment, tilt in (("thigh", 0.3), ("shank", 0.3 - 0.5)):
        R = poses[Segment(f"{segment}_{side}")].R_world_from_segment
        np.testing.assert_allclose(R, Rotation.from_euler("YZ", [1.0, tilt]).as_matrix(), atol=1e-9)


def test_only_the_knee_is_valid_and_only_while_it_is():
    rows = chain(Side.RIGHT, Side.LEFT)
    valid = rows.validity([state(0.1, 0.1, valid=False), state(0.1, 0.1)])
    assert [name for name, flag in zip(legs.NAMES, valid, strict=True) if flag] == ["knee_flexion_left"]
    assert not any(rows.validity([None, state(0.1, 0.1, valid=False)]))


def test_accelerations_are_those_of_the_rates():
    rows = chain(Side.LEFT)
    row = None
    for k in range(100):
        row = rows.row(10_000_000 * k, [state(0.0, 0.0, rates=(0.02 * k, -0.01 * k))])
    i = legs.NAMES.index("knee_flexion_left")
    assert row.acceleration[i] == pytest.approx(2.0, rel=1e-3)
    assert row.acceleration[legs.NAMES.index("hip_flexion_left")] == pytest.approx(-1.0, rel=1e-3)
    assert rows.row(1_000_000_000, [state(0.0, 0.0, valid=False)]).acceleration[i] == 0.0


def test_a_resumed_chain_goes_on_alike():
    first, second = chain(Side.LEFT), chain(Side.LEFT)
    for k in range(20):
        first.row(10_000_000 * k, [state(0.1 * k, 0.0, (1.0, 2.0), 0.5)])
    second.restore(json.loads(json.dumps(first.snapshot())))
    last = [each.row(200_000_000, [state(2.0, 0.1, (1.5, 2.5), 0.5)]) for each in (first, second)]
    assert last[0][:6] == last[1][:6]


@pytest.mark.parametrize(
    ("side", "placement", "left"),
    [
        (Side.LEFT, Placement.LATERAL, [0, 0, 1]),
        (Side.RIGHT, Placement.LATERAL, [0, 0, -1]),
        (Side.LEFT, Placement.MEDIAL, [0, 0, -1]),
        # x up, z forward: left = up x forward.
        (Side.LEFT, Placement.ANTERIOR, [0, -1, 0]),
        (Side.RIGHT, Placement.POSTERIOR, [0, 1, 0]),
    ],
)
def test_left_as_the_placement_tells_it(side, placement, left):
    sensor = worn_legs(legs.describe(side, placement=placement))[0].sensors[0]
    np.testing.assert_allclose(leftward(sensor), left, atol=1e-12)
    np.testing.assert_allclose(upward(sensor), [1, 0, 0])


def test_nothing_is_told_of_a_sensor_of_unknown_placement():
    unknown = worn_legs(legs.describe(placement=Placement.UNKNOWN))[0].sensors[0]
    in_front = worn_legs(legs.describe(placement=Placement.ANTERIOR, upward=None))[0].sensors[0]
    assert leftward(unknown) is None
    assert leftward(in_front) is None
    assert upward(in_front) is None
