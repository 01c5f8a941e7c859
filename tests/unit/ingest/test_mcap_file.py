"""What the archive wrote replays as it was captured; what is damaged replays as far as it is right."""

import json
from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from schemas.health import Reason
from services.archive.disk import Disk
from services.archive.seal import seal
from services.archive.writer import SessionWriter
from services.flow.message import Envelope, Message, Stream, encode_payload
from services.ingest.errors import EmptyFile, MissingFile, SourceError, UnreadableFile
from services.ingest.source import iter_messages, open_source
from services.recordings.record import Record

WALK = "synthetic:walk?duration=6&seed=2"
STARTED = 1_790_000_000_000_000_000


@dataclass(frozen=True)
class Archived:
    """A session on disk, and the messages that went into it."""

    folder: Path
    messages: list[Message]

    @property
    def file(self) -> Path:
        (path,) = self.folder.glob("raw.mcap*")
        return path


def archive(folder, messages, description, every=50, number=0):
    folder.mkdir(parents=True, exist_ok=True)
    writer = SessionWriter(folder, description, "0.1.0", first_number=number)
    for index, message in enumerate(messages):
        payload = encode_payload(message.payload)
        writer.write(Record(message.stream, message.envelope, payload, STARTED + message.envelope.captured_ns))
        if index % every == every - 1:
            writer.flush()
    finished(writer)


def finished(writer):
    writer.flush()
    for part in writer.close():
        seal(part, "ambula test", Disk(), 1 << 18)


@pytest.fixture(scope="module")
def archived(tmp_path_factory):
    source = open_source(WALK, session="first", estimator="ekf")
    description = source.describe().model_copy(update={"started_unix_ns": STARTED})
    messages = list(iter_messages(source))
    folder = tmp_path_factory.mktemp("archive") / "first"
    archive(folder, messages, description)
    return Archived(folder, messages)


def test_an_archived_session_replays_message_for_message(archived):
    for spec in (str(archived.folder), str(archived.file)):
        source = open_source(spec, session="second")
        assert list(iter_messages(source)) == archived.messages
        assert source.rejections() == []


def test_description_is_the_recorded_one_under_a_new_id(archived):
    description = open_source(str(archived.folder), session="second").describe()
    assert (description.session, description.origin, description.estimator) == ("second", "archive", "ekf")
    assert description.started_unix_ns == STARTED
    assert len(description.hubs[0].sensors) == 5
    assert open_source(str(archived.folder), estimator="rhythmic_ekf").describe().estimator == "rhythmic_ekf"


def test_several_files_are_one_session(archived, tmp_path):
    description = open_source(str(archived.folder), session="first").describe()
    half = len(archived.messages) // 2
    archive(tmp_path / "s", archived.messages[: half + 20], description)
    archive(tmp_path / "s", archived.messages[half:], description, number=1)
    assert list(iter_messages(open_source(str(tmp_path / "s")))) == archived.messages


def test_a_truncated_file_gives_its_beginning_and_says_so(archived, tmp_path):
    path = tmp_path / "cut.mcap"
    data = archived.file.read_bytes()
    path.write_bytes(data[: len(data) * 2 // 3])
    source = open_source(str(path))
    imu = [message for message in iter_messages(source) if message.stream.name == "imu/walker"][:-1]
    expected = [message for message in archived.messages if message.stream.name == "imu/walker"]
    assert 100 < len(imu) < 600
    assert imu == expected[: len(imu)]
    (rejection,) = source.rejections()
    assert (rejection.subject, rejection.reason, rejection.count) == ("cut.mcap", Reason.UNDECODABLE, 1)


def test_an_altered_byte_never_becomes_a_sample(archived, tmp_path):
    data = bytearray(archived.file.read_bytes())
    data[len(data) // 2] ^= 0x40
    path = tmp_path / "altered.mcap"
    path.write_bytes(data)
    source = open_source(str(path))
    got = [message for message in iter_messages(source) if not message.envelope.final]
    assert 0 < len(got) < len(archived.messages)
    assert all(message in archived.messages for message in got)
    assert source.rejections()


def test_a_file_that_is_still_open_replays_too(archived, tmp_path):
    description = open_source(str(archived.folder)).describe()
    writer = SessionWriter(tmp_path, description, "0.1.0")
    for message in archived.messages[:200]:
        payload = encode_payload(message.payload)
        writer.write(Record(message.stream, message.envelope, payload, STARTED + message.envelope.captured_ns))
    writer.flush()
    source = open_source(str(tmp_path / "raw.mcap.part"))
    assert [message for message in iter_messages(source) if not message.envelope.final] == archived.messages[:200]
    assert [rejection.subject for rejection in source.rejections()] == ["raw.mcap.part"]
    writer.close()


def test_foreign_and_missing_files(archived, tmp_path):
    path = tmp_path / "other.mcap"
    path.write_bytes(b"not an mcap file at all")
    with pytest.raises(UnreadableFile, match=r"other\.mcap"):
        open_source(str(path))
    with pytest.raises(MissingFile):
        open_source(str(tmp_path / "nothing.mcap"))
    description = open_source(str(archived.folder)).describe()
    archive(tmp_path / "empty", [m for m in archived.messages if m.envelope.final][:1], description)
    with pytest.raises(EmptyFile, match="no samples"):
        open_source(str(tmp_path / "empty" / "raw.mcap"))


def test_payloads_that_do_not_fit_are_counted(archived, tmp_path):
    description = open_source(str(archived.folder)).describe()
    stream = archived.messages[0].stream
    batch = json.loads(encode_payload(archived.messages[0].payload))
    payloads = [b"{}", b"nonsense", json.dumps({"sensors": batch["sensors"][:3]}).encode(), json.dumps(batch).encode()]
    folder = tmp_path / "s"
    folder.mkdir()
    writer = SessionWriter(folder, description, "0.1.0")
    for sequence, payload in enumerate(payloads):
        writer.write(Record(Stream(*stream), Envelope(0, sequence, sequence), payload, STARTED))
    finished(writer)
    source = open_source(str(folder))
    assert len([message for message in iter_messages(source) if message.payload is not None]) == 1
    counts = {(rejection.subject, rejection.reason): rejection.count for rejection in source.rejections()}
    assert counts == {("imu/walker", Reason.UNDECODABLE): 2, ("imu/walker", Reason.WRONG_SHAPE): 1}


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_any_damage_is_a_prefix_or_a_typed_error(archived, tmp_path, data):
    raw = bytearray(archived.file.read_bytes()[:60_000])
    for _ in range(data.draw(st.integers(1, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path / "fuzz.mcap"
    path.write_bytes(raw[: data.draw(st.integers(0, len(raw)))])
    try:
        source = open_source(str(path))
    except SourceError:
        return
    known = {(message.stream.name, message.envelope.captured_ns): message.payload for message in archived.messages}
    for message in iter_messages(source):
        if message.payload is not None:
            assert known[message.stream.name, message.envelope.captured_ns] == message.payload
