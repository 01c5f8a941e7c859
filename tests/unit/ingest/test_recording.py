"""A recording folder becomes samples, or an error that says where and what to do."""

import gzip
import math

import pytest

from schemas.health import Reason
from schemas.imu import ImuBatch, ReferenceBatch
from services.flow.message import decode_payload, encode_payload
from services.ingest.errors import (
    ClockError,
    EmptyFile,
    InvalidManifest,
    InvalidOption,
    MissingColumn,
    MissingFile,
    NotANumber,
    SourceError,
    UnknownSegment,
    UnknownSource,
    UnknownUnit,
    UnreadableFile,
    WrongFieldCount,
    WrongUnits,
)
from services.ingest.source import iter_messages, open_source


def opened(folder):
    return open_source(str(folder.write()), session="s1")


def batches(source, model):
    return [message.payload for message in iter_messages(source) if isinstance(message.payload, model)]


def counted(source):
    return {(found.subject, found.reason): found.count for found in source.rejections()}


def test_description_is_what_the_manifest_says(folder):
    description = opened(folder).describe()
    thigh, shank = description.hubs[0].sensors
    assert (description.session, description.origin, description.estimator) == ("s1", "recording", "rhythmic_ekf")
    assert (thigh.name, thigh.segment, thigh.outward_axis, thigh.rate_hz) == ("thigh", "thigh_right", [0, 0, 1], 50.0)
    assert shank.position_in_segment is None
    assert description.duration_s == pytest.approx(199 / 50)
    assert [(channel.name, channel.unit) for channel in description.reference] == [
        ("knee_flexion_right", "rad"), ("ankle_right_x", "m"), ("ankle_right_y", "m"), ("ankle_right_z", "m"),
    ]  # fmt: skip


def test_messages_are_numbered_ticks_and_close_every_stream(folder):
    messages = list(iter_messages(opened(folder)))
    imu = [message for message in messages if message.stream.name == "imu/hub"]
    assert [message.envelope.sequence for message in imu] == list(range(201))
    assert [message.envelope.final for message in imu] == [False] * 200 + [True]
    assert imu[1].envelope.captured_ns == 20_000_000
    assert imu[-1].payload is None
    assert messages[-1].stream.name == "reference/reference"
    assert messages[-1].envelope.final
    times = [message.envelope.captured_ns for message in messages[:-2]]
    assert times == sorted(times)


def test_every_message_survives_the_wire(folder):
    for message in iter_messages(opened(folder)):
        wire = encode_payload(message.payload)
        assert decode_payload(message.stream.signal, message.envelope, wire) == message.payload


def test_batches_hold_the_same_samples(folder):
    source = opened(folder)
    single = [batch.sensors[0].captured_ns for batch in batches(source, ImuBatch)]
    triple = [message.payload for message in iter_messages(source, ticks=3) if isinstance(message.payload, ImuBatch)]
    assert len(triple) == 67
    assert [time for times in single for time in times] == [t for batch in triple for t in batch.sensors[0].captured_ns]


def test_reference_is_in_si_and_isb(folder):
    first = batches(opened(folder), ReferenceBatch)[0].values[0]
    assert first == pytest.approx([math.radians(30), 1.0, 0.5, -2.0])


def test_vendor_axes_and_units_end_here(folder, columns):
    folder.toml = folder.toml.replace('unit = "m/s^2"', 'unit = "mg"').replace('unit = "rad/s"', 'unit = "deg/s"')
    folder.toml = folder.toml.replace("[imu]", '[imu]\naxes = ["y", "-x", "z"]')
    for name in ("thigh.csv", "shank.csv"):
        folder.scaled(name, columns.force, 1000 / 9.80665)
        folder.scaled(name, columns.rate, 180 / math.pi)
    samples = batches(opened(folder), ImuBatch)[150].sensors[0]
    assert samples.specific_force[0] == pytest.approx([9.81, 0, 0], abs=0.1)
    assert samples.angular_velocity[0] == pytest.approx([0, -1, 0], abs=0.03)


@pytest.mark.parametrize(("unit", "factor"), [("ms", 1e3), ("us", 1e6), ("ns", 1e9), ("frame", 50)])
def test_time_units(folder, columns, unit, factor):
    folder.toml = folder.toml.replace('unit = "s"', f'unit = "{unit}"')
    for name in folder.tables:
        folder.scaled(name, columns.time, factor)
    assert batches(opened(folder), ImuBatch)[10].sensors[1].captured_ns == [200_000_000]


def test_rows_follow_the_rate_without_a_time_column(folder):
    folder.toml = folder.toml.replace('column = "t"\n', "").replace('unit = "s"', 'unit = "frame"')
    del folder.tables["shank.csv"][51]
    assert batches(opened(folder), ImuBatch)[10].sensors[1].captured_ns == [200_000_000]


def test_a_table_without_header_and_with_a_preamble(folder):
    folder.toml = folder.toml.replace("[time]", '[format]\ndelimiter = ";"\nheader = false\nskip_lines = 2\n\n[time]')
    folder.toml = folder.toml.replace('column = "t"', 'column = "1"').partition("[[reference]]")[0]
    folder.toml = folder.toml.replace('"a{axis}"', '["2", "3", "4"]').replace('"g{axis}"', '["5", "6", "7"]')
    path = folder.write()
    for name in ("thigh.csv", "shank.csv"):
        rows = [";".join(row) for row in folder.tables[name][1:]]
        (path / name).write_text("\n".join(["device 7", "made by; nobody", *rows]))
    assert len(batches(open_source(str(path)), ImuBatch)) == 200


def test_compressed_files(folder):
    folder.toml = folder.toml.replace("{sensor}.csv", "{sensor}.csv.gz")
    path = folder.write()
    for name in ("thigh", "shank"):
        (path / f"{name}.csv.gz").write_bytes(gzip.compress((path / f"{name}.csv").read_bytes()))
    assert len(batches(open_source(str(path)), ImuBatch)) == 200


def test_a_malformed_row_is_counted(folder):
    folder.tables["thigh.csv"][30] = ["0.58", "x", "9.8", "0", "0", "0", "0"]
    folder.tables["shank.csv"][40] = folder.tables["shank.csv"][40][:5]
    source = opened(folder)
    assert counted(source) == {("thigh", Reason.MALFORMED_ROW): 1, ("shank", Reason.MALFORMED_ROW): 1}
    assert batches(source, ImuBatch)[29].sensors[0].captured_ns == []


@pytest.mark.parametrize("word", ["nan", "inf", "", "NA"])
def test_missing_samples_are_counted_and_not_sent(folder, word):
    for k in range(20, 70):
        folder.tables["shank.csv"][k][2] = word
    source = opened(folder)
    assert counted(source) == {("shank", Reason.NOT_FINITE): 50}
    assert sum(len(batch.sensors[1].captured_ns) for batch in batches(source, ImuBatch)) == 150


def test_unknown_truth_is_null(folder):
    folder.tables["truth.csv"][5][1] = "nan"
    assert batches(opened(folder), ReferenceBatch)[4].values[0][0] is None


def test_a_step_back_in_time_is_counted(folder):
    folder.tables["thigh.csv"][50][0] = "0.2"
    assert counted(opened(folder)) == {("thigh", Reason.CLOCK_BACKWARDS): 1}


def test_absurd_numbers_are_counted(folder):
    folder.tables["thigh.csv"][50][4] = "1e300"
    assert counted(opened(folder)) == {("thigh", Reason.OUT_OF_RANGE): 1}


def refused(folder, error, *words):
    with pytest.raises(error) as raised:
        opened(folder)
    for word in words:
        assert word in str(raised.value)


def spoil(name, line, column, text):
    def change(folder):
        for row in folder.tables[name][line : line + 20]:
            row[column] = text

    return change


def retold(old, new):
    def change(folder):
        assert old in folder.toml
        folder.toml = folder.toml.replace(old, new, 1)

    return change


def shortened(folder):
    folder.tables["thigh.csv"][10:20] = [row[:5] for row in folder.tables["thigh.csv"][10:20]]


def emptied(folder):
    folder.tables["thigh.csv"] = []


def header_only(folder):
    del folder.tables["thigh.csv"][1:]


def reversed_time(folder):
    folder.tables["thigh.csv"][1:] = reversed(folder.tables["thigh.csv"][1:])


def all_missing(folder):
    for row in folder.tables["thigh.csv"][1:]:
        row[1] = "nan"


FAULTS = {
    "missing file": (retold("{sensor}.csv", "{sensor}_a.csv"), MissingFile, ["thigh_a.csv"]),
    "missing data": (retold("rate_hz", 'data = "nowhere_at_all"\nrate_hz'), MissingFile, ["AMBULA_DATA"]),
    "missing column": (retold("a{axis}", "acc_{axis}"), MissingColumn, ["thigh.csv", "acc_x", "it has t, ax"]),
    "close column": (retold('column = "knee"', 'column = "kneee"'), MissingColumn, ["did you mean knee"]),
    "field count": (shortened, WrongFieldCount, ["thigh.csv, line 11", "5 fields where 7"]),
    "not a number": (spoil("thigh.csv", 10, 2, "1,5"), NotANumber, ["thigh.csv, line 11, column ay", "1,5"]),
    "empty file": (emptied, EmptyFile, ["thigh.csv"]),
    "header only": (header_only, EmptyFile, ["thigh.csv", "no rows"]),
    "all missing": (all_missing, EmptyFile, ["thigh"]),
    "unit of force": (retold('"m/s^2"', '"furlong"'), UnknownUnit, ["furlong", "m/s^2, g, mg"]),
    "unit of time": (retold('unit = "s"', 'unit = "jiffy"'), UnknownUnit, ["jiffy"]),
    "unit of truth": (retold('unit = "deg"', 'unit = "grad"'), UnknownUnit, ["grad", "deg"]),
    "segment": (retold("shank_right", "tail"), UnknownSegment, ["sensor shank", "tail", "pelvis"]),
    "misspelt key": (retold("outward_axis", "outward_axes"), InvalidManifest, ["outward_axis"]),
    "missing key": (retold("hip_width_m = 0.18", ""), InvalidManifest, ["anthropometry.hip_width_m"]),
    "no toml": (retold("[time]", "[time"), InvalidManifest, ["not TOML"]),
    "same name": (retold('name = "shank"', 'name = "thigh"'), InvalidManifest, ["'thigh'", "twice"]),
    "left-handed": (retold('"-y"]', '"y"]'), InvalidManifest, ["right-handed"]),
    "no axis": (retold('"-y"]', '"w"]'), InvalidManifest, ["'w' is no axis"]),
    "zero axis": (retold("[0, 0, 2]", "[0, 0, 0]"), InvalidManifest, ["outward_axis"]),
    "estimator": (retold("rate_hz", 'estimator = "magic"\nrate_hz'), InvalidManifest, ["magic", "ekf"]),
    "standing": (
        retold("[time]", "[[standing]]\nfrom_s = 3\nto_s = 2\n[time]"), InvalidManifest, ["standing ends before"]
    ),
    "time runs back": (reversed_time, ClockError, ["thigh.csv", "199 rows"]),
    "weeks": (retold('unit = "s"', 'unit = "frame"\noffset_s = nan'), InvalidManifest, ["time.offset_s"]),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_faults_are_named(folder, name):
    change, error, words = FAULTS[name]
    change(folder)
    refused(folder, error, *words)


def test_time_in_the_wrong_unit(folder, columns):
    folder.scaled("thigh.csv", columns.time, 1e9)
    refused(folder, ClockError, "thigh.csv", "unit")


@pytest.mark.parametrize(
    ("factor", "declared", "likely"),
    [(1 / 9.80665, "m/s^2", "g"), (1000 / 9.80665, "m/s^2", "mg"), (1.0, "g", "m/s^2"), (1.0, "mg", "m/s^2")],
)
def test_wrong_unit_of_force_is_named(folder, columns, factor, declared, likely):
    folder.toml = folder.toml.replace('"m/s^2"', f'"{declared}"')
    for name in ("thigh.csv", "shank.csv"):
        folder.scaled(name, columns.force, factor)
    refused(folder, WrongUnits, "sensor thigh", f'write unit = "{likely}"')


def test_gravity_removed(folder, columns):
    folder.scaled("thigh.csv", columns.force, 0.0)
    refused(folder, WrongUnits, "gravity was not removed")


def test_wrong_unit_of_rate_is_named(folder, columns):
    for row in folder.tables["thigh.csv"][1:]:
        row[4:] = [f"{float(text) + 0.01:.6g}" for text in row[4:]]
    folder.scaled("thigh.csv", columns.rate, 180 / math.pi)
    refused(folder, WrongUnits, "sensor thigh", 'write unit = "deg/s"')


def test_text_that_is_no_text(folder):
    path = folder.write()
    (path / "thigh.csv").write_bytes(b"\xff\xfe\x00\x01" * 100)
    with pytest.raises(UnreadableFile, match=r"thigh\.csv"):
        open_source(str(path))


def test_truncated_gzip(folder):
    folder.toml = folder.toml.replace("{sensor}.csv", "{sensor}.csv.gz")
    path = folder.write()
    (path / "thigh.csv.gz").write_bytes(gzip.compress((path / "thigh.csv").read_bytes())[:-200])
    with pytest.raises(UnreadableFile, match=r"thigh\.csv\.gz"):
        open_source(str(path))


def test_unknown_sources(tmp_path):
    with pytest.raises(UnknownSource, match="neura_s02_walk"):
        open_source("no such thing")
    with pytest.raises(UnknownSource, match="synthetic:walk"):
        open_source("synthetic:dance")
    with pytest.raises(MissingFile, match=r"recording\.toml"):
        open_source(str(tmp_path))


@pytest.mark.parametrize("options", [{"session": "a/b"}, {"session": ""}, {"session": "*"}, {"estimator": "magic"}])
def test_names_that_cannot_be(folder, options):
    with pytest.raises(InvalidOption):
        open_source(str(folder.write()), **options)


def test_every_error_is_a_source_error():
    for error in (MissingFile, MissingColumn, WrongUnits, ClockError, UnknownUnit, InvalidManifest):
        assert issubclass(error, SourceError)
