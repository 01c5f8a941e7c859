"""What is sent is what was recorded: there and back again."""

import pytest

from schemas.session import CameraDescription
from schemas.signals import SKELETON
from schemas.vocabulary import CameraKind, SkeletonJoint, TrackingState
from services.flow.message import Stream
from services.ingest.capture.datagram import decode_frame
from services.ingest.capture.first_look import view_of_frames
from services.ingest.capture.sender import NoCamera, camera_to_send, datagrams
from services.ingest.driver import SourceMessage
from services.ingest.skeleton import frames_in_room, skeleton_batch, view_of
from services.ingest.source import open_source
from tests.unit.ingest.capture.datagrams import decoded_frames
from tests.unit.ingest.capture.two_people import JOINTS


def recorded(kind):
    """A camera, and five frames of it as messages: two, two, one."""
    frames = decoded_frames(5, kind)
    view = view_of(kind, up=[0, 1, 0] if kind == CameraKind.KINECT_V2 else [0, -1, 0])
    camera = CameraDescription(name="c", kind=kind, rate_hz=30.0, joints=list(view.room_joints), floor_m=-0.95)
    rooms = [frames_in_room(view, each.bodies[0].positions[None], each.bodies[0].codes[None]) for each in frames]
    batches = [skeleton_batch([k * 33], [4], [1], room) for k, room in enumerate(rooms)]
    stream = Stream(SKELETON, "c")
    return camera, [SourceMessage(stream, k * 33, batch) for k, batch in enumerate(batches)]


@pytest.mark.parametrize("kind", [CameraKind.KINECT_V2, CameraKind.AZURE_KINECT])
def test_there_and_back(kind):
    camera, messages = recorded(kind)
    sent = list(datagrams(camera, messages))
    frames = [decode_frame(each.datagram) for each in sent]
    assert [frame.seq for frame in frames] == list(range(5))
    assert [frame.device_ns for frame in frames] == [each.captured_ns for each in sent] == [k * 33 for k in range(5)]
    view, floor_m = view_of_frames(frames)
    assert floor_m == pytest.approx(-0.95)
    for frame, message in zip(frames, messages, strict=True):
        room = frames_in_room(view, frame.bodies[0].positions[None], frame.bodies[0].codes[None])
        again = skeleton_batch([message.captured_ns], [4], [1], room)
        assert again.state == message.payload.state
        for ours, theirs in zip(again.position[0], message.payload.position[0], strict=True):
            assert (ours is None) == (theirs is None)
            assert ours is None or ours == pytest.approx(theirs, abs=1e-9)


def test_a_camera_without_an_sdk_is_sent_as_a_kinect_v2():
    camera = CameraDescription(
        name="c", kind=CameraKind.OTHER, rate_hz=30.0, joints=[SkeletonJoint(j) for j in JOINTS], floor_m=None
    )
    _, messages = recorded(CameraKind.KINECT_V2)
    only = [message._replace(payload=message.payload.model_copy(
        update={"position": [frame[:15] for frame in message.payload.position],
                "state": [frame[:15] for frame in message.payload.state]})) for message in messages]  # fmt: skip
    frames = [decode_frame(each.datagram) for each in datagrams(camera, only)]
    assert {frame.camera for frame in frames} == {CameraKind.KINECT_V2}
    assert (frames[0].bodies[0].codes > 0).sum() == 15


def test_nobody_in_view_is_sent_as_a_frame_without_bodies():
    camera, messages = recorded(CameraKind.KINECT_V2)
    batch = messages[0].payload
    nowhere = {
        "position": [[None] * len(batch.position[0])],
        "state": [[TrackingState.NOT_TRACKED] * len(batch.state[0])],
    }
    (sent,) = datagrams(camera, [messages[0]._replace(payload=batch.model_copy(update=nowhere))])
    assert decode_frame(sent.datagram).bodies == []


def test_a_source_without_a_camera_is_refused():
    with pytest.raises(NoCamera, match="kimore_squat"):
        camera_to_send(open_source("synthetic:walk?duration=6").describe())
