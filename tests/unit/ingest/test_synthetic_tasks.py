"""People before a simulated depth camera: what is seen is consistent with the truth, and faults are as asked for."""

import dataclasses

import numpy as np
import pytest

from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import ANKLES, WHOLE_BODY, CameraKind, JointCentre, Task, TrackingState
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, WholeBodyModel
from services.biomech.whole_body.pinocchio_whole_body import PinocchioWholeBody
from services.ingest.errors import InvalidOption
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic import write_recording
from services.ingest.synthetic.motions import parse_motion
from services.ingest.synthetic.whole_body.body import place
from services.ingest.synthetic.whole_body.camera import CLINIC, INFERRED, NOT_TRACKED, TRACKED, see
from services.ingest.synthetic.whole_body.outline import ANKLE_HEIGHT_M, JOINTS
from services.ingest.synthetic.whole_body.people import person

MOTIONS = ("squat", "steps", "tilt_forward", "tilt_aside")
PERFECT = "noise=0"


def frames_of(spec):
    return [message for message in iter_messages(open_source(spec)) if message.stream.signal.name == "skeleton"]


def test_the_body_placed_at_once_is_that_of_pinocchio():
    rng, who = np.random.default_rng(3), person(4)
    body = WholeBodyModel(who.trunk_joint)
    q, bends = rng.uniform(-1.0, 1.0, (6, 25)), rng.uniform(-0.3, 0.3, (6, 2))
    placed, oracle = place(body, q, who.lengths, bends), PinocchioWholeBody(body, who.lengths, supple=True)
    for k in range(len(q)):
        centres, carriers = oracle.supple_frames(q[k], bends[k])
        assert np.allclose(placed.centres[k], centres, atol=1e-12)
        assert np.allclose(placed.carriers[k], carriers, atol=1e-12)


@pytest.mark.parametrize("motion", MOTIONS)
def test_a_perfect_camera_sees_what_the_angles_say(motion):
    session = parse_motion(motion, PERFECT)
    truth, seen = session.truth, session.seen
    assert np.array_equal(seen.captured_ns, np.round(truth.time_s * 1e9))
    assert (seen.state == TRACKED).all()
    legs = [CENTRE_NAMES.index(JointCentre(f"{name}_{side}")) for name in ("hip", "knee", "ankle")
            for side in ("right", "left")]  # fmt: skip
    body = WholeBodyModel(session.who.trunk_joint)
    for k in range(0, len(truth.q), 97):
        assert np.allclose(seen.position[k][legs], body.centres(truth.q[k], session.who.lengths)[legs], atol=1e-9)


@pytest.mark.parametrize("motion", MOTIONS)
def test_feet_stay_where_they_are_on_the_floor(motion):
    session = parse_motion(motion, f"{PERFECT}&camera_height=1.3&distance=3")
    floor_m = session.description().cameras[0].floor_m
    assert floor_m == -1.3
    ankles = session.truth.placed.centres[:, [CENTRE_NAMES.index(JointCentre(f"ankle_{s}")) for s in ("right", "left")]]
    # Angles drift on their own, so a leg is at times longer than the other; nobody walks away.
    lowest = ankles[:, :, 1].min(axis=1)
    assert np.abs(lowest - floor_m - ANKLE_HEIGHT_M).max() < 0.05
    assert np.abs(ankles[:, :, 2]).max() < 0.3
    assert np.median(ankles[:, :, 0]) == pytest.approx(-3.0, abs=0.05)


def test_a_level_foot_under_a_leaning_shank_is_dorsiflexed():
    truth = parse_motion("squat", PERFECT).truth
    shank = truth.q[:, 3 + DOF["knee_flexion_right"]] - (
        truth.q[:, 3 + DOF["hip_flexion_right"]] - truth.q[:, 3 + DOF["pelvis_tilt"]]
    )
    assert truth.dorsiflexion[:, 0] == pytest.approx(shank, abs=np.radians(3.0))
    assert truth.dorsiflexion[:, 0].max() > np.radians(15.0)


@pytest.mark.parametrize("motion", MOTIONS)
def test_repetitions_are_counted_where_something_moves(motion):
    session = parse_motion(motion, f"{PERFECT}&repetitions=6")
    truth = session.truth
    assert set(truth.repetition) == {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}
    followed = {"squat": "knee_flexion_right", "steps": "hip_flexion_left", "tilt_forward": "trunk_flexion",
                "tilt_aside": "pelvis_obliquity"}[motion]  # fmt: skip
    angle = truth.q[:, 3 + DOF[followed]]
    within = [np.ptp(angle[truth.repetition == k]) for k in range(1, 7)]
    assert min(within) > 3 * np.ptp(angle[: int(2.5 * 30)])
    two_sided = motion in ("steps", "tilt_aside")
    assert set(truth.side) == ({-1.0, 0.0, 1.0} if two_sided else {0.0})
    if two_sided:
        right = truth.side == 1.0
        hips = {side: truth.q[:, 3 + DOF[f"hip_{'flexion' if motion == 'steps' else 'adduction'}_{side}"]]
                for side in ("right", "left")}  # fmt: skip
        assert hips["right"][right].mean() > hips["left"][right].mean()


def test_dials_do_what_they_say():
    usual = parse_motion("squat", PERFECT)
    knee = usual.truth.q[:, 3 + DOF["knee_flexion_right"]]
    assert parse_motion("squat", f"{PERFECT}&hold=2").duration_s == pytest.approx(usual.duration_s + 20.0, abs=0.1)
    assert parse_motion("squat", f"{PERFECT}&pause=2").duration_s == pytest.approx(usual.duration_s + 20.0, abs=0.5)
    assert parse_motion("squat", f"{PERFECT}&set_of=5&rest=9").duration_s == pytest.approx(
        usual.duration_s + 9, abs=0.1
    )
    assert parse_motion("squat", f"{PERFECT}&standing=8").duration_s == pytest.approx(usual.duration_s + 5.0, abs=0.1)
    slow = parse_motion("squat", f"{PERFECT}&tempo=10").truth
    starts = slow.time_s[np.flatnonzero(np.diff(slow.repetition) > 0)]
    assert np.diff(starts).mean() == pytest.approx(6.0, rel=0.06)
    lame = parse_motion("squat", f"{PERFECT}&asymmetry=0.3").truth.q[:, 3:]
    ranges = [np.ptp(lame[:, DOF[f"knee_flexion_{side}"]]) for side in ("right", "left")]
    assert ranges[1] / ranges[0] == pytest.approx(0.7, abs=0.06)
    tired = parse_motion("squat", f"{PERFECT}&fatigue=0.5").truth
    last = tired.q[tired.repetition == 10, 3 + DOF["knee_flexion_right"]]
    assert np.ptp(last) == pytest.approx(0.5 * np.ptp(knee), rel=0.15)
    partial = parse_motion("squat", f"{PERFECT}&partials=0.5").truth.repetition
    assert 2 <= len({number for number in partial if number < 0}) <= 8


def test_without_standing_the_session_begins_on_the_way():
    truth = parse_motion("squat", f"{PERFECT}&standing=0").truth
    assert truth.repetition[0] == 0.0
    assert set(truth.repetition) == {0.0, *(float(k) for k in range(2, 11))}
    assert truth.q[0, 3 + DOF["knee_flexion_right"]] > 0.5 * truth.q[:, 3 + DOF["knee_flexion_right"]].max()


def test_the_same_seed_is_the_same_session_and_another_is_not():
    first, again, other = (parse_motion("steps", f"seed={seed}").seen for seed in (5, 5, 6))
    for a, b in zip(first, again, strict=True):
        assert np.array_equal(a, b, equal_nan=True)
    assert not np.array_equal(first.captured_ns, other.captured_ns)
    assert parse_motion("steps", "person=2").who.stature != parse_motion("steps", "person=3").who.stature


def test_messages_carry_all_joints_and_the_truth_of_every_frame():
    source = open_source("synthetic:squat?repetitions=2&seed=4")
    description, messages = source.describe(), list(iter_messages(source))
    (camera,) = description.cameras
    assert (camera.kind, camera.rate_hz, camera.joints) == (CameraKind.KINECT_V2, 30.0, list(JOINTS))
    assert len(JOINTS) == 25
    assert description.task is Task.SQUAT
    assert description.estimator == "body_cekf"
    names = [channel.name for channel in description.reference]
    assert names[:24] == [dof.name for dof in (*WHOLE_BODY, *ANKLES)]
    assert names[24:26] == ["repetition", "repetition_side"]
    seen = [m for m in messages if isinstance(m.payload, SkeletonBatch)]
    told = [m for m in messages if m.stream.signal.name == "reference" and m.payload is not None]
    assert len(told) == int(description.duration_s * 30)
    # 2 % of the frames never come.
    assert 0.93 * len(told) < len(seen) < len(told)
    assert {m.envelope.captured_ns for m in seen} <= {m.envelope.captured_ns for m in told}
    assert all(len(m.payload.position[0]) == 25 and m.payload.body == [1] for m in seen)


def test_noise_is_that_of_a_clinic():
    """Recipe, section 3: offsets and white noise of 30 and 10 mm, pooled 0.0013 to 0.0015 m^2, guesses, outliers."""
    errors, states, offsets = [], [], []
    for number in range(1, 9):
        session = parse_motion("tilt_forward", f"person={number}&seed={number}&drops=0&repetitions=4")
        truth = session.truth.placed
        seen = see(truth, np.random.default_rng(number), (number,), CLINIC, 30.0)
        came = (seen.state != NOT_TRACKED).any(axis=1)
        errors.append((seen.centres - truth.centres)[came])
        states.append(seen.state[came])
        offsets.append(np.median(errors[-1], axis=0))
    error, state = np.concatenate(errors), np.concatenate(states)
    assert np.var(error, axis=(0, 1)) == pytest.approx([0.0015, 0.0014, 0.0013], rel=0.35)
    assert np.std(offsets) == pytest.approx(0.03, rel=0.15)
    looked_at = (JointCentre.ANKLE_LEFT, JointCentre.KNEE_LEFT, JointCentre.SPINE_BASE)
    ankle, knee, spine = (state[:, CENTRE_NAMES.index(name)] == INFERRED for name in looked_at)
    assert ankle.mean() == pytest.approx(0.12, rel=0.3)
    assert knee.mean() == pytest.approx(0.03, rel=0.5)
    assert not spine.any()
    step = np.diff(error[:, CENTRE_NAMES.index(JointCentre.SPINE_BASE)], axis=0)
    assert np.median(np.abs(step)) / 0.6745 == pytest.approx(0.010 * np.sqrt(2.0), rel=0.1)
    far = np.linalg.norm(error - np.median(error, axis=0), axis=2)[state == TRACKED] > 0.2
    assert 0.002 < far.mean() < 0.03


def test_half_the_noise_is_half_as_large():
    truth = parse_motion("tilt_forward", "repetitions=4").truth.placed
    whole, half = (see(truth, np.random.default_rng(1), (1,), CLINIC.scaled(share), 30.0) for share in (1.0, 0.5))
    ratio = np.nanmedian(np.abs(half.centres - truth.centres)) / np.nanmedian(np.abs(whole.centres - truth.centres))
    assert ratio == pytest.approx(0.5, abs=0.08)


def test_who_leaves_the_view_comes_back_as_another_body():
    frames = frames_of("synthetic:squat?repetitions=3&away_at=6&away_for=5&noise=0")
    away = [m for m in frames if m.payload and 6e9 <= m.envelope.captured_ns < 11e9]
    assert len(away) == pytest.approx(150, abs=2)
    for message in away:
        (state,) = message.payload.state
        assert set(state) == {TrackingState.NOT_TRACKED}
        assert message.payload.body == [None]
        assert message.payload.people == [0]
    bodies = [m.payload.body[0] for m in frames if m.payload and m not in away]
    assert bodies == sorted(bodies)
    assert set(bodies) == {1, 2}


def test_a_passer_hides_what_is_behind():
    session = parse_motion("squat", "passer_at=8&passer_for=3&noise=0")
    seen = session.seen
    passing = (seen.captured_ns >= 8e9) & (seen.captured_ns < 11e9)
    assert set(seen.people[passing]) == {2}
    assert set(seen.people[~passing]) == {1}
    assert set(seen.body) == {1}
    hidden = (seen.state == NOT_TRACKED).any(axis=1)
    assert hidden.any()
    assert not hidden[~passing].any()
    assert np.isnan(seen.position[seen.state == NOT_TRACKED]).all()


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize(
    ("options", "word"),
    [
        ("noise=2", "noise"), ("distance=0", "distance"), ("repetitions=0", "repetitions"), ("jitter=0.1", "jitter"),
        ("standing=-1", "standing"), ("frame_rate=nan", "frame_rate"), ("tempo=fast", "tempo"), ("speed=1", "speed"),
    ],
)  # fmt: skip
def test_impossible_options_are_refused_by_name(motion, options, word):
    with pytest.raises(InvalidOption, match=word):
        open_source(f"synthetic:{motion}?{options}")


def test_a_bow_has_no_sides():
    with pytest.raises(InvalidOption, match="asymmetry"):
        open_source("synthetic:tilt_forward?asymmetry=0.2")


def test_every_dial_has_a_range_and_a_meaning():
    for motion in MOTIONS:
        for dial in dataclasses.fields(parse_motion(motion, "").parameters):
            assert dial.metadata["low"] <= dial.default <= dial.metadata["high"]
            assert dial.metadata["meaning"]


@pytest.mark.parametrize(
    ("motion", "options"),
    [("squat", "repetitions=2&seed=3&away_at=6&away_for=1"), ("walk", "camera=1&duration=10&seed=4")],
)
def test_a_written_folder_is_the_same_session(tmp_path, motion, options):
    write_recording(tmp_path / "made", options, "straight", motion=motion)
    written, made = open_source(str(tmp_path / "made")), open_source(f"synthetic:{motion}?{options}")
    a, b = written.describe(), made.describe()
    assert (a.title, a.task, a.estimator, a.reference) == (b.title, b.task, b.estimator, b.reference)
    assert [hub.name for hub in a.hubs] == [hub.name for hub in b.hubs]
    assert a.anthropometry == b.anthropometry
    assert [(c.name, c.kind, c.rate_hz, c.floor_m) for c in a.cameras] == [
        (c.name, c.kind, c.rate_hz, c.floor_m) for c in b.cameras
    ]
    frames, expected = (
        {message.envelope.captured_ns: message.payload for message in iter_messages(source)
         if isinstance(message.payload, SkeletonBatch)}
        for source in (written, made)
    )  # fmt: skip
    zero_ns = min(expected) - min(frames)
    assert len(frames) == len(expected)
    order = [a.cameras[0].joints.index(joint) for joint in JOINTS]
    for at, batch in frames.items():
        nearest = min(expected, key=lambda other: abs(other - zero_ns - at))
        assert abs(nearest - zero_ns - at) < 5000
        same = expected[nearest]
        assert [batch.state[0][j] for j in order] == same.state[0]
        for j, position in zip(order, same.position[0], strict=True):
            assert batch.position[0][j] == (None if position is None else pytest.approx(position, abs=1e-6))
        assert (batch.body[0] is None) == (same.body[0] is None)
    assert written.rejections() == []
