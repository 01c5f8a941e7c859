"""`ambula synth`: any motion becomes a folder that replays."""

import pytest
from typer.testing import CliRunner

from services.cli.__main__ import app
from services.ingest.source import open_source


@pytest.mark.parametrize(
    ("arguments", "title", "sources"),
    [
        (["--walk", "duration=6&seed=2"], "walk", (1, 0)),
        (["--march", "duration=6"], "march", (1, 0)),
        (["--motion", "squat?repetitions=1&seed=7"], "squats", (0, 1)),
        (["--motion", "walk?camera=1&duration=6"], "before a camera", (1, 1)),
    ],
)
def test_a_motion_is_written(tmp_path, arguments, title, sources):
    result = CliRunner().invoke(app, ["synth", "--out", str(tmp_path / "made"), *arguments])
    assert result.exit_code == 0, result.output
    description = open_source(str(tmp_path / "made")).describe()
    assert title in description.title
    assert (len(description.hubs), len(description.cameras)) == sources


@pytest.mark.parametrize(
    ("motion", "word"), [("swim", "swim"), ("squat?hold=99", "hold"), ("squat?speed=1", "speed")]
)  # fmt: skip
def test_what_cannot_be_made_is_said(tmp_path, motion, word):
    result = CliRunner().invoke(app, ["synth", "--out", str(tmp_path / "made"), "--motion", motion])
    assert result.exit_code != 0
    assert word in result.output
    assert not (tmp_path / "made").exists()
