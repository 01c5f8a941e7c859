import json
from dataclasses import replace

import jsonschema
import pytest
from mcap.reader import NonSeekingReader, make_reader

from schemas.archive_layout import END_TOPIC, SESSION_METADATA, parse_file_name
from schemas.health import Gap, Reason
from schemas.session import SessionDescription
from services.archive.parameters import PARAMETERS
from services.archive.writer import SessionWriter
from services.flow.message import DecodeError
from services.recordings.errors import DamagedRecording, NotARecording
from services.recordings.folder import derived_versions, read_manifest, verify
from services.recordings.ledger import Ledger
from services.recordings.reader import open_recording


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def read(folder, **options):
    return list(open_recording(folder, **options).records())


@pytest.mark.parametrize("closed", [True, False])
def test_what_was_written_is_read_back_in_time_order(recorded, tape, description, closed):
    both = [record for pair in zip(tape.walk(100), tape.walk(100, tape.joints), strict=True) for record in pair]
    both.append(tape.record(tape.hub, 100, final=True))
    folder = recorded(both, closed=closed)
    assert read(folder) == both
    assert open_recording(folder).description == description


def test_files_are_named_as_the_layout_says_and_verified(recorded, tape):
    folder = recorded([*tape.walk(30), *tape.walk(30, tape.joints)])
    assert names(folder) == ["derived-0.1.0.mcap", "manifest.json", "raw.mcap"]
    assert verify(folder) == []
    manifest = read_manifest(folder)
    spans = {span.stream: span for entry in manifest.files for span in entry.streams}
    assert {name: (span.first_sequence, span.last_sequence, span.count) for name, span in spans.items()} == {
        "imu/hub": (0, 29, 30),
        "joint_state/estimation": (0, 29, 30),
    }
    assert manifest.duration_s == pytest.approx(0.29)


def test_a_stream_keeps_its_order_when_its_times_go_back(recorded, tape):
    times = [0, 50, 20, 70, 60, 10, 90]
    events = [tape.record(tape.events, place, captured_ns=time * 10**6) for place, time in enumerate(times)]
    end = tape.record(tape.events, len(times), captured_ns=0, final=True)
    folder = recorded([*events, end, *tape.walk(12)], every=3)
    assert [record for record in read(folder) if record.stream == tape.events] == [*events, end]


def test_what_was_recorded_late_is_given_out_at_its_time(recorded, tape):
    """After a restart a stream's past is written behind another stream's present."""
    folder = recorded([*tape.walk(200, tape.joints), *tape.walk(200, tape.events)])
    given = [record.envelope.captured_ns for record in read(folder)]
    assert given == sorted(given)
    assert len(given) == 400


def test_duplicates_are_dropped_and_older_epochs_too(recorded, tape):
    folder = recorded([*tape.walk(5), *tape.walk(5), tape.record(tape.hub, 0, epoch=1), *tape.walk(7)])
    assert [(record.envelope.epoch, record.envelope.sequence) for record in read(folder)] == [
        *((0, place) for place in range(5)),
        (1, 0),
    ]


def test_a_hole_is_written_as_a_gap(recorded, tape):
    folder = recorded([*tape.walk(5), *tape.walk(5, first=8), tape.record(tape.hub, 3, epoch=1)])
    gaps = [Gap.model_validate_json(record.payload) for record in read(folder) if record.stream.signal.name == "gap"]
    assert [(gap.stream, gap.epoch, gap.first_sequence, gap.last_sequence) for gap in gaps] == [
        ("imu/hub", 0, 5, 7),
        ("imu/hub", 1, 0, 2),
    ]


def test_what_no_file_can_hold_is_counted_and_leaves_a_gap(tmp_path, description, tape):
    writer = SessionWriter(tmp_path, description, "1")
    writer.write(tape.record(tape.hub, 0))
    writer.write(tape.record(tape.hub, 1, captured_ns=-(2**63)))
    writer.write(tape.record(tape.hub, 2, payload=b"x" * (17 << 20)))
    writer.write(tape.record(tape.hub, 3))
    writer.flush()
    assert writer.counts.refused == {("imu/hub", Reason.OUT_OF_RANGE): 2}
    assert writer.counts.lost == 2
    writer.close()


def test_durable_positions_wait_for_the_flush(tmp_path, description, tape):
    writer = SessionWriter(tmp_path, description, "1")
    for record in [*tape.walk(3), tape.record(tape.hub, 3, final=True)]:
        writer.write(record)
    assert writer.durable.positions == {}
    writer.flush()
    assert writer.durable.positions == {"imu/hub": 3}
    assert writer.durable.ended == {"imu/hub"}
    writer.close()


def test_rotation_begins_new_files_and_loses_nothing(recorded, tape):
    clock = iter(range(10**6))
    records = [*tape.walk(200), *tape.walk(200, tape.joints)]
    brisk = replace(PARAMETERS, rotation_s=15)
    folder = recorded(records, parameters=brisk, monotonic_s=lambda: float(next(clock)))
    assert len([name for name in names(folder) if parse_file_name(name)]) == 4
    assert read(folder) == sorted(records, key=lambda record: record.envelope.captured_ns)


def test_a_missing_file_is_noticed(recorded, tape, tmp_path):
    folder = recorded(tape.walk(20))
    ledger = Ledger()
    ledger.absorb(open_recording(folder).ledger.spans())
    recorded(tape.walk(20, first=20), folder=folder, ledger=ledger, first_number=1)
    assert len(read(folder)) == 40
    (folder / "raw.mcap").unlink()
    read_until_error(folder)
    (folder / "manifest.json").unlink()
    read_until_error(folder)


def read_until_error(folder):
    records = open_recording(folder).records()
    with pytest.raises(DamagedRecording):
        list(records)


def test_a_folder_without_a_recording_is_a_typed_error(tmp_path):
    with pytest.raises(NotARecording):
        open_recording(tmp_path)
    (tmp_path / "raw.mcap").write_bytes(b"nonsense")
    with pytest.raises(NotARecording):
        open_recording(tmp_path)


def test_messages_decode_or_say_why_not(recorded, tape):
    good = b'{"sensors":[{"captured_ns":[1],"angular_velocity":[[0,0,0]],"specific_force":[[0,9.8,0]]}],"marks":[]}'
    folder = recorded([tape.record(tape.hub, 0, payload=good), tape.record(tape.hub, 1, final=True)])
    message, end = open_recording(folder).messages()
    assert message.payload.sensors[0].specific_force == [[0, 9.8, 0]]
    assert end.payload is None
    assert end.envelope.final
    recorded_badly = recorded([tape.record(tape.hub, 0, payload=b"\xff\x00")], folder=folder.parent / "s2")
    with pytest.raises(DecodeError):
        list(open_recording(recorded_badly).messages())


def test_any_mcap_reader_sees_named_json_channels_with_schemas(recorded, tape, description):
    good = b'{"sensors":[{"captured_ns":[1],"angular_velocity":[[0,0,0]],"specific_force":[[0,9.8,0]]}],"marks":[]}'
    folder = recorded([tape.record(tape.hub, 0, payload=good), tape.record(tape.hub, 1, final=True)])
    with (folder / "raw.mcap").open("rb") as file:
        reader = make_reader(file)
        summary = reader.get_summary()
        assert {channel.topic for channel in summary.channels.values()} == {"imu/hub", "session/ingest", END_TOPIC}
        for schema, channel, message in reader.iter_messages():
            assert channel.message_encoding == "json"
            assert schema.encoding == "jsonschema"
            assert channel.metadata["time_unit"] == "ns"
            jsonschema.validate(json.loads(message.data), json.loads(schema.data))
        metadata = next(iter(reader.iter_metadata()))
        assert metadata.name == SESSION_METADATA
        assert SessionDescription.model_validate_json(metadata.metadata["description"]) == description
        assert reader.get_header().profile == "ambula"


def test_a_file_under_way_is_readable_by_the_library_too(recorded, tape):
    folder = recorded(tape.walk(50), closed=False)
    seen = []
    with (folder / "raw.mcap.part").open("rb") as file, pytest.raises(Exception):  # noqa: B017, PT012
        for _, channel, message in NonSeekingReader(file).iter_messages(log_time_order=False):
            seen.append((channel.topic, message.sequence))
    assert seen == [("session/ingest", 0), *(("imu/hub", place) for place in range(50))]


def test_another_version_of_the_derived_files_is_read_by_its_name(recorded, tape):
    """The one that was written live is not missed then."""
    folder = recorded([*tape.walk(5), *tape.walk(5, tape.joints)])
    assert derived_versions(folder) == ["0.1.0"]
    (folder / "derived-0.1.0.mcap").rename(folder / "derived-0.1.0+1f2e3d4c.mcap")
    assert derived_versions(folder) == ["0.1.0+1f2e3d4c"]
    read_until_error(folder)
    assert len(read(folder, derived_version="0.1.0+1f2e3d4c")) == 10
    assert "missing" in str(open_recording(folder).problem)
    assert "derived" in open_recording(folder).problem.path.name


def test_versions_come_in_the_order_in_which_they_were_stored(recorded, tape):
    folder = recorded([*tape.walk(5), *tape.walk(5, tape.joints)])
    for version in ("0.0.9+ffffffff", "0.2.0"):
        (folder / f"derived-{version}.mcap").write_bytes((folder / "derived-0.1.0.mcap").read_bytes())
    (folder / "derived-0.3.0.mcap.part").touch()
    assert derived_versions(folder) == ["0.1.0", "0.0.9+ffffffff", "0.2.0"]
    (folder / "manifest.json").unlink()
    assert derived_versions(folder) == ["0.0.9+ffffffff", "0.1.0", "0.2.0"]
