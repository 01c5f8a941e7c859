"""Learned rhythms are read from a file, a run's folder or an archived session, or it is said why not."""

import pytest
from typer.testing import CliRunner

from schemas.rhythm import LearnedJoint, LearnedRhythm
from schemas.signals import LEARNED_RHYTHM
from services.archive.writer import SessionWriter
from services.cli.__main__ import app
from services.cli.rhythms import NoRhythm, read_known, read_rhythm
from services.flow.message import Envelope, Stream, encode_payload
from services.ingest.source import open_source
from services.recordings.record import Record


def learned(strides: int = 5) -> LearnedRhythm:
    joint = LearnedJoint(degree_of_freedom="knee_flexion_left", cosine=[0.3], sine=[0.1], spread=[0.01])
    return LearnedRhythm(
        captured_ns=9, frequency=6.0, frequency_spread=0.1, strides=strides, quality=0.9, joints=[joint]
    )


def archived(folder, *rhythms: LearnedRhythm):
    folder.mkdir()
    writer = SessionWriter(folder, open_source("synthetic:walk?duration=5").describe(), "0.1.0")
    for sequence, rhythm in enumerate(rhythms):
        envelope = Envelope(0, sequence, 9 + sequence)
        writer.write(Record(Stream(LEARNED_RHYTHM, "estimation"), envelope, encode_payload(rhythm), sequence))
    writer.flush()
    writer.close()
    return folder


def test_from_a_file_from_a_run_and_the_last_of_an_archived_session(tmp_path):
    file = tmp_path / "learned_rhythm.json"
    file.write_text(learned(7).model_dump_json())
    assert read_rhythm(file).strides == 7
    assert read_rhythm(tmp_path).strides == 7
    assert read_rhythm(archived(tmp_path / "session", learned(4), learned(9))).strides == 9


@pytest.mark.parametrize("case", ["missing", "no json", "something else", "empty folder", "nothing learned"])
def test_where_there_is_none_the_reason_is_said(tmp_path, case):
    path = tmp_path / "file.json"
    if case == "no json":
        path.write_text("{")
    if case == "something else":
        path.write_text('{"frequency": 1}')
    if case == "empty folder":
        path.mkdir()
    if case == "nothing learned":
        archived(path)
    with pytest.raises(NoRhythm, match=r"file\.json"):
        read_rhythm(path)


def test_none_given_leaves_the_choice_to_the_source(tmp_path):
    assert read_known({"previous trial": None, "exemplar": None}) is None
    file = tmp_path / "healthy.json"
    file.write_text(learned().model_dump_json())
    [known] = read_known({"previous trial": None, "exemplar": file})
    assert (known.kind, known.name) == ("exemplar", "healthy")


def test_the_command_writes_what_it_reads(tmp_path):
    file = tmp_path / "exemplar.json"
    session = archived(tmp_path / "session", learned(6))
    assert CliRunner().invoke(app, ["exemplar", str(session), "--out", str(file)]).exit_code == 0
    assert read_rhythm(file) == learned(6)
    assert CliRunner().invoke(app, ["exemplar", str(tmp_path / "no"), "--out", str(file)]).exit_code == 1
