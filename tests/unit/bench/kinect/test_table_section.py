"""Table 1 for every method, and the gates."""

import numpy as np
import pytest

from services.bench.kinect import board, table_section
from services.bench.kinect.cells import PUBLISHED, agreement
from services.bench.kinect.contenders import BEST, CONTENDERS, MUST_SHOW, OPTIMISED, Piece, Result, outside, result_of
from services.bench.kinect.gates import gain_row, our_gates, projection_gap, projection_row
from services.bench.kinect.table_section import cell_text, cells_table, methods_table, shown
from services.bench.scoreboard import Scoreboard

TRUTH = np.radians(30.0) * np.sin(np.linspace(0.0, 12.0, 300))


def result(task: int, off_deg: float, size: float = 1.0) -> Result:
    """Every angle of a task off by so much."""
    return Result([agreement(task, a, size * TRUTH + np.radians(off_deg), size * TRUTH) for a in PUBLISHED[task]], 0)


def test_a_cell_tells_rmsd_its_spread_zero_mean_and_correlation() -> None:
    people = [result(1, off).cells[0] for off in (2.0, 4.0, 6.0)]
    assert cell_text(people) == "4.0 (2.0) / 0.0, 1.00"


def test_without_movement_there_is_no_correlation() -> None:
    assert cell_text([result(1, 3.0, size=0.3).cells[0]]) == "3.0 (0.0) / 0.0, small movement"


def test_what_the_paper_does_not_report_stays_empty() -> None:
    assert cell_text([]) == ""


def test_rows_are_angles_and_columns_tasks() -> None:
    table = cells_table("clinic: ours", [result(task, 2.0) for task in PUBLISHED])
    assert [len(row) for row in table.rows] == [5] * 17
    assert sum(bool(text) for row in table.rows for text in row[1:]) == 34
    knee = next(row for row in table.rows if row[0] == "7 knee flexion right")
    assert [bool(text) for text in knee[1:]] == [True, True, False, False]


def test_every_method_has_its_line() -> None:
    found = {name: [result(task, 2.0) for task in PUBLISHED] for name in MUST_SHOW}
    table = methods_table("clinic", found)
    assert [row[0] for row in table.rows] == list(MUST_SHOW)
    assert all(len(row) == len(table.header) for row in table.rows)


def test_the_terminal_shows_methods_and_the_two_that_are_compared() -> None:
    trials = [result(task, 2.0) for task in PUBLISHED]
    tables = [methods_table("clinic", dict.fromkeys(MUST_SHOW, trials))]
    tables += [cells_table(f"clinic: {name}", trials) for name in MUST_SHOW]
    assert [one.caption.split(",")[0] for one in shown(tables)] == [
        "clinic: methods", f"clinic: {OPTIMISED}".split(",")[0], f"clinic: {BEST}",
    ]  # fmt: skip


def test_gates_are_met_by_what_is_near_and_missed_by_what_is_far() -> None:
    near, far = (our_gates("clinic", [result(task, off) for task in PUBLISHED]) for off in (1.0, 20.0))
    assert all(row.met for row in near if row.target)
    assert not any(row.met for row in far if row.target and row.unit == "deg" and "zero-mean" not in row.name)
    paper = our_gates("paper", [result(task, 7.8) for task in PUBLISHED])
    assert [row.met for row in paper if row.target] == [False, True]


def test_a_frame_beyond_limits_or_not_finite_is_counted() -> None:
    angles = np.zeros((5, 22))
    angles[1, 6] = np.radians(-1.0)
    angles[2, 3] = np.nan
    angles[3, 0] = np.radians(170.0)  # the heading has no limit of its own
    assert outside(angles) == 2
    row = our_gates("clinic", [Result(result(task, 1.0).cells, 3) for task in PUBLISHED])[-1]
    assert row.met is False
    assert row.value == 12


def test_the_gain_is_against_the_same_trials() -> None:
    row = gain_row("clinic", 6.0, 15.0)
    assert row.value == pytest.approx(60.0)
    assert row.met


def test_the_projection_is_the_optimum() -> None:
    assert projection_gap(1) < 1e-9
    assert projection_row(5).met


def test_one_method_on_one_trial_gives_its_cells() -> None:
    """On a tilt, which needs no recorded squats."""
    found = result_of(Piece(BEST, "clinic", 1, 3))
    assert [cell.angle for cell in found.cells] == list(PUBLISHED[3])
    assert found.outside == 0
    assert np.mean([cell.rmsd_deg for cell in found.cells]) < 7.0


def test_every_method_of_the_issue_is_there() -> None:
    assert set(MUST_SHOW) <= set(CONTENDERS)


def test_an_unknown_section_is_told() -> None:
    with pytest.raises(ValueError, match="table"):
        board.run(None, "tables")


def test_a_report_holds_tables_and_charts(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    def section(advance) -> object:
        advance()
        trials = [result(task, 2.0) for task in PUBLISHED]
        tables = [methods_table("clinic", {BEST: trials})]
        return table_section.Section("t", [table_section.LEGEND], our_gates("clinic", trials), tables, {"a": "<svg/>"})

    monkeypatch.setitem(board.SECTIONS, "table", board.Part(section, 1))
    found = board.run(tmp_path / "rows.json", "table", report=tmp_path / "report")
    assert isinstance(found, Scoreboard)
    assert [grid.caption for grid in found.grids] == ["clinic: methods, RMSD / zero-mean RMSD in deg, correlation"]
    assert "| ours |" in (tmp_path / "report" / "report.md").read_text()
    assert (tmp_path / "report" / "a.svg").exists()
    assert (tmp_path / "rows.json").exists()
    found.print()
