"""`ambula export` of an archived session."""

import pytest
from typer.testing import CliRunner

from schemas.signals import JOINT_STATE
from schemas.vocabulary import LOWER_BODY
from services.cli.__main__ import app
from services.flow.message import encode_payload

COUNT = 30


@pytest.fixture
def folder(recorded, tape):
    nothing = [[0.0] * len(LOWER_BODY)]
    records = []
    for n in range(COUNT):
        state = JOINT_STATE.model(
            model="lower_body", captured_ns=[n * 10_000_000], position=[[0.2] * len(LOWER_BODY)], velocity=nothing,
            acceleration=nothing, position_std=nothing, velocity_std=nothing, valid=[True] * len(LOWER_BODY),
            observed=[],
        )  # fmt: skip
        records.append(tape.record(tape.joints, n, payload=encode_payload(state)))
    return recorded(records)


def run(*words):
    return CliRunner().invoke(app, ["export", *map(str, words)])


def names(out):
    return sorted(path.name for path in out.iterdir())


def test_all_that_can_be_had_is_written_and_the_rest_says_why(folder, tmp_path):
    result = run(folder, "--out", tmp_path / "files")
    assert result.exit_code == 0, result.output
    assert names(tmp_path / "files") == [
        "ambula-s1-foxglove.mcap", "ambula-s1-joint_angles.csv", "ambula-s1.c3d", "ambula-s1.mot", "ambula-s1.sto",
        "ambula-s1.trc",
    ]  # fmt: skip
    assert "strides.csv: not written; the session holds no stride messages" in result.output.replace("\n", " ")


def test_a_session_is_found_by_its_id(folder, tmp_path, monkeypatch):
    monkeypatch.setenv("AMBULA_DATA_DIR", str(folder.parent))
    assert run("s1", "--out", tmp_path / "files", "--format", "c3d").exit_code == 0
    assert names(tmp_path / "files") == ["ambula-s1.c3d"]


def test_what_was_asked_for_and_cannot_be_had_is_an_error_and_leaves_nothing(folder, tmp_path):
    result = run(folder, "--out", tmp_path / "files", "--format", "strides.csv")
    assert result.exit_code == 1
    assert "holds no stride messages" in result.output.replace("\n", " ")
    assert names(tmp_path / "files") == []


@pytest.mark.parametrize(
    ("words", "what"),
    [
        (("--format", "xls"), "'xls' is none of metrics.csv"),
        (("--model", "gait2392"), "'gait2392' is none of rajagopal"),
    ],
)
def test_a_wrong_choice_is_told_before_anything_is_read(tmp_path, words, what):
    result = run("s1", "--out", tmp_path / "files", *words)
    assert result.exit_code == 1
    assert what in result.output.replace("\n", " ")
    assert not (tmp_path / "files").exists()


def test_the_models_own_file_tells_the_sign(folder, tmp_path):
    model = tmp_path / "mine.osim"
    model.write_text('<Model><Coordinate name="knee_angle_r"><range>-2.1 0.2</range></Coordinate></Model>')
    assert run(folder, "--out", tmp_path / "files", "--format", "mot", "--model", model).exit_code == 0
    rows = (tmp_path / "files" / "ambula-s1.mot").read_text().partition("endheader\n")[2].splitlines()
    assert rows[0] == "time\tknee_angle_r"
    assert float(rows[1].split("\t")[1]) == pytest.approx(-11.459, abs=1e-3)


def test_a_damaged_recording_leaves_no_half_file(folder, tmp_path):
    path = folder / "derived-0.1.0.mcap"
    path.write_bytes(path.read_bytes()[:-1500])
    result = run(folder, "--out", tmp_path / "files", "--format", "joint_angles.csv")
    assert result.exit_code == 1
    assert names(tmp_path / "files") == []
