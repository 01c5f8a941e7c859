"""The table of sections."""

from pathlib import Path

import pytest

from services.bench.metrics import board
from services.bench.metrics.board import Advance, Part, run
from services.bench.report import Section
from services.bench.scoreboard import at_most
from services.ingest.errors import MissingFile


def short(advance: Advance) -> Section:
    """A section with one figure."""
    advance()
    return Section("a short one", ["How it was done."], [at_most("its figure", 1.0, "m", 2.0, baseline=3.0)])


def without_data(advance: Advance) -> Section:
    """A section whose recordings are missing."""
    raise MissingFile("no recordings here")


@pytest.fixture(autouse=True)
def _sections(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(board, "SECTIONS", {"short": Part(short), "missing": Part(without_data)})


def test_everything_runs_and_says_what_could_not_be_measured(tmp_path: Path) -> None:
    """Asked for nothing in particular, a section without its data is a row that says so; the report has all."""
    result = run(tmp_path / "rows.json", report=tmp_path / "report")
    assert [(row.name, row.value, row.met) for row in result.rows] == [
        ("its figure", 1.0, True),
        ("missing", None, None),
    ]
    text = (tmp_path / "report" / "report.md").read_text()
    assert "Targets: 1 of 1 met" in text
    assert "How it was done." in text
    assert "no recordings here" in text
    assert "its figure" in (tmp_path / "rows.json").read_text()


def test_what_is_asked_for_must_be_there() -> None:
    """A section by name: one that does not exist or has no data is an error."""
    assert [row.name for row in run(None, "short").rows] == ["its figure"]
    with pytest.raises(ValueError, match="short, missing"):
        run(None, "short", "long")
    with pytest.raises(MissingFile):
        run(None, "missing")
