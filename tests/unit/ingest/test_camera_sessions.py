"""A session with a camera is archived, marked and replayed like one with sensors, to the last bit."""

from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace
from typing import ClassVar

import pytest

from schemas.health import Reason
from schemas.skeleton import SkeletonBatch
from schemas.standing import StandingMark
from services.flow.message import Envelope, Message, decode_payload, encode_payload
from services.ingest import playback
from services.ingest.errors import UnreadableFile
from services.ingest.orders import StartOrder
from services.ingest.source import iter_messages, open_source
from tests.unit.ingest.camera_scene import HEAD_TOML, HUB, KINECT, Scene
from tests.unit.ingest.test_mcap_file import archive

MARK = StandingMark(from_ns=0, to_ns=900_000_000, given_ns=1_000_000_000)


@pytest.fixture
def scene(tmp_path):
    return Scene(tmp_path / "scene")


def recorded(scene, toml):
    scene.toml = toml
    source = scene.opened()
    return source, list(iter_messages(source))


def test_an_archived_camera_replays_message_for_message(scene, tmp_path):
    scene.rows[5][4] = "nan"
    source, messages = recorded(scene, HEAD_TOML + HUB + KINECT)
    at = next(i for i, m in enumerate(messages) if m.envelope.captured_ns > MARK.given_ns and m.payload)
    marked = messages[at].payload.model_copy(update={"marks": [MARK]})
    messages[at] = Message(messages[at].stream, messages[at].envelope, marked)
    archive(tmp_path / "first", messages, source.describe())
    again = open_source(str(tmp_path / "first"), session="s1")
    assert list(iter_messages(again)) == messages
    assert again.rejections() == []
    assert again.describe().cameras == source.describe().cameras
    assert again.describe().estimator == "fusion"


def test_a_frame_decodes_to_what_was_encoded(scene):
    for message in recorded(scene, HEAD_TOML + KINECT)[1][:-1]:
        data = encode_payload(message.payload)
        assert decode_payload(message.stream.signal, message.envelope, data) == message.payload


def test_frames_of_another_camera_are_counted_and_left_out(scene, tmp_path):
    source, messages = recorded(scene, HEAD_TOML + KINECT)
    payload = messages[3].payload
    short = payload.model_copy(update={"position": [payload.position[0][:20]], "state": [payload.state[0][:20]]})
    messages[3] = Message(messages[3].stream, messages[3].envelope, short)
    archive(tmp_path / "first", messages, source.describe())
    again = open_source(str(tmp_path / "first"), session="s1")
    assert len(list(again.messages())) == 59
    (rejection,) = again.rejections()
    assert (rejection.subject, rejection.reason, rejection.count) == ("skeleton/kinect", Reason.WRONG_SHAPE, 1)


def test_a_cameras_name_that_cannot_stand_in_a_key_is_refused(scene, tmp_path):
    source, messages = recorded(scene, HEAD_TOML + KINECT)
    described = source.describe()
    renamed = described.cameras[0].model_copy(update={"name": "a/*"})
    archive(tmp_path / "first", messages, described.model_copy(update={"cameras": [renamed]}))
    with pytest.raises(UnreadableFile, match="cannot stand in a key"):
        open_source(str(tmp_path / "first"))


class Sent:
    """A publisher that remembers."""

    everything: ClassVar[list] = []

    def __init__(self, _bus, _session, stream):
        self.stream, self.newest, self._count = stream, None, 0

    def send(self, captured_ns, payload):
        self.newest = Envelope(0, self._count, captured_ns)
        self._count += 1
        Sent.everything.append((self.stream.name, captured_ns, payload))
        return self.newest

    def end(self, captured_ns):
        pass


@pytest.mark.parametrize(
    ("toml", "carrier"), [(HEAD_TOML + KINECT, "skeleton/kinect"), (HEAD_TOML + HUB + KINECT, None)]
)
def test_a_mark_goes_out_once_with_the_next_samples_of_either_kind(scene, monkeypatch, toml, carrier):
    monkeypatch.setattr(playback, "StreamPublisher", Sent)
    Sent.everything = []
    scene.toml = toml
    source = scene.opened()
    bus = SimpleNamespace(settings=SimpleNamespace(site="here"), declare_token=lambda _key: None)
    order = StartOrder(source="scene", speed=1.0)
    with ThreadPoolExecutor(1) as threads:
        running = playback.Playback(bus, source, source.describe(), order, threads, now_s=0.0)
        threads.submit(lambda: None).result()
        running.pump(now_s=0.0)
        running.pump(now_s=1.0)
        before = len(Sent.everything)
        running.mark(0, 900_000_000)
        running.pump(now_s=2.5)
    assert before > 10
    marks = [(name, at, mark) for name, at, payload in Sent.everything for mark in payload.marks]
    ((name, at, mark),) = marks
    assert (name, at) == Sent.everything[before][:2]
    assert mark.given_ns < at
    assert carrier in (None, name)
    assert any(isinstance(payload, SkeletonBatch) for _, _, payload in Sent.everything)
