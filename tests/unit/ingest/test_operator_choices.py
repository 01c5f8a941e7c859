"""What the operator says before and while a session runs: chosen, recorded, and the same again in a replay."""

import pytest

from schemas.imu import ImuBatch
from schemas.standing import StandingMark
from services.archive.disk import Disk
from services.archive.seal import seal
from services.archive.writer import SessionWriter
from services.cli.assembly import build_chain
from services.flow.message import Message, encode_payload
from services.ingest.source import in_batches, iter_messages, open_source
from services.ingest.synthetic import write_recording
from services.recordings.record import Record

WALK = "synthetic:walk?duration=14&seed=2"
MARK = StandingMark(from_ns=1_000_000_000, to_ns=3_000_000_000, given_ns=3_200_000_000)


def marked(messages: list[Message]) -> list[Message]:
    """As live publishing sends it: in the first samples later than the mark was given."""
    first = next(
        i for i, m in enumerate(messages) if isinstance(m.payload, ImuBatch) and m.envelope.captured_ns > MARK.given_ns
    )
    payload = messages[first].payload.model_copy(update={"marks": [MARK]})
    return [
        *messages[:first],
        Message(messages[first].stream, messages[first].envelope, payload),
        *messages[first + 1 :],
    ]


def estimates(description, messages):
    chain = build_chain(description)
    return [(p.stream.name, p.envelope, p.payload) for message in messages for p in chain.push(message)]


@pytest.fixture(scope="module")
def archived(tmp_path_factory):
    """A session on a straight path, estimated as published, marked by the operator: description, messages, folder."""
    source = open_source(WALK, session="first", estimator="joukov_published", walk_path="straight")
    description, messages = source.describe(), marked(list(iter_messages(source)))
    folder = tmp_path_factory.mktemp("archive") / "first"
    folder.mkdir()
    writer = SessionWriter(folder, description, "0.1.0", first_number=0)
    for message in messages:
        at_ns = description.started_unix_ns + message.envelope.captured_ns
        writer.write(Record(message.stream, message.envelope, encode_payload(message.payload), at_ns))
    writer.flush()
    for part in writer.close():
        seal(part, "ambula test", Disk(), 1 << 18)
    return description, messages, folder


def test_choices_and_marks_are_archived_and_replayed(archived):
    description, messages, folder = archived
    replay = open_source(str(folder), session="first")
    assert replay.describe().model_copy(update={"origin": "synthetic"}) == description
    again = list(iter_messages(replay))
    assert again == messages
    assert estimates(replay.describe(), again) == estimates(description, messages)


def test_the_operator_may_choose_otherwise_for_a_replay(archived):
    folder = str(archived[2])
    assert open_source(folder).describe().walk_path == "straight"
    other = open_source(folder, walk_path="turning", estimator="ekf").describe()
    assert (other.walk_path, other.estimator) == ("turning", "ekf")


def test_joined_messages_keep_their_marks(archived):
    source_messages = open_source(str(archived[2])).messages()
    joined = [m.payload for m in in_batches(source_messages, 3) if isinstance(m.payload, ImuBatch)]
    assert [mark for payload in joined for mark in payload.marks] == [MARK]


def test_a_recording_says_its_path(tmp_path):
    assert open_source(WALK).describe().walk_path == "turning"
    write_recording(tmp_path / "treadmill", "duration=5&seed=1", walk_path="straight")
    assert open_source(str(tmp_path / "treadmill")).describe().walk_path == "straight"
    assert open_source(str(tmp_path / "treadmill"), walk_path="turning").describe().walk_path == "turning"
