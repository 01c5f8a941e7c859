import pytest
from hypothesis import given
from hypothesis import strategies as st

from schemas.archive_layout import SegmentName, folder_name, parse_file_name, parse_topic, topic
from schemas.signals import SIGNALS

VERSIONS = st.none() | st.from_regex(r"[A-Za-z0-9][A-Za-z0-9.+-]{0,12}", fullmatch=True)


@given(VERSIONS, st.integers(0, 999_999), st.booleans())
def test_file_names_and_back(version, number, part):
    name = SegmentName("raw" if version is None else "derived", version, number, part)
    assert parse_file_name(name.file_name) == name
    assert parse_file_name(name.sealed.file_name) == name._replace(part=False)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (SegmentName("raw", None, 0, False), "raw.mcap"),
        (SegmentName("raw", None, 12, True), "raw_012.mcap.part"),
        (SegmentName("derived", "0.1.0", 1, False), "derived-0.1.0_001.mcap"),
        (SegmentName("derived", "0.1.0+1f2e3d4c", 2, True), "derived-0.1.0+1f2e3d4c_002.mcap.part"),
    ],
)
def test_file_names_as_people_see_them(name, text):
    assert name.file_name == text


@pytest.mark.parametrize(
    "text", ["", "raw", "raw.mcap.sealing", "derived.mcap", "derived-.mcap", "../raw.mcap", "raw_1.mcap"]
)
def test_other_files_are_no_segments(text):
    assert parse_file_name(text) is None


@pytest.mark.parametrize("signal", SIGNALS, ids=lambda signal: signal.name)
def test_topics_and_back(signal):
    assert parse_topic(topic(signal, "some/source")) == (signal, "some/source")


def test_other_topics_are_no_streams():
    assert [parse_topic(text) for text in ("stream_end/archive", "imu", "imu/", "")] == [None] * 4


@pytest.mark.parametrize("session", ["", ".", "..", "../x", "a/b", "a\\b", "-x", "a b", "é", "a" * 65, "a\n"])
def test_ids_that_could_leave_the_folder_are_refused(session):
    with pytest.raises(ValueError, match="session id"):
        folder_name(session)


def test_ordinary_ids_name_their_folder():
    assert folder_name("3f9a-0b_C") == "3f9a-0b_C"
