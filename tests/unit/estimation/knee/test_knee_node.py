"""A knee session: what it says from the first sample on, and that nothing but captured time decides."""

import json
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from schemas.kinematics import LivePose
from schemas.session import Placement, StandingInterval
from schemas.vocabulary import KNEE_ESTIMATORS, Segment, SensorState, Side
from services.bench.knee.legs import cycling, seated_flexion, walking
from services.biomech.rotations import angle_between, matrix_from_quaternion
from services.estimation.knee.node import KneeNode
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.node import build
from services.estimation.refusal import RefusingNode
from tests.unit.estimation.knee import knee_legs as legs

KNEE = "knee_flexion_left"
SECONDS = {"knee_axis": 16.0, "knee_axis_mcgrath": 40.0, "knee_band": 16.0, "knee_band_grover": 58.0}


@cache
def walk(seconds: float = 16.0):
    return legs.leg(walking(), seconds)


@cache
def undisturbed():
    return tuple(legs.run(legs.node(), legs.messages(walk())))


def test_every_sample_leads_to_a_row_those_before_the_axis_was_believed_too():
    outputs = undisturbed()
    states = legs.states(outputs)
    times = [t for state in states for t in state.captured_ns]
    assert times == [legs.time_ns(k) for k in range(len(walk().rate))]
    assert [o.payload.captured_ns for o in outputs if o.signal.name == "rhythm"] == [s.captured_ns for s in states]
    assert max(len(state.captured_ns) for state in states) <= 50
    # The axis is found some seconds into the walk, and the whole of it is valid.
    first = min(p.captured_ns for p in legs.pictures(outputs) if p.phase == "estimating")
    assert 5e9 < first < 11e9
    assert min(legs.valid_times(outputs, KNEE)) <= 1.1e9
    assert len(legs.valid_times(outputs, KNEE)) > 0.9 * len(times)


def test_the_angle_is_right_from_the_first_step_on():
    error = legs.errors_deg(undisturbed(), walk())
    # A sensor that soft tissue carries is not where it is while standing.
    assert abs(error.mean()) < 3.0
    assert error.std() < 2.5


def test_thigh_and_shank_have_their_tilt_and_turning():
    outputs, valid = undisturbed(), sorted(legs.valid_times(undisturbed(), KNEE))
    hip = legs.series(outputs, "hip_flexion_left")
    truth = {legs.time_ns(k): a for k, a in enumerate(walking().thigh(np.arange(1, 801) / legs.RATE_HZ))}
    assert np.degrees(np.std([hip[t] - truth[t] for t in valid])) < 3.0
    rate = legs.series(outputs, "hip_flexion_left", "velocity")
    steps = [(hip[b] - hip[a]) * legs.RATE_HZ for a, b in pairwise(valid)]
    assert np.corrcoef(steps, [rate[t] for t in valid[1:]])[0, 1] > 0.98
    heading = legs.series(outputs, "pelvis_rotation")
    assert np.degrees(np.ptp([heading[t] for t in valid])) < 25.0
    assert {tuple(s.observed) for s in legs.states(outputs) if s.valid[legs.NAMES.index(KNEE)]} == {
        (Segment.THIGH_LEFT, Segment.SHANK_LEFT)
    }


def test_the_calibration_says_how_the_sensors_sit():
    (calibration,) = legs.calibrations(undisturbed())
    assert (calibration.estimator, calibration.datum[:14]) == ("knee_axis", "quiet standing")
    assert calibration.quality > 0.5
    assert calibration.misplaced == {}
    assert {side.value: source.value for side, source in calibration.events_from.items()} == {
        "left": "shank", "right": "nothing",
    }  # fmt: skip
    for sensor, truth in zip(calibration.sensors, legs.mounting(), strict=True):
        R = matrix_from_quaternion(np.array(sensor.quat_segment_from_sensor))
        for axis in range(3):
            assert np.degrees(angle_between(R[axis], truth[:, axis])) < 4.0


def test_the_page_says_what_to_do_and_draws_one_leg():
    poses = legs.pictures(undisturbed())
    words = list(dict.fromkeys((pose.phase, pose.message) for pose in poses))
    assert words == [
        ("waiting", "Bend and stretch the knee a few times"),
        ("calibrating", "Bend and stretch the knee a few times"),
        ("estimating", ""),
    ]
    assert np.median(np.diff([pose.captured_ns for pose in poses])) == 40_000_000
    last = poses[-1]
    assert [bone.segment for bone in last.segments] == [Segment.THIGH_LEFT, Segment.SHANK_LEFT]
    assert all(bone.valid for bone in last.segments)
    assert list(last.angles) == [KNEE]
    assert {status.state for status in last.sensors} == {SensorState.OK}


@pytest.mark.parametrize("estimator", list(KNEE_ESTIMATORS))
def test_split_and_resume_is_identical(estimator):
    description = legs.describe(estimator=estimator)
    stream = legs.messages(legs.leg(walking(), SECONDS[estimator]), ticks=5)
    whole = legs.text(legs.run(KneeNode(description), stream))
    assert any(legs.states([o]) for o in legs.run(KneeNode(description), stream))
    for split in (20, 75, len(stream) - 8) if estimator == "knee_axis" else (len(stream) // 4, len(stream) - 8):
        first, second = KneeNode(description), KneeNode(description)
        outputs = [output for message in stream[:split] for output in first.step(message)]
        second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
        assert legs.text(outputs + legs.run(second, stream[split:])) == whole
        assert second.rejections() == first.rejections()


def test_two_sessions_interleaved_equal_each_alone():
    streams = [legs.messages(legs.leg(walking(), 12.0, seed), ticks=2) for seed in (0, 1)]
    alone = [legs.text(legs.run(legs.node(), stream)) for stream in streams]
    nodes, mixed = [legs.node(), legs.node()], [[], []]
    for pair in zip(*streams, strict=True):
        for i, message in enumerate(pair):
            mixed[i] += nodes[i].step(message)
    assert [legs.text(mixed[i] + nodes[i].finish()) for i in range(2)] == alone
    assert alone[0] != alone[1]


@pytest.mark.parametrize("ticks", [3, 10])
def test_batches_change_no_number(ticks):
    outputs = legs.run(legs.node(), legs.messages(walk(), ticks=ticks))
    for quantity in ("position", "velocity", "acceleration", "position_std"):
        assert legs.series(outputs, KNEE, quantity) == legs.series(undisturbed(), KNEE, quantity)
    assert legs.valid_times(outputs, KNEE) == legs.valid_times(undisturbed(), KNEE)
    assert [c.model_dump() for c in legs.calibrations(outputs)] == [
        c.model_dump() for c in legs.calibrations(undisturbed())
    ]


def test_a_marked_standing_is_the_zero_from_then_on():
    """Who stood with a bent knee first: the straight standing before the walk is marked while walking."""
    stream = legs.marked(legs.messages(walk()), 1.0, 2.6, 9.6)
    outputs = legs.run(legs.node(), stream)
    before, after = legs.calibrations(outputs)
    assert after.datum.startswith("the standing that was marked")
    assert before.datum != after.datum
    assert "Angles refer to the marked standing from now on" in {p.notice for p in legs.pictures(outputs)}
    assert abs(legs.errors_deg(outputs, walk())[-300:].mean()) < 2.0


def test_a_mark_before_the_axis_is_known_is_kept_for_it():
    outputs = legs.run(legs.node(), legs.marked(legs.messages(walk()), 0.5, 2.5, 2.6))
    (calibration,) = legs.calibrations(outputs)
    assert calibration.datum.startswith("the standing that was marked")
    assert "Standing taken as marked" in {p.notice for p in legs.pictures(outputs)}
    assert abs(legs.errors_deg(outputs, walk()).mean()) < 2.0


def test_a_mark_in_motion_is_refused_with_its_reason():
    outputs = legs.run(legs.node(), legs.marked(legs.messages(walk()), 10.0, 12.0, 12.1))
    assert len(legs.calibrations(outputs)) == 1
    assert {"Not taken as standing: the person moved"} <= {p.notice for p in legs.pictures(outputs)}
    assert legs.series(outputs, KNEE) == legs.series(undisturbed(), KNEE)


def test_a_standing_of_the_description_is_the_zero():
    interval = StandingInterval(from_ns=500_000_000, to_ns=2_500_000_000)
    description = legs.describe().model_copy(update={"standing": [interval]})
    (calibration,) = legs.calibrations(legs.run(legs.node(description), legs.messages(walk())))
    assert calibration.datum.startswith("the standing that was marked")


def test_a_cyclist_who_never_stood_gets_the_straightest_knee_as_zero():
    recording = legs.leg(cycling(), 20.0)
    outputs = legs.run(legs.node(), legs.messages(recording))
    calibration = legs.calibrations(outputs)[-1]
    assert "nobody stood still" in calibration.datum
    assert calibration.quality <= 0.4
    error = legs.errors_deg(outputs, recording)
    assert error.std() < 3.0, "right as changes"
    flexion = legs.series(outputs, KNEE)
    assert 0.0 < np.quantile([flexion[t] for t in legs.valid_times(outputs, KNEE)], 0.05) < 0.2


def test_a_seated_leg_without_a_known_placement_is_asked_to_stand():
    description = legs.describe(placement=Placement.UNKNOWN, upward=None)
    outputs = legs.run(legs.node(description), legs.messages(legs.leg(seated_flexion(), 20.0), ticks=5))
    assert not legs.states(outputs)
    assert legs.pictures(outputs)[-1].message.startswith("Stand still and upright for two seconds")


def test_a_seated_leg_whose_placement_is_known_needs_no_standing():
    recording = legs.leg(seated_flexion(), 20.0)
    outputs = legs.run(legs.node(), legs.messages(recording, ticks=5))
    assert legs.errors_deg(outputs, recording).std() < 2.5


@pytest.mark.parametrize("side", list(Side))
def test_either_leg_has_its_own_coordinates(side):
    # The outer side of the left leg is the inner one of the right.
    recording, placement = walk(), Placement.LATERAL if side is Side.LEFT else Placement.MEDIAL
    description = legs.describe(side, placement=placement)
    outputs = legs.run(legs.node(description), legs.messages(recording, ticks=5))
    assert legs.valid_times(outputs, f"knee_flexion_{side}")
    assert not legs.valid_times(outputs, f"knee_flexion_{side.other}")
    assert abs(legs.errors_deg(outputs, recording, side).mean()) < 3.0


def test_a_band_is_known_at_once_and_the_published_one_after_its_thousand_samples():
    outputs = legs.run(legs.node(legs.describe(estimator="knee_band")), legs.messages(walk()))
    assert min(legs.valid_times(outputs, KNEE)) < 1.1e9
    assert legs.errors_deg(outputs, walk()).std() < 3.0
    recording = legs.leg(walking(), 58.0)
    late = legs.run(legs.node(legs.describe(estimator="knee_band_grover")), legs.messages(recording, ticks=5))
    times = sorted(t for s in legs.states(late) for t in s.captured_ns)
    assert times[0] > 49e9
    assert np.mean(np.diff(times)) == pytest.approx(5e7, rel=0.01), "20 Hz, as published"
    assert "of 1000 samples" in legs.pictures(late)[0].message


def test_the_published_axis_publishes_what_it_held():
    recording = legs.leg(walking(), 40.0)
    outputs = legs.run(legs.node(legs.describe(estimator="knee_axis_mcgrath")), legs.messages(recording, ticks=5))
    times = sorted(t for s in legs.states(outputs) for t in s.captured_ns)
    assert times[0] == legs.time_ns(0)
    first = min(p.captured_ns for p in legs.pictures(outputs) if p.phase == "estimating")
    assert 32e9 < first < 36e9, "after 30 s of motion"
    assert legs.errors_deg(outputs, recording).std() < 3.0


def test_a_short_recording_is_enough_for_the_published_axis_at_its_end():
    description = legs.describe(estimator="knee_axis_mcgrath")
    outputs = legs.run(legs.node(description), legs.messages(walk(), ticks=5))
    assert legs.errors_deg(outputs, walk()).std() < 3.0


def test_what_is_worn_and_what_was_chosen_decide_the_node():
    assert isinstance(build(legs.describe()), KneeNode)
    assert isinstance(build(legs.describe(estimator="rhythmic_ekf")), LowerBodyNode)


@pytest.mark.parametrize(
    ("description", "words"),
    [
        (legs.describe(hubs=[[Segment.PELVIS, Segment.THIGH_LEFT, Segment.SHANK_RIGHT]]), "assign the sensors anew"),
        (legs.describe(estimator="knee_band", upward=None), "or choose the estimator knee_axis"),
    ],
)
def test_an_estimator_that_does_not_fit_says_so_on_the_page(description, words):
    node = build(description)
    assert isinstance(node, RefusingNode)
    stream = legs.messages(legs.leg(seconds=2.0))
    assert [s.name for s in node.streams] == ["imu/hub_0"]
    outputs = legs.run(node, stream)
    assert {type(o.payload) for o in outputs} == {LivePose}
    assert all(words in pose.message for pose in legs.pictures(outputs))
    assert np.median(np.diff([o.captured_ns for o in outputs])) == 40_000_000
    assert node.rejections() == []
    again = build(description)
    again.restore(json.loads(json.dumps(node.snapshot())))
    assert again.snapshot() == node.snapshot()
