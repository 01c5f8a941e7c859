"""A walker with inertial sensors before a camera: one body, two views of it, and one truth for both."""

import numpy as np
import pytest

from schemas.vocabulary import ANKLES, WHOLE_BODY, JointCentre, Segment, Side
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, LENGTH_NAMES, WholeBodyModel
from services.ingest.errors import InvalidOption
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic import SyntheticWalk, WalkParameters
from services.ingest.synthetic.motions import parse_motion

PERFECT = "noise=0&drops=0&jitter=0&frame_rate=50&duration=24"
LEGS = tuple(f"{name}_{side}" for name in ("hip", "knee", "ankle") for side in ("right", "left"))


def truth_of(session, names):
    """Channels by name at the instants of the inertial sensors."""
    channels = [channel.name for channel in session.description().reference]
    values = np.concatenate([block.reference.values for block in session.samples()])
    return {name: values[:, channels.index(name)] for name in names}


@pytest.fixture(scope="module", params=["walk", "march"])
def session(request):
    rate = "rate=100&" if request.param == "march" else ""
    return parse_motion(request.param, f"{rate}camera=1&{PERFECT}&seed=3")


@pytest.fixture(scope="module")
def seen(session):
    blocks = [block.skeleton for block in session.samples()]
    return tuple(np.concatenate([getattr(block, name) for block in blocks]) for name in ("captured_ns", "position"))


def test_legs_are_those_that_the_sensors_feel(session, seen):
    captured_ns, position = seen
    time_s = captured_ns / 1e9
    body = session.body(time_s)
    base = position[:, CENTRE_NAMES.index(JointCentre.SPINE_BASE)]
    for side in Side:
        for segment, name in (("thigh", "hip"), ("shank", "knee"), ("foot", "ankle")):
            origin = body.segments[Segment(f"{segment}_{side}")].origin.position - body.pelvis.position
            away = position[:, CENTRE_NAMES.index(JointCentre(f"{name}_{side}"))] - base
            assert np.abs(away - origin).max() < 1e-9


def test_centres_are_those_of_the_true_angles(session, seen):
    """Every second instant of the sensors is a frame; trunk and arms are bent aside, ankles are off the hinge."""
    captured_ns, position = seen
    names = [dof.name for dof in WHOLE_BODY]
    truth = truth_of(session, names)
    angles = np.column_stack([truth[name] for name in names])[::2]
    assert len(angles) - len(captured_ns) in (0, 1)
    columns = [CENTRE_NAMES.index(JointCentre(name)) for name in (*LEGS[:4], "spine_mid")]
    for k in range(0, len(captured_ns), 53):
        q = np.concatenate([position[k, 0], angles[k]])
        expected = WholeBodyModel().centres(q, session.camera.lengths)[columns]
        assert np.abs(position[k][columns] - expected).max() < 1e-9


def test_bones_have_the_lengths_that_are_told(session, seen):
    _, position = seen
    lengths = dict(zip(LENGTH_NAMES, session.camera.lengths, strict=True))
    assert lengths["thigh_left"] == session.parameters.thigh_length
    for bone, (start, end) in {
        "thigh_left": ("hip_left", "knee_left"), "shank_right": ("knee_right", "ankle_right"),
        "upper_arm_left": ("shoulder_left", "elbow_left"), "forearm_right": ("elbow_right", "wrist_right"),
    }.items():  # fmt: skip
        a, b = (position[:, CENTRE_NAMES.index(JointCentre(name))] for name in (start, end))
        assert np.linalg.norm(b - a, axis=1) == pytest.approx(lengths[bone], abs=1e-9)


def test_the_walker_stays_before_the_camera_on_the_floor(session, seen):
    _, position = seen
    base = position[:, CENTRE_NAMES.index(JointCentre.SPINE_BASE)]
    assert np.abs(base[:, 0] + 2.5).max() < 0.4
    assert np.abs(base[:, 2]).max() < 0.1
    ankles = position[:, [CENTRE_NAMES.index(JointCentre(f"ankle_{side}")) for side in Side], 1].min(axis=1)
    assert ankles.min() > -1.0
    assert np.median(ankles) == pytest.approx(-0.92, abs=0.03)


def test_arms_swing_against_the_legs():
    truth = truth_of(parse_motion("walk", f"camera=1&{PERFECT}"), ("hip_flexion_right", "shoulder_flexion_right",
                                                                "shoulder_flexion_left"))  # fmt: skip
    walking = slice(1000, 1900)
    hip, right, left = (values[walking] for values in truth.values())
    assert np.corrcoef(hip, right)[0, 1] < -0.9
    assert np.corrcoef(hip, left)[0, 1] > 0.9
    assert np.degrees(np.ptp(right)) > 15


def test_a_foot_on_the_ground_is_level():
    session = parse_motion("walk", f"camera=1&{PERFECT}")
    names = ["ankle_dorsiflexion_right", "knee_flexion_right", "hip_flexion_right", "pelvis_tilt"]
    ankle, knee, hip, tilt = (values[:300] for values in truth_of(session, names).values())
    assert ankle == pytest.approx(knee - hip + tilt, abs=1e-6)  # standing: straight, shanks upright


def test_the_camera_changes_nothing_of_what_the_sensors_say():
    with_camera, without = (
        SyntheticWalk(WalkParameters(duration=12.0, seed=2, camera=camera)) for camera in (1, 0)
    )  # fmt: skip
    for a, b in zip(with_camera.samples(), without.samples(), strict=True):
        for x, y in zip(a.sensors, b.sensors, strict=True):
            assert np.array_equal(x.specific_force, y.specific_force)
            assert np.array_equal(x.angular_velocity, y.angular_velocity)
        assert np.array_equal(a.reference.values[:, : b.reference.values.shape[1]], b.reference.values)


def test_posture_bends_the_standing_body_and_feet_stay_on_the_floor():
    session = parse_motion("walk", f"camera=1&posture=1&{PERFECT}")
    truth = truth_of(session, ("knee_flexion_right", "hip_adduction_left", "pelvis_tilt"))
    for name, values in truth.items():
        assert values[:300] == pytest.approx(session.camera.posture[name])
    assert truth["knee_flexion_right"][0] > 0
    position = next(session.samples()).skeleton.position
    ankles = position[:100, [CENTRE_NAMES.index(JointCentre(f"ankle_{side}")) for side in Side], 1]
    assert ankles == pytest.approx(-0.92, abs=0.02)


def test_both_views_and_the_truth_come_as_one_session():
    source = open_source("synthetic:walk?camera=1&duration=12")
    description, messages = source.describe(), list(iter_messages(source))
    assert description.estimator == "fusion"
    assert description.walk_path == "straight"
    assert [hub.name for hub in description.hubs] == ["walker"]
    assert [camera.name for camera in description.cameras] == ["kinect"]
    names = [channel.name for channel in description.reference]
    assert {dof.name for dof in (*WHOLE_BODY, *ANKLES)} <= set(names)
    assert len(names) == len(set(names))
    assert {channel.unit for channel in description.reference if channel.name in DOF} == {"rad"}
    times = [message.envelope.captured_ns for message in messages if message.payload is not None]
    assert times == sorted(times)
    frames = [m.envelope.captured_ns for m in messages if m.stream.signal.name == "skeleton" and m.payload is not None]
    assert len(set(frames)) == len(frames)
    assert 0.93 * 12 * 30 < len(frames) <= 12 * 30


def test_the_camera_may_be_alone():
    description = open_source("synthetic:walk?camera=2&duration=12").describe()
    assert description.hubs == []
    assert description.estimator == "body_cekf"
    assert {m.stream.signal.name for m in iter_messages(open_source("synthetic:walk?camera=2&duration=6"))} == {
        "skeleton", "reference",
    }  # fmt: skip


def test_either_source_may_be_away_for_a_while():
    spec = (
        "synthetic:walk?camera=1&duration=20&noise=0&imu_away_at=8&imu_away_for=3&camera_away_at=14&camera_away_for=2"
    )
    silent, blind = [], []
    for stream, envelope, payload in ((m.stream, m.envelope, m.payload) for m in iter_messages(open_source(spec))):
        if payload is None:
            continue
        if stream.signal.name == "imu":
            silent.append(envelope.captured_ns / 1e9)
        if stream.signal.name == "skeleton" and payload.body == [None]:
            blind.append(envelope.captured_ns / 1e9)
    gaps = np.diff(silent)
    assert gaps.max() == pytest.approx(3.01, abs=0.011)
    assert silent[int(gaps.argmax())] == pytest.approx(7.99, abs=0.011)
    assert (min(blind), max(blind)) == (pytest.approx(14.0, abs=0.05), pytest.approx(16.0, abs=0.05))


@pytest.mark.parametrize(
    ("options", "word"),
    [("camera=1&turn_every=10", "turn_every"), ("camera=1&duration=7200", "duration"), ("camera=3", "camera")],
)
def test_what_no_camera_sees_is_refused(options, word):
    with pytest.raises(InvalidOption, match=word):
        open_source(f"synthetic:walk?{options}")
