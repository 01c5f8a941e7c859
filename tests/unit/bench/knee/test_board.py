"""The scoreboard of the knee: subjects, report, what is missing."""

import re

import pytest

from services.bench.knee import axis_board, board
from services.bench.knee.legs import walking
from services.bench.registry import knee
from services.bench.report import Section, Table
from services.bench.scoreboard import at_most
from services.ingest.errors import MissingFile

SECTION = Section(
    "Hinge", ["How it was done."], [at_most("error", 0.5, "deg", 1.0)], [Table("Angles", ("a", "b"), [("1", "2")])],
    {"drawn": "<svg/>"},
)  # fmt: skip


def absent(_):
    raise MissingFile("the recording is not there")


@pytest.fixture(autouse=True)
def invented(monkeypatch):
    monkeypatch.setattr(board, "SUBJECTS", {"hinge": lambda _: SECTION, "fan": absent})


def test_a_report_holds_what_was_measured_and_why_the_rest_was_not(tmp_path):
    result = knee(tmp_path / "rows.json", report=tmp_path / "report")
    assert [row.name for row in result.rows] == ["error", "fan"]
    text = (tmp_path / "report" / "report.md").read_text(encoding="utf-8")
    assert "## Targets: 1 of 1 met" in text
    assert "the recording is not there" in text
    assert "**Angles**" in text
    for chart in re.findall(r"\((\w+\.svg)\)", text):
        assert (tmp_path / "report" / chart).exists()
    assert (tmp_path / "rows.json").exists()


def test_one_subject_without_its_data_says_so():
    with pytest.raises(MissingFile):
        knee(None, "fan")
    with pytest.raises(ValueError, match="measured on hinge, fan"):
        knee(None, "elbow")


def test_the_axis_of_a_leg_is_studied_by_every_method_at_hand(monkeypatch):
    monkeypatch.setattr(axis_board, "PREFIXES_S", (10.0, float("inf")))
    monkeypatch.setattr(axis_board.peers, "missing", lambda *_: "not installed: any")
    found = axis_board.study(axis_board.leg_recording("leg", walking(), 5))
    assert set(found.by_prefix) == {"ours", "Seel", "PCA, true orientations"}
    rows = {row.name: row.value for row in axis_board.axis_rows("leg", [found])}
    assert rows["leg: axis error, PCA, true orientations, all samples"] < 10.0
    assert rows["leg: axis error, PCA on VQF"] is None
    assert len(axis_board.prefix_table("leg", [found]).rows[0]) == 3
    assert "axis error, deg" in axis_board.convergence_chart("leg", found)
