"""A session read from its archive is the session that was recorded."""

import io

import pytest

from schemas.signals import GAIT_EVENT, IMU, JOINT_STATE
from services.exports.errors import ExportError
from services.exports.formats import FORMATS, write
from services.exports.recorded import RecordedSession, listed_signals
from services.exports.session import HeldSession
from services.flow.message import encode_payload
from services.recordings.errors import DamagedRecording, NotARecording


@pytest.fixture
def messages(made):
    return [
        *((JOINT_STATE, state) for state in made.joint_states(count=200)),
        *((GAIT_EVENT, e) for e in made.contacts(4)),
    ]


@pytest.fixture
def folder(messages, recorded, tape):
    streams = {JOINT_STATE: tape.joints, GAIT_EVENT: tape.events}
    numbers = dict.fromkeys(streams, -1)
    records = tape.walk(5)
    for signal, payload in messages:
        numbers[signal] += 1
        time = payload.captured_ns if signal is GAIT_EVENT else payload.captured_ns[0]
        data = encode_payload(payload)
        records.append(tape.record(streams[signal], numbers[signal], payload=data, captured_ns=time))
    records.append(tape.record(tape.events, numbers[GAIT_EVENT] + 1, final=True, captured_ns=10**11))
    return recorded(records)


def test_files_are_those_of_the_session_in_memory(folder, messages, description):
    stored, held = RecordedSession(folder), HeldSession(description, messages, "ambula 0.1.0")
    assert stored.description == description
    for name in ("events.csv", "joint_angles.csv", "c3d", "mot", "trc"):
        of_both = []
        for session in (stored, held):
            file = io.BytesIO()
            write(name, session, file)
            of_both.append(file.getvalue())
        assert of_both[0] == of_both[1], name


def test_only_what_is_asked_for_is_decoded(folder):
    """The raw samples of this recording are no samples at all."""
    session = RecordedSession(folder)
    assert len(list(session.payloads(GAIT_EVENT))) == 4
    assert len(list(session.payloads(IMU))) == 0


def test_signals_are_known_from_the_manifest_alone(folder):
    assert listed_signals(folder) == {"imu", "joint_state", "gait_event"}
    assert listed_signals(folder) == RecordedSession(folder).signals
    (folder / "manifest.json").unlink()
    assert listed_signals(folder) == frozenset()


def test_how_far_reading_has_come_is_told(folder):
    heard = []
    list(RecordedSession(folder, told=heard.append).payloads(JOINT_STATE))
    assert heard == sorted(heard)
    assert heard[-1] == pytest.approx(2.24 + 1.9)


def test_a_damaged_recording_is_no_export(folder):
    path = folder / "derived-0.1.0.mcap"
    path.write_bytes(path.read_bytes()[:-3000])
    with pytest.raises(DamagedRecording, match="restore this file from a backup"):
        write("joint_angles.csv", RecordedSession(folder), io.BytesIO())


def test_messages_of_an_ambula_that_is_not_ours_are_told_as_such(recorded, tape):
    """The payloads of this tape are no joint states."""
    with pytest.raises(ExportError, match=r"recording: holds messages .*compute the session anew"):
        write("joint_angles.csv", RecordedSession(recorded(tape.walk(5, tape.joints))), io.BytesIO())


def test_a_folder_of_something_else_is_refused(tmp_path):
    with pytest.raises(NotARecording):
        RecordedSession(tmp_path)


def test_all_formats_are_in_the_list():
    assert len(FORMATS) == 13
