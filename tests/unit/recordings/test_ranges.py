"""A few seconds of a session, found by the index: the messages that reading everything gives, and no others read."""

import pytest

from services.recordings import index
from services.recordings.errors import DamagedRecording, NotARecording
from services.recordings.ranges import NotClosed, RecordedRanges
from services.recordings.reader import open_recording

MS = 1_000_000


@pytest.fixture
def folder(recorded, tape):
    """Ten seconds of samples and joint states, a contact each second; in several files of several chunks."""
    messages = []
    for n in range(1000):
        messages += [tape.record(tape.hub, n), tape.record(tape.joints, n, payload=b'{"n":%d}' % n)]
        if n % 100 == 50:
            messages.append(tape.record(tape.events, n // 100, payload=b'{"e":%d}' % n, captured_ns=n * 10 * MS))
    return recorded(messages, every=500)


def of(folder, stream, from_ns, to_ns):
    whole = [r for r in open_recording(folder).records() if r.stream == stream]
    return [r for r in whole if from_ns <= r.envelope.captured_ns < to_ns]


@pytest.mark.parametrize(("from_ns", "to_ns"), [(0, 10_000 * MS), (2_500 * MS, 3_500 * MS), (9_990 * MS, 20_000 * MS)])
@pytest.mark.parametrize("stream", ["hub", "joints", "events"])
def test_a_range_holds_what_reading_everything_gives(folder, tape, stream, from_ns, to_ns):
    stream = getattr(tape, stream)
    ranges = RecordedRanges(folder)
    found = ranges.find(stream.signal, from_ns, to_ns)
    expected = of(folder, stream, from_ns, to_ns)
    assert [each.captured_ns for each in found] == [each.envelope.captured_ns for each in expected]
    assert {each.stream for each in found} <= {stream.name}
    assert list(ranges.read(found)) == expected


def test_only_chunks_with_a_wanted_message_are_opened(folder, tape, monkeypatch):
    opened = []
    real = index.open_chunk
    monkeypatch.setattr(index, "open_chunk", lambda body: opened.append(len(body)) or real(body))
    ranges = RecordedRanges(folder)
    found = ranges.find(tape.events.signal, 0, 10_000 * MS)
    assert (len(found), opened) == (10, [])
    assert len(list(ranges.read(found[3:4]))) == 1
    assert len(opened) == 1
    assert ranges.find(tape.events.signal, 600 * MS, 700 * MS) == []


def test_a_session_of_several_files_is_one(recorded, tape):
    ticks = iter(range(10_000))
    folder = recorded(
        [m for n in range(600) for m in (tape.record(tape.hub, n), tape.record(tape.joints, n, payload=b"{}"))],
        monotonic_s=lambda: next(ticks) * 100.0, every=20,
    )  # fmt: skip
    assert len(list(folder.glob("raw*.mcap"))) > 1
    ranges = RecordedRanges(folder)
    for stream in (tape.hub, tape.joints):
        expected = of(folder, stream, 0, 6_000 * MS)
        assert len(expected) == 600
        assert list(ranges.read(ranges.find(stream.signal, 0, 6_000 * MS))) == expected


def test_an_open_or_missing_recording_is_refused(recorded, tape, tmp_path):
    with pytest.raises(NotClosed):
        RecordedRanges(recorded(tape.walk(50), closed=False))
    empty = tmp_path / "empty"
    empty.mkdir()
    with pytest.raises(NotARecording):
        RecordedRanges(empty)


@pytest.mark.parametrize("at", [0.1, 0.5, 0.9, 0.97, 0.995])
def test_altered_bytes_are_never_handed_out(folder, tape, at):
    """Each byte of a closed file is under some checksum; where it matters for a range, the reader finds it."""
    before = {r.envelope.sequence: r.payload for r in of(folder, tape.joints, 0, 10_000 * MS)}
    path = next(folder.glob("derived*.mcap"))
    data = bytearray(path.read_bytes())
    data[int(at * len(data))] ^= 0xFF
    path.write_bytes(data)
    try:
        ranges = RecordedRanges(folder)
        got = list(ranges.read(ranges.find(tape.joints.signal, 0, 10_000 * MS)))
    except DamagedRecording:
        return
    assert {r.envelope.sequence: r.payload for r in got} == {s: before[s] for s in (r.envelope.sequence for r in got)}
