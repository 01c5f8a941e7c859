"""The synthetic walker obeys physics, keeps its feet where they stand, and tells the truth about itself."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from schemas.imu import ImuBatch, ReferenceBatch
from schemas.vocabulary import LOWER_BODY, Segment, Side
from services.ingest.errors import InvalidOption
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic import SyntheticWalk, WalkParameters, write_recording
from services.ingest.synthetic.gait import BALL_FROM_ANKLE, HEEL_FROM_ANKLE, Strides
from services.ingest.synthetic.jets import Jet
from services.ingest.synthetic.sensors import measure
from services.ingest.synthetic.session import reference_channels

PERFECT = WalkParameters(
    duration=30.0, gyro_noise=0.0, accel_noise=0.0, gyro_bias=0.0, accel_bias=0.0, wander=0.0, feet=1
)
TURNING = dataclasses.replace(
    PERFECT, asymmetry=0.3, turn_every=6.0, stop_every=12.0, soft_tissue=0.05, wander=0.03, duration=40.0
)
CHANNELS = [channel.name for channel in reference_channels()]


def times(start, end, rate=1000.0):
    return np.arange(start, end, 1 / rate)


def truth(walk):
    return np.vstack([block.reference.values for block in walk.samples()])


def channel(values, name):
    return values[:, CHANNELS.index(name)]


def derivative(values, h):
    """Fourth-order central difference; the two instants at each end are lost."""
    return (values[:-4] - 8 * values[1:-3] + 8 * values[3:-1] - values[4:]) / (12 * h)


@pytest.mark.parametrize("parameters", [PERFECT, TURNING])
def test_a_resting_sensor_feels_gravity_and_nothing_else(parameters):
    walk = SyntheticWalk(parameters)
    block = next(walk.samples())
    for track in block.sensors:
        standing = slice(0, round(parameters.standing * parameters.rate))
        assert np.linalg.norm(track.specific_force[standing], axis=1) == pytest.approx(9.81, abs=1e-12)
        assert np.abs(track.angular_velocity[standing]).max() == 0.0


@pytest.mark.parametrize("parameters", [PERFECT, TURNING], ids=["straight", "turning"])
@pytest.mark.parametrize("index", range(7))
def test_sensors_agree_with_differences_of_their_own_path(parameters, index):
    """The sensor's place and orientation, differentiated numerically, give its angular velocity and specific force."""
    walk = SyntheticWalk(parameters)
    mount = walk.mounts[index]
    h = 2.5e-4
    time_s = times(9.5, 12.0, 1 / h)
    strides = walk.strides(time_s)
    body = walk.gait.body(strides, time_s)
    segment = body.segments[mount.description.segment]
    rate, force = measure(dataclasses.replace(mount, wobble=0.0), segment, strides.phase, strides.amplitude)
    path = segment.point(np.array(mount.description.position_in_segment)).position
    R_world_from_sensor = segment.R_world_from_body @ mount.R_segment_from_sensor
    acceleration = derivative(derivative(path, h), h)
    expected = np.einsum("nji,nj->ni", R_world_from_sensor[4:-4], acceleration + np.array([0, 9.81, 0]))
    assert np.abs(force[4:-4] - expected).max() < 2e-3
    turn = np.einsum("nji,njk->nik", R_world_from_sensor[:-2], R_world_from_sensor[2:])
    assert np.abs(rate[1:-1] - Rotation.from_matrix(turn).as_rotvec() / (2 * h)).max() < 2e-2


def test_soft_tissue_turns_the_sensor_and_its_gyro_alike():
    walk = SyntheticWalk(TURNING)
    mount = walk.mounts[1]
    h = 1e-3
    strides = walk.strides(times(8.0, 10.0, 1 / h))
    body = walk.gait.body(strides)
    rate, force = measure(mount, body.segments[mount.description.segment], strides.phase, strides.amplitude)
    still, firm = measure(
        dataclasses.replace(mount, wobble=0.0), body.segments[Segment.THIGH_RIGHT], strides.phase, strides.amplitude
    )
    assert 0.2 < np.abs(rate - still).max() < 1.5
    assert np.linalg.norm(force, axis=1) == pytest.approx(np.linalg.norm(firm, axis=1))


def test_gyros_integrate_to_the_true_angles():
    """Thigh and shank gyros, mounted without twist, integrated through 10 s, against the truth's knee."""
    walk = SyntheticWalk(dataclasses.replace(PERFECT, mounting=0.0, rate=500.0, turn_every=5.0, duration=16.0))
    blocks = list(walk.samples())
    R = {}
    for mount, tracks in zip(walk.mounts, zip(*(block.sensors for block in blocks), strict=True), strict=True):
        rate = np.vstack([track.angular_velocity for track in tracks])
        R[mount.description.name] = integrated(rate, 1 / 500) @ mount.R_segment_from_sensor.T
    knee = np.einsum("nji,njk->nik", R["thigh_right"], R["shank_right"])
    # Started level, so the product is R_thigh_from_shank; its first rotation about -z is knee flexion.
    flexion = -Rotation.from_matrix(knee).as_euler("ZXY")[:, 0]
    assert np.abs(flexion - channel(truth(walk), "knee_flexion_right")).max() < 1e-3


def integrated(rate, h):
    """R_world_from_sensor from midpoint steps; each sensor starts as the standing person carries it."""
    nominal = np.column_stack([[0, 1, 0], [0, 0, 1], [1, 0, 0]])
    turns = Rotation.from_rotvec((rate[:-1] + rate[1:]) / 2 * h).as_matrix()
    found = [nominal]
    for turn in turns:
        found.append(found[-1] @ turn)
    return np.array(found)


def test_truth_of_the_angles_is_the_pose_of_the_segments():
    walk = SyntheticWalk(TURNING)
    time_s = times(6.0, 12.0, 100.0)
    body = walk.body(time_s)
    value = {name: angle.value for name, angle in body.angles.items()}
    pelvis = Rotation.from_matrix(body.segments[Segment.PELVIS].R_world_from_body)
    angles = np.column_stack([value["pelvis_rotation"], -value["pelvis_tilt"], -value["pelvis_obliquity"]])
    expected = Rotation.from_euler("YZX", angles)
    assert (pelvis.inv() * expected).magnitude().max() < 1e-9
    for side, mirror in ((Side.RIGHT, 1), (Side.LEFT, -1)):
        thigh = Rotation.from_matrix(body.segments[Segment(f"thigh_{side}")].R_world_from_body)
        hip = np.column_stack(
            [
                value[f"hip_flexion_{side}"],
                mirror * value[f"hip_adduction_{side}"],
                mirror * value[f"hip_internal_rotation_{side}"],
            ]
        )
        assert ((pelvis.inv() * thigh).inv() * Rotation.from_euler("ZXY", hip)).magnitude().max() < 1e-9


@pytest.mark.parametrize("speed", [0.3, 0.7, 1.1, 1.6])
def test_feet_in_single_support_stay_where_they_are(speed):
    walk = SyntheticWalk(dataclasses.replace(PERFECT, speed=speed, asymmetry=0.2))
    body = walk.body(times(9.0, 15.0, 500.0))
    flat = 0
    for side in Side:
        alone = (body.contact[side] == 1) & (body.contact[side.other] == 0)
        foot = body.segments[Segment(f"foot_{side}")]
        heel, ball = foot.point(HEEL_FROM_ANKLE), foot.point(BALL_FROM_ANKLE)
        # Uneven steps begin single support a thousandth of a stride before the foot is quite flat.
        assert np.linalg.norm(ball.velocity[alone], axis=1).max() < 1e-4
        assert np.abs(ball.position[alone, 1]).max() < 1e-6
        lying = alone & (np.abs(foot.angular_velocity).max(axis=1) == 0)
        assert np.linalg.norm(heel.velocity[lying], axis=1).max() < 1e-9
        flat += lying.sum()
        assert body.contact[side].mean() == pytest.approx(0.62, abs=0.05)
        swinging = body.contact[side] == 0
        assert ball.position[swinging, 1].min() > -0.02
    assert flat > 500


def test_one_foot_at_least_is_always_down():
    values = truth(SyntheticWalk(TURNING))
    assert (channel(values, "foot_contact_left") + channel(values, "foot_contact_right")).min() >= 1


@pytest.mark.parametrize("speed", [0.3, 0.5, 0.8, 1.1, 1.4, 1.6])
def test_speed_is_the_one_asked_for(speed):
    walk = SyntheticWalk(dataclasses.replace(PERFECT, speed=speed, duration=90.0))
    values = truth(walk)
    stride_s = 1 / walk.timeline.frequency_hz
    start, end = 1000, 1000 + round(100 * 20 * stride_s)
    forward = channel(values, "pelvis_x")
    assert (forward[end] - forward[start]) / (20 * stride_s) == pytest.approx(speed, rel=2e-3)
    assert channel(values, "walking_speed")[start:end] == pytest.approx(speed, rel=1e-3)
    assert channel(values, "walking_speed")[:300].max() == 0.0


def test_steps_add_up_to_the_way():
    """Step length: forward distance of the ankles at contact; two steps are a stride of the pelvis."""
    walk = SyntheticWalk(dataclasses.replace(PERFECT, asymmetry=0.3, speed=1.0))
    values = truth(walk)
    lead = channel(values, "ankle_right_x") - channel(values, "ankle_left_x")
    contact = np.flatnonzero(np.diff(channel(values, "foot_contact_right")) > 0)[4:10] + 1
    opposite = np.flatnonzero(np.diff(channel(values, "foot_contact_left")) > 0) + 1
    for start, end in itertools.pairwise(contact):
        (middle,) = opposite[(opposite > start) & (opposite < end)]
        stride = channel(values, "pelvis_x")[end] - channel(values, "pelvis_x")[start]
        # Between contacts the standing ankle rolls forward over the ball of the foot, which is not a step.
        assert 0.75 * stride < lead[end] - lead[middle] < stride
        assert lead[end] > 0.3
        assert lead[middle] < -0.3


def test_asymmetry_is_seen_in_the_angles():
    values = truth(SyntheticWalk(dataclasses.replace(PERFECT, asymmetry=0.25)))
    left, right = (np.ptp(channel(values, f"knee_flexion_{side}")) for side in ("left", "right"))
    assert left / right == pytest.approx(0.75, abs=0.01)


def test_turns_and_stops():
    walk = SyntheticWalk(TURNING)
    values = truth(walk)
    heading = channel(values, "pelvis_rotation")
    assert heading.max() > math.pi - 0.2
    assert len(walk.timeline.bouts) == 2
    first, second = walk.timeline.bouts
    between = slice(round(100 * (first.end_s + 0.01)), round(100 * (second.start_s - 0.01)))
    assert np.ptp(values[between][:, :15], axis=0).max() == 0
    assert (channel(values, "foot_contact_left")[between] == 1).all()
    assert second.start_s - first.end_s == pytest.approx(TURNING.pause)


def test_accelerations_are_those_of_a_walk():
    walk = SyntheticWalk(dataclasses.replace(PERFECT, speed=1.3))
    pelvis = walk.body(times(9.0, 15.0, 200.0)).pelvis
    assert np.abs(pelvis.acceleration).max() < 12.0
    assert np.ptp(pelvis.position[:, 1]) < 0.08


def lines(spec):
    return list(iter_messages(open_source(spec, session="s")))


def test_the_same_seed_is_the_same_walk():
    assert lines("synthetic:walk?duration=12&seed=5") == lines("synthetic:walk?duration=12&seed=5")
    other = lines("synthetic:walk?duration=12&seed=6")
    assert lines("synthetic:walk?duration=12&seed=5")[0] != other[0]


def test_blocks_are_seamless():
    walk = SyntheticWalk(dataclasses.replace(PERFECT, duration=25.0))
    values = truth(walk)
    assert np.abs(np.diff(channel(values, "pelvis_x"))).max() < 0.03
    assert np.abs(np.diff(channel(values, "ankle_left_x"))).max() < 0.06
    assert len(values) == 2500


def test_noise_bias_and_mounting_are_what_was_asked_for():
    parameters = WalkParameters(duration=30.0, standing=25.0, gyro_noise=0.02, accel_noise=0.2, seed=9)
    walk = SyntheticWalk(parameters)
    blocks = list(walk.samples())[:2]
    for index, mount in enumerate(walk.mounts):
        rate = np.vstack([block.sensors[index].angular_velocity for block in blocks])
        force = np.vstack([block.sensors[index].specific_force for block in blocks])
        assert rate.std(axis=0) == pytest.approx(0.02, rel=0.1)
        assert force.std(axis=0) == pytest.approx(0.2, rel=0.1)
        assert rate.mean(axis=0) == pytest.approx(mount.gyro_bias, abs=0.002)
        outward = mount.R_segment_from_sensor @ [0, 0, 1]
        assert np.linalg.norm(outward) == pytest.approx(1)
        assert np.linalg.det(mount.R_segment_from_sensor) == pytest.approx(1)


def test_a_bias_drifts_as_fast_as_was_asked_for():
    steady = WalkParameters(duration=30.0, standing=25.0, seed=9)
    walks = [SyntheticWalk(p) for p in (steady, dataclasses.replace(steady, gyro_drift=0.06))]
    rates = [next(walk.samples()).sensors[0].angular_velocity for walk in walks]
    drift = walks[1].mounts[0].gyro_drift
    np.testing.assert_allclose((rates[1] - rates[0])[[0, 500]], [[0, 0, 0], 5.0 * drift], atol=1e-12)
    drawn = [mount.gyro_drift * 600.0 for mount in walks[1].mounts]
    assert np.std(drawn) == pytest.approx(0.06, rel=0.4)


@pytest.mark.parametrize(
    ("worn", "names", "estimator", "words"),
    [
        (1, ["thigh_left", "shank_left"], "knee_axis", "left leg alone"),
        (2, ["thigh_right", "shank_right"], "knee_axis", "right leg alone"),
        (3, ["pelvis"], "rhythmic_ekf", "pelvis alone"),
    ],
)
@pytest.mark.parametrize("motion", ["walk", "march"])
def test_sensors_left_off_change_nothing_for_the_others(motion, worn, names, estimator, words):
    options = f"synthetic:{motion}?duration=6&seed=3&soft_tissue=0.02"
    every, some = (open_source(spec, session="s") for spec in (options, f"{options}&worn={worn}"))
    description = some.describe()
    assert ([sensor.name for sensor in description.hubs[0].sensors], description.estimator) == (names, estimator)
    assert description.title == f"{every.describe().title}, {description.title.rpartition(', ')[2]}"
    assert words in description.title
    places = [[sensor.name for sensor in every.describe().hubs[0].sensors].index(name) for name in names]
    for whole, part in zip(iter_messages(every), iter_messages(some), strict=True):
        if isinstance(whole.payload, ImuBatch):
            assert [whole.payload.sensors[place] for place in places] == part.payload.sensors
        else:
            assert whole.payload == part.payload


def test_shoes_are_worn_beside_any_sensors():
    hubs = open_source("synthetic:walk?duration=6&worn=2&feet=1").describe().hubs
    assert [sensor.name for sensor in hubs[0].sensors] == ["thigh_right", "shank_right", "foot_right", "foot_left"]
    chosen = open_source("synthetic:walk?duration=6&worn=2", estimator="ekf").describe()
    assert chosen.estimator == "ekf"


def test_jets_follow_the_rules_of_calculus():
    t = np.linspace(0.1, 1.0, 7)
    clock = Jet(t, np.ones_like(t), np.zeros_like(t))
    sine = clock.scaled(3.0).through(lambda x: (np.sin(x), np.cos(x), -np.sin(x)))
    product = sine * clock
    assert product.rate == pytest.approx(np.sin(3 * t) + 3 * t * np.cos(3 * t))
    assert product.acceleration == pytest.approx(6 * np.cos(3 * t) - 9 * t * np.sin(3 * t))


def test_standing_is_the_datum():
    walk = SyntheticWalk(PERFECT)
    still = Jet.constant(0.0, np.zeros(3))
    body = walk.gait.body(Strides(Jet.constant(0.56, np.zeros(3)), still, still))
    assert all(np.abs(angle.value).max() == 0 for angle in body.angles.values())
    assert list(body.angles) == [dof.name for dof in LOWER_BODY]
    assert body.pelvis.position[:, 1] == pytest.approx(0.41 + 0.40 + 0.08)


@pytest.mark.parametrize(
    ("spec", "word"),
    [
        ("synthetic:walk?speed=9", "0.3 .. 1.6"),
        ("synthetic:walk?speed=fast", "not a number"),
        ("synthetic:walk?speed=nan", "outside"),
        ("synthetic:walk?colour=1", "colour"),
        ("synthetic:walk?seed=1.5", "not a number"),
        ("synthetic:walk?speed", "no list of options"),
        ("synthetic:walk?duration=1e99", "outside"),
    ],
)
def test_impossible_options_are_refused(spec, word):
    with pytest.raises(InvalidOption, match=word):
        open_source(spec)


def test_no_truth_no_reference_stream():
    source = open_source("synthetic:walk?truth=0&duration=8")
    assert source.describe().reference == []
    assert {message.stream.name for message in iter_messages(source)} == {"imu/walker"}


def test_a_written_walk_replays_as_it_was_made(tmp_path):
    options = "duration=10&seed=4&speed=0.9"
    write_recording(tmp_path / "walk", options)
    made, replayed = lines(f"synthetic:walk?{options}"), lines(str(tmp_path / "walk"))
    assert [message.envelope for message in made] == [message.envelope for message in replayed]
    for one, other in zip(made, replayed, strict=True):
        match one.payload, other.payload:
            case ImuBatch() as a, ImuBatch() as b:
                for x, y in zip(a.sensors, b.sensors, strict=True):
                    assert y.specific_force[0] == pytest.approx(x.specific_force[0], abs=1e-6)
                    assert y.angular_velocity[0] == pytest.approx(x.angular_velocity[0], abs=1e-6)
            case ReferenceBatch() as a, ReferenceBatch() as b:
                assert b.values[0] == pytest.approx(a.values[0], abs=1e-6)
    first, again = (open_source(spec).describe() for spec in (f"synthetic:walk?{options}", str(tmp_path / "walk")))
    assert first.hubs == again.hubs
    assert first.reference == again.reference
    assert first.anthropometry == again.anthropometry
