"""The same software gives the same again, whatever else happened to the recording; or it is said why not."""

import pytest

from schemas.archive_layout import RecordingState, SegmentName
from services.archive.disk import Disk
from services.archive.manifest import store, with_state
from services.cli.reprocess.fingerprints import Fingerprints
from services.cli.reprocess.recompute import CannotRecompute, UnderWay, open_archived, recompute
from services.flow.message import Envelope
from services.flow.software import SOFTWARE, VERSION
from services.recordings.folder import read_manifest

DERIVED = SegmentName("derived", VERSION, 0, part=False).file_name


def test_an_archived_session_gives_its_own_results_to_the_last_bit(session):
    shares = []
    result = recompute(open_archived(session), shares.append)
    assert result.same_software
    assert result.same_messages
    assert not result.broken
    assert result.stored == result.metrics
    assert (result.metrics.final, result.metrics.software) == (True, SOFTWARE)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert len(shares) > 50


def test_one_altered_message_is_found(walked, archiving, tmp_path):
    """As a disk or another program could have altered it, with right checksums all over."""
    description, messages = walked
    altered = list(messages)
    states = [place for place, message in enumerate(messages) if message.stream.signal.name == "joint_state"]
    place = states[len(states) // 2]
    payload = altered[place].payload.model_copy(deep=True)
    payload.position[0][0] += 1e-15
    altered[place] = type(altered[place])(altered[place].stream, altered[place].envelope, payload)
    result = recompute(open_archived(archiving(tmp_path / "s", altered, description)))
    assert result.broken
    (differing,) = result.differing
    assert differing.stream == "joint_state/estimation"
    assert differing.stored == differing.recomputed
    assert 0 < differing.first < differing.stored
    assert result.stored == result.metrics


def test_a_session_without_any_result_is_computed(walked, archiving, tmp_path):
    description, messages = walked
    raw = [message for message in messages if message.stream.signal.archived == "raw"]
    result = recompute(open_archived(archiving(tmp_path / "s", raw, description)))
    assert (result.stored_version, result.stored) == (None, None)
    assert result.metrics.final


def test_an_interrupted_recording_gives_what_was_recorded_and_is_the_same_so_far(walked, archiving, tmp_path):
    description, messages = walked
    begun = messages[: len(messages) // 2]
    folder = archiving(tmp_path / "s", begun, description, state=RecordingState.INTERRUPTED)
    result = recompute(open_archived(folder))
    assert result.metrics.final
    assert result.same_messages
    assert "interrupted" in result.notes[0]


def test_a_damaged_raw_file_is_refused_and_a_damaged_result_is_said(session):
    for name, refused in ((DERIVED, False), ("raw.mcap", True)):
        data = bytearray((session / name).read_bytes())
        data[len(data) // 2] ^= 1
        (session / name).write_bytes(data)
        if refused:
            with pytest.raises(CannotRecompute, match=r"raw\.mcap: corrupt"):
                open_archived(session)
        else:
            result = recompute(open_archived(session))
            assert result.broken
            assert "damaged" in result.notes[0]
            assert result.metrics.final


def test_a_missing_raw_file_is_refused(session):
    (session / "raw.mcap").unlink()
    with pytest.raises(CannotRecompute, match="missing"):
        open_archived(session)


@pytest.mark.parametrize("state", [RecordingState.RECORDING, RecordingState.STOPPED])
def test_a_session_under_way_is_left_alone(session, state):
    store(session, with_state(read_manifest(session), state), Disk())
    with pytest.raises(UnderWay):
        open_archived(session)


def test_fingerprints_say_where_streams_part():
    def marks(**streams):
        found = Fingerprints()
        for name, words in streams.items():
            for place, word in enumerate(words):
                found.add(name, Envelope(0, place, place), word.encode())
        return found

    stored = marks(a="xyz", b="xy")
    assert stored.differing_from(marks(a="xyz", b="xy"), complete=True) == []
    assert stored.differing_from(marks(a="xyzw", b="xy"), complete=False) == []
    found = stored.differing_from(marks(a="xyzw", b="xq", c="x"), complete=True)
    assert [(each.stream, each.first) for each in found] == [("a", 3), ("b", 1), ("c", 0)]
    assert [each.stream for each in stored.differing_from(marks(a="x"), complete=False)] == ["a", "b"]
