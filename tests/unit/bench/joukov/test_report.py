"""The report: its sections, its findings, and that everything named in it is there."""

import re

import pytest

from services.bench.joukov import board
from services.bench.joukov.report import write_report
from services.bench.joukov.sections import Finding, Section, change, up_to
from services.bench.registry import SCOREBOARDS, joukov
from services.bench.report import Table, number
from services.bench.scoreboard import at_most, informative

SECTION = Section(
    "Single joints",
    ["What was done at S*, and at S*/10."],
    [at_most("error at S*", 0.5, "deg", 1.0), informative("more", 2.0, "deg", detail=True)],
    [Table("Table at S*", ("", "EKF | ours"), [("one", "1.0"), ("two", "2.0")])],
    {"drawn": "<svg/>"},
    [Finding("position -27 %", "-30 % at S*, -40 % at S*/10", "up to 1e4")],
)


def test_a_report_has_its_findings_targets_tables_and_charts(tmp_path):
    write_report(tmp_path, "joukov, 5 motions", [SECTION, Section("Strides", [], [])])
    text = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert "| position -27 % | -30 % at S\\*, -40 % at S\\*/10 | up to 1e4 |" in text
    assert "## Targets: 1 of 1 met" in text
    assert "## 1. Single joints" in text
    assert "## 2. Strides" in text
    assert "EKF \\| ours" in text
    assert re.search(r"<details>.*more.*</details>", text, re.DOTALL)
    for chart in re.findall(r"\((\w+\.svg)\)", text):
        assert (tmp_path / chart).exists()
    assert "**S** is the process noise" in text
    assert r"**S\*** is a tuning" in text
    assert r"What was done at S\*, and at S\*/10." in text


def test_numbers_are_short():
    assert [number(v) for v in (0.1234, 12.34, 1234.5, float("nan"))] == ["0.12", "12.3", "1234", "-"]
    assert [up_to(S) for S in (1e4, 31622.8, None)] == ["up to 1.0e4", "up to 3.2e4", "at no S tried"]
    assert [change(r) for r in (0.6, 1.02)] == ["-40 %", "+2 %"]


def test_parts_are_chosen_by_name(monkeypatch, tmp_path):
    called = []
    parts = {name: lambda work, name=name: called.append((name, work.motions)) or [SECTION] for name in board.PARTS}
    monkeypatch.setattr(board, "PARTS", parts)
    joukov(None, "7", "tables")
    joukov(None, "strides", "events", report=tmp_path)
    assert called == [("tables", 7), ("strides", board.MOTIONS), ("events", board.MOTIONS)]
    assert (tmp_path / "report.md").exists()


@pytest.mark.parametrize("subject", [("neura",), ("5", "7"), ("tables", "walking")])
def test_what_is_no_part_is_refused(subject):
    with pytest.raises(ValueError, match="parts of simulation, curve, tables"):
        joukov(None, *subject)


def test_joukov_is_listed():
    assert SCOREBOARDS["joukov"] is joukov
