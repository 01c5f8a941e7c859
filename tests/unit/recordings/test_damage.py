"""The golden rule: the right beginning or a typed error; never a wrong message, never a hang, bounded memory."""

import resource
import struct
import zlib

import pytest
import zstandard
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.data_stream import RecordBuilder
from mcap.records import Chunk

from services.recordings.errors import ArchiveError, DamageKind
from services.recordings.frames import MAGIC, Opcode, read_frames
from services.recordings.reader import open_recording
from services.recordings.segment import scan

CLOSED = "raw.mcap"
OPEN = "raw.mcap.part"


@pytest.fixture
def small(recorded, tape):
    """A file of a few kilobytes in several chunks, and what it holds."""

    def make(name):
        records = [*tape.walk(12), tape.record(tape.hub, 12, final=True)]
        folder = recorded(records, closed=name == CLOSED, every=4)
        (folder / "manifest.json").unlink(missing_ok=True)
        return folder / name, records

    return make


def read(path):
    """Messages until the end or the typed error, which is returned beside them."""
    seen = []
    try:
        seen.extend(open_recording(path.parent).records())
    except ArchiveError as error:
        return seen, error
    return seen, None


def places(path):
    """Every byte; of the index at the end, which only other readers use, every eighth."""
    size = path.stat().st_size
    with path.open("rb") as file:
        index = max(frame.offset + len(frame.body) for frame in read_frames(file))
    return sorted({*range(index), *range(index, size, 8), *range(size - 60, size)})


@pytest.mark.parametrize("name", [CLOSED, OPEN])
def test_cut_anywhere(small, name):
    path, records = small(name)
    data = path.read_bytes()
    lengths = []
    for size in places(path):
        path.write_bytes(data[:size])
        seen, error = read(path)
        assert seen == records[: len(seen)]
        assert error is not None or path.name == OPEN
        lengths.append(len(seen))
    assert lengths == sorted(lengths)
    assert lengths[-1] == len(records) - (name == OPEN)


@pytest.mark.parametrize(("name", "mask"), [(CLOSED, 0x01), (OPEN, 0x04), (OPEN, 0xFF)])
def test_flip_any_byte(small, name, mask):
    path, records = small(name)
    data = bytearray(path.read_bytes())
    silent = []
    for place in places(path):
        data[place] ^= mask
        path.write_bytes(data)
        data[place] ^= mask
        seen, error = read(path)
        assert seen == records[: len(seen)], place
        if error is None and len(seen) == len(records):
            silent.append(place)
    if path.name == CLOSED:
        assert silent == [], "every altered byte of a closed file is noticed"


@pytest.mark.parametrize("name", [CLOSED, OPEN])
def test_random_damage(small, name):
    path, records = small(name)
    whole = path.read_bytes()

    @settings(max_examples=300, deadline=None)
    @given(st.integers(0, len(whole) - 1), st.binary(max_size=64), st.integers(0, 200))
    def damage(start, junk, removed):
        path.write_bytes(whole[:start] + junk + whole[start + removed :])
        seen, _ = read(path)
        assert seen == records[: len(seen)]

    damage()


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(st.sampled_from([*map(int, Opcode), 0, 0x99]), st.binary(max_size=80)), max_size=6))
def test_any_bytes_in_well_formed_frames(tmp_path, frames):
    path = tmp_path / CLOSED
    body = b"".join(struct.pack("<BQ", opcode, len(data)) + data for opcode, data in frames)
    path.write_bytes(MAGIC + body)
    found = scan(path)
    assert not found.whole
    assert found.chunks == []


def test_a_damaged_file_ends_the_reading_there(recorded, tape):
    """The next file is right in itself, but the messages between are missing."""
    folder = recorded(tape.walk(40), every=10, closed=False)
    later = recorded(tape.walk(40, first=40), folder=folder.parent / "later", closed=False)
    (later / OPEN).rename(folder / "raw_001.mcap.part")
    data = bytearray((folder / OPEN).read_bytes())
    data[len(data) // 2] ^= 1
    (folder / OPEN).write_bytes(data)
    seen, error = read(folder / OPEN)
    assert len(seen) < 40
    assert seen == tape.walk(len(seen))
    assert error is not None


def with_chunk(path, chunk):
    """The opening of an open file, followed by a chunk of our making."""
    with path.open("rb") as file:
        first = next(frame for frame in read_frames(file) if frame.opcode == Opcode.CHUNK)
    builder = RecordBuilder()
    chunk.write(builder)
    path.write_bytes(path.read_bytes()[: first.offset - 9] + builder.end())


def test_a_decompression_bomb_is_refused(recorded, tape):
    folder = recorded(tape.walk(3), closed=False)
    for claimed in (1 << 32, 100):
        bomb = zstandard.ZstdCompressor(level=19).compress(bytes(200 << 20))
        with_chunk(folder / OPEN, Chunk("zstd", bomb, 0, 0, 1, claimed))
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        found = scan(folder / OPEN)
        assert found.damage.kind is DamageKind.CORRUPT
        assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 64 * 1024


def test_a_frame_that_hides_its_size_is_refused(recorded, tape):
    folder = recorded(tape.walk(3), closed=False)
    data = b"x" * 1000
    hidden = zstandard.ZstdCompressor(write_content_size=False).compress(data)
    with_chunk(folder / OPEN, Chunk("zstd", hidden, 0, 0, zlib.crc32(data), len(data)))
    assert scan(folder / OPEN).damage.kind is DamageKind.CORRUPT


def test_other_compressions_are_refused(recorded, tape):
    folder = recorded(tape.walk(3), closed=False)
    with_chunk(folder / OPEN, Chunk("lz4", b"abc", 0, 0, 1, 3))
    assert "lz4" in str(scan(folder / OPEN).damage)


def test_a_record_longer_than_the_file_is_not_allocated(recorded, tape):
    folder = recorded(tape.walk(3), closed=False)
    with (folder / OPEN).open("ab") as file:
        file.write(struct.pack("<BQ", Opcode.CHUNK, 1 << 60))
    found = scan(folder / OPEN)
    assert found.damage.kind is DamageKind.TRUNCATED
    assert found.messages == 4


@pytest.mark.parametrize("opcode", [0x00, Opcode.HEADER, Opcode.FOOTER, Opcode.MESSAGE, Opcode.MESSAGE_INDEX, 0x99])
def test_a_record_that_does_not_belong_there_is_damage(recorded, tape, opcode):
    """Were it skipped, a chunk whose kind was altered would be a hole that nobody notices."""
    folder = recorded(tape.walk(3), closed=False)
    with (folder / OPEN).open("ab") as file:
        file.write(struct.pack("<BQ", opcode, 22) + bytes(22))
    found = scan(folder / OPEN)
    assert found.damage.kind is DamageKind.CORRUPT
    assert found.messages == 4


def test_a_chunk_counts_as_a_whole_or_not_at_all(recorded, tape):
    """Of a chunk that does not follow on, nothing may be taken as held: it would never be asked for again."""
    other = tape.hub._replace(source="other")
    first = [*tape.walk(5), *tape.walk(5, other)]
    third = [tape.record(other, 5), *tape.walk(9, first=15)]
    folder = recorded([*first, *tape.walk(10, first=5), *third], every=10, closed=False)
    with (folder / OPEN).open("rb") as file:
        chunks = [frame for frame in read_frames(file) if frame.opcode == Opcode.CHUNK]
    data = (folder / OPEN).read_bytes()
    (folder / OPEN).write_bytes(data[: chunks[1].offset - 9] + data[chunks[2].offset - 9 :])
    found = scan(folder / OPEN)
    assert found.damage.kind is DamageKind.CORRUPT
    assert {name: place.sequence for name, place in found.ledger.positions().items()} == {"imu/hub": 4, "imu/other": 4}
    assert read(folder / OPEN)[0] == sorted(first, key=lambda record: record.envelope.captured_ns)


def test_a_repeated_chunk_is_noticed(recorded, tape):
    """Each chunk is right in itself; the sequence numbers tell."""
    folder = recorded(tape.walk(20), every=10, closed=False)
    with (folder / OPEN).open("rb") as file:
        chunks = [frame for frame in read_frames(file) if frame.opcode == Opcode.CHUNK]
    data = (folder / OPEN).read_bytes()
    second = data[chunks[1].offset - 9 :]
    (folder / OPEN).write_bytes(data + second)
    assert scan(folder / OPEN).damage.kind is DamageKind.CORRUPT
    (folder / OPEN).write_bytes(data[: chunks[0].offset - 9] + second)
    assert scan(folder / OPEN).messages == 0
