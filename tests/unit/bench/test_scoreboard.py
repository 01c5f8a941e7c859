import json
from pathlib import Path

import pytest

from services.bench.registry import SCOREBOARDS
from services.bench.scoreboard import Row, Scoreboard, at_least, at_most, informative


def test_targets_are_met_or_missed() -> None:
    assert at_most("a", 3.0, "deg", 3.5).met is True
    assert at_most("a", 3.6, "deg", 3.5).met is False
    assert at_least("a", 20.0, "x", 15.0).met is True
    assert at_least("a", 10.0, "x", 15.0).met is False
    assert informative("a", 1.0, "us").met is None


def test_missed_rows_can_be_listed() -> None:
    board = Scoreboard("title", [at_most("good", 1.0, "s", 2.0), at_most("bad", 3.0, "s", 2.0)])
    assert [row.name for row in board.missed] == ["bad"]


def test_rows_are_written_as_json(tmp_path: Path) -> None:
    board = Scoreboard("title", [at_most("a", 1.0, "s", 2.0, 5.0), Row("b", None, "", "no data", None, None)])
    board.write_json(tmp_path / "rows.json")
    document = json.loads((tmp_path / "rows.json").read_text())
    assert document["rows"][0] == {
        "name": "a", "value": 1.0, "unit": "s", "target": "<= 2", "met": True, "baseline": 5.0,
    }  # fmt: skip
    assert document["rows"][1]["value"] is None


def test_the_table_shows_every_row(capsys: pytest.CaptureFixture[str]) -> None:
    Scoreboard("title", [at_most("first", 1.0, "s", 2.0), at_most("second", 3.0, "s", 2.0)]).print()
    printed = capsys.readouterr().out
    assert "first" in printed
    assert "second" in printed
    assert "missed" in printed


def test_every_scoreboard_says_what_it_measures() -> None:
    assert {"accuracy", "step", "rhythm"} <= set(SCOREBOARDS)
    assert all((board.__doc__ or "").strip() for board in SCOREBOARDS.values())
