"""Frames become messages: in order, in the room, on the session's clock, of one person."""

import itertools

import numpy as np
import pytest

from schemas.health import Reason
from schemas.vocabulary import CameraKind, TrackingState
from services.ingest.capture.datagram import decode_frame
from services.ingest.capture.reader import FrameReader
from services.ingest.skeleton import view_of
from tests.unit.ingest.capture.datagrams import datagram, joints
from tests.unit.ingest.capture.two_people import JOINTS, figure

MS = 1_000_000
FRAME_NS = 33_333_000


def reader(kind=CameraKind.KINECT_V2):
    return FrameReader("kinect", view_of(kind, up=[0, -1, 0] if kind is CameraKind.AZURE_KINECT else [0, 1, 0]))


def fed(numbers, *, into=None, delay_ns=lambda _seq: 20 * MS, **more):
    """Messages of frames that arrive in the order given, `delay_ns` after they were taken."""
    into = into or reader(more.get("kind", CameraKind.KINECT_V2))
    out = []
    for seq in numbers:
        out += into.take(decode_frame(datagram(seq, **more)), seq * FRAME_NS + delay_ns(seq))
    return into, out


def counted(into):
    return {(each.subject, each.reason): each.count for each in into.rejections()}


@pytest.mark.parametrize("kind", list(CameraKind)[:2])
def test_both_cameras_see_the_same_person_at_the_same_place(kind):
    body = {"id": 3, "joints": joints(kind)}
    into, out = fed(range(60), kind=kind, bodies=[body])
    names = list(view_of(kind).room_joints)
    last = out[-1].payload
    assert (out[-1].stream.name, last.body, last.people) == ("skeleton/kinect", [1], [1])
    expected = dict(zip(JOINTS, figure(1.7) + np.array([-2.5, -0.1, 0.0]), strict=True))
    for joint in JOINTS:
        position = last.position[0][names.index(joint)]
        if not (kind is CameraKind.AZURE_KINECT and joint in ("spine_mid", "spine_shoulder")):
            assert position == pytest.approx(expected[joint], abs=1e-9)
    assert into.count().received == 60
    assert counted(into) == {}


def test_nobody_is_a_frame_without_joints():
    _, out = fed(range(3), bodies=[])
    for message in out:
        batch = message.payload
        assert (batch.body, batch.people) == ([None], [0])
        assert set(batch.state[0]) == {TrackingState.NOT_TRACKED}
        assert set(map(type, batch.position[0])) == {type(None)}


def test_the_second_person_is_counted_and_left_out():
    both = [{"id": 2, "joints": joints(z=1.1)}, {"id": 1, "joints": joints(z=0.1)}]
    _, out = fed(range(60), bodies=both)
    last = out[-1].payload
    assert (last.body, last.people) == ([1], [2])
    assert last.position[0][0][2] == pytest.approx(0.1)


def test_times_are_those_of_the_capture_not_of_the_arrival():
    """A jittery network: the steps of the session's time are the camera's."""
    rng = np.random.default_rng(3)
    delays = rng.uniform(5 * MS, 25 * MS, 900)
    _, out = fed(range(900), delay_ns=lambda seq: round(delays[seq]))
    steps = np.diff([message.captured_ns for message in out[300:]])
    assert np.abs(steps - FRAME_NS).max() < 1 * MS
    assert all(message.payload.captured_ns == [message.captured_ns] for message in out)


def test_reordered_frames_come_in_captured_order_and_lost_ones_are_counted():
    into, out = fed([0, 1, 3, 2, 4, 6, 7, 8, 9])
    out += into.due(9 * FRAME_NS + 200 * MS)
    assert len(out) == 9
    assert all(a.captured_ns < b.captured_ns for a, b in itertools.pairwise(out))
    count = into.count()
    assert (count.received, count.lost, count.duplicated) == (9, 1, 0)
    out += into.take(decode_frame(datagram(5)), 10 * FRAME_NS + 300 * MS)
    assert len(out) == 9
    assert into.count().lost == 0
    assert counted(into) == {("kinect", Reason.LATE): 1}


def test_a_camera_of_another_kind_is_counted():
    into = reader()
    fed(range(4), into=into, kind="azure_kinect", bodies=[])
    assert counted(into) == {("kinect", Reason.UNKNOWN_SENSOR): 4}


def test_a_device_clock_that_is_set_back_costs_one_frame():
    into, out = fed(range(30))
    _, more = fed(range(30, 60), into=into, t_us=None)
    out += more
    for seq in range(60, 90):
        out += into.take(decode_frame(datagram(seq, t_us=1000 + 33_333 * seq)), seq * FRAME_NS + 20 * MS)
    assert len(out) == 89
    assert all(a.captured_ns < b.captured_ns for a, b in itertools.pairwise(out))
    assert counted(into) == {("kinect", Reason.CLOCK_BACKWARDS): 1, ("kinect clock", Reason.CLOCK_BACKWARDS): 1}


def test_joints_inside_the_lens_or_out_of_the_room_are_not_tracked():
    body = {"id": 1, "joints": [*joints()[:-5], *[[0.0, 0.0, 0.0, 2]] * 4, [30.0, 0.0, 2.0, 2]]}
    into, out = fed(range(40), bodies=[body])
    assert counted(into)[("kinect", Reason.OUT_OF_RANGE)] == 40 * 5
    assert out[-1].payload.body == [1]


def test_a_sender_that_starts_again_goes_on_at_once():
    into, out = fed(range(1000, 1060))
    into.new_sender()
    began = out[-1].captured_ns
    for seq in range(30):
        out += into.take(decode_frame(datagram(seq, t_us=9_000_000 + 33_333 * seq)), 1065 * FRAME_NS + seq * FRAME_NS)
    assert len(out) >= 89
    assert out[-1].captured_ns > began + 25 * FRAME_NS
    assert out[-1].payload.body == [1]
