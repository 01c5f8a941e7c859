"""A short synthetic walk, computed and archived once, and copies of it to work on."""

import shutil

import pytest

from schemas.archive_layout import RecordingState
from services.archive.disk import Disk
from services.archive.manifest import new_manifest, store, with_files, with_state
from services.archive.seal import seal
from services.archive.writer import SessionWriter
from services.cli.assembly import build_chain
from services.flow.message import encode_payload
from services.flow.software import VERSION
from services.ingest.source import iter_messages, open_source
from services.recordings.record import Record

WALK = "synthetic:walk?duration=12&seed=2"
SESSION = "0123456789abcdef"


def archive(folder, messages, description, version=VERSION, state=RecordingState.FINISHED):
    """What the archive leaves of a session."""
    folder.mkdir(parents=True)
    writer = SessionWriter(folder, description, version)
    for message in messages:
        writer.write(Record(message.stream, message.envelope, encode_payload(message.payload), 0))
    writer.flush()
    entries = [seal(part, f"ambula {version}", Disk(), 1 << 18) for part in writer.close()]
    store(folder, with_state(with_files(new_manifest(description, version), entries), state), Disk())
    return folder


@pytest.fixture(scope="package")
def walked():
    """Description and every archived message of the walk."""
    source = open_source(WALK, session=SESSION)
    chain = build_chain(source.describe())
    messages = []
    for message in iter_messages(source):
        messages += [message, *(one for one in chain.push(message) if one.stream.signal.archived)]
    return source.describe(), messages


@pytest.fixture(scope="package")
def archived_once(walked, tmp_path_factory):
    description, messages = walked
    return archive(tmp_path_factory.mktemp("archive") / SESSION, messages, description)


@pytest.fixture
def data_dir(archived_once, tmp_path):
    """A data folder with the one session."""
    shutil.copytree(archived_once, tmp_path / "data" / SESSION)
    return tmp_path / "data"


@pytest.fixture
def session(data_dir):
    """The session's folder."""
    return data_dir / SESSION


@pytest.fixture
def archiving():
    """The function that archives messages."""
    return archive
