"""The file is read back with the MCAP library; every message must be what its own schema promises."""

import io
import json

import jsonschema
import numpy as np
import pytest
from mcap.reader import make_reader

from schemas.signals import GAIT_EVENT, JOINT_CENTRES, JOINT_STATE, STRIDE, TASK_PHASE
from services.exports.foxglove.recording import FACTS, foxglove_recording
from services.exports.foxglove.scene import UPRIGHT
from services.exports.session import HeldSession, facts_of

SHOWN = (JOINT_STATE, JOINT_CENTRES, GAIT_EVENT, STRIDE, TASK_PHASE)


@pytest.fixture
def read():
    def run(session):
        data = b"".join(foxglove_recording(facts_of(session), session.payloads(*SHOWN)))
        reader = make_reader(io.BytesIO(data), validate_crcs=True)
        found = {}
        for schema, channel, message in reader.iter_messages():
            found.setdefault(channel.topic, []).append((schema.name, message.log_time, json.loads(message.data)))
        return found, reader

    return run


def test_every_message_is_what_its_schema_promises(about, made):
    states = made.joint_states(count=60)
    few = [(JOINT_STATE, state) for state in states] + [(GAIT_EVENT, event) for event in made.contacts(3)]
    session = HeldSession(about, [*few, (STRIDE, made.a_stride()), (TASK_PHASE, made.a_phase(None))])
    data = b"".join(foxglove_recording(facts_of(session), session.payloads(*SHOWN)))
    checks, count = {}, 0
    for schema, _, message in make_reader(io.BytesIO(data)).iter_messages():
        if schema.id not in checks:
            jsonschema.Draft202012Validator.check_schema(json.loads(schema.data))
            checks[schema.id] = jsonschema.Draft202012Validator(json.loads(schema.data))
        checks[schema.id].validate(json.loads(message.data))
        count += 1
    assert (len(checks), count) == (5, 60 + 2 * 20 + 3 + 1 + 1)


def test_channels_are_named_and_typed_as_the_viewer_draws_them(read, walk):
    found, _ = read(walk)
    assert {topic: messages[0][0] for topic, messages in found.items()} == {
        "/joint_angles": "ambula.JointAngles.lower_body",
        "/skeleton": "foxglove.SceneUpdate",
        "/tf": "foxglove.FrameTransforms",
        "/events": "foxglove.Log",
        "/strides": "ambula.Stride",
    }


def test_angles_stand_at_their_wall_time_in_degrees(read, walk, made):
    found, _ = read(walk)
    angles = found["/joint_angles"]
    assert len(angles) == 1000
    _, log_time, first = angles[0]
    assert log_time == walk.description.started_unix_ns + made.start_ns
    truth = made.angles_at("lower_body", np.array([made.start_ns * 1e-9]))[0, 6]
    assert np.radians(first["knee_flexion_right_deg"]) == pytest.approx(truth, abs=1e-6)


def test_skeletons_come_thirty_times_a_second_with_lengths_of_the_body(read, walk):
    found, _ = read(walk)
    assert len(found["/skeleton"]) == pytest.approx(10 * 30, rel=0.15)
    line = found["/skeleton"][0][2]["entities"][0]["lines"][0]
    ends = np.array([[point[axis] for axis in "xyz"] for point in line["points"]]).reshape(-1, 2, 3)
    body = walk.description.anthropometry
    expected = [body.hip_width_m, body.thigh_length_m, body.thigh_length_m, body.shank_length_m, body.shank_length_m]
    np.testing.assert_allclose(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), expected, atol=1e-9)


def test_segments_are_frames_of_a_room_that_stands_upright(read, walk):
    found, _ = read(walk)
    transforms = found["/tf"][0][2]["transforms"]
    pairs = {each["child_frame_id"]: each["parent_frame_id"] for each in transforms}
    assert pairs["room"] == "world"
    assert {child for child, parent in pairs.items() if parent == "room"} == {
        "pelvis", "thigh_right", "shank_right", "thigh_left", "shank_left",
    }  # fmt: skip
    w, x = UPRIGHT["w"], UPRIGHT["x"]
    up = np.array([[1, 0, 0], [0, w * w - x * x, -2 * x * w], [0, 2 * x * w, w * w - x * x]]) @ [0.0, 1.0, 0.0]
    np.testing.assert_allclose(up, [0, 0, 1], atol=1e-12)


def test_contacts_and_phases_are_lines_of_a_log(read, walk):
    found, _ = read(walk)
    said = [content["message"] for _, _, content in found["/events"]]
    assert said.count("initial contact, left") == 5
    assert said.count("turn begins") == said.count("turn ends") == 1


def test_a_camera_shows_what_it_saw_and_nothing_else(read, seen):
    found, _ = read(seen)
    entity = found["/skeleton"][0][2]["entities"][0]
    assert len(entity["spheres"]) == 14, "the left wrist was not seen"
    assert [each["child_frame_id"] for each in found["/tf"][0][2]["transforms"]] == ["room"]


def test_an_angle_that_is_not_valid_is_not_in_the_message(read, about, made):
    states = made.joint_states(count=10, valid=[f == 6 for f in range(15)])
    found, _ = read(HeldSession(about, [(JOINT_STATE, state) for state in states]))
    assert set(found["/joint_angles"][0][2]) == {"time_s", "knee_flexion_right_deg", "knee_flexion_right_std_deg"}
    assert "/skeleton" not in found


def test_the_file_says_what_its_angles_mean(read, walk):
    _, reader = read(walk)
    facts = next(record.metadata for record in reader.iter_metadata() if record.name == FACTS)
    assert facts["datum of angles"] == "quiet standing"
    assert facts["conditions"] == "aid cane, footwear shoes"
