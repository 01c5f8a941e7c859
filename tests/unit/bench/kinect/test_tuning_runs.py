"""Tuning over processes."""

import ast
import io

import numpy as np
import pytest
from rich.console import Console

from services.bench.kinect import tuning_board, tuning_runs
from services.bench.kinect.trials import Case, recording_of, residuals_of
from services.bench.kinect.tuning_board import Order
from services.bench.kinect.tuning_runs import Tuned, cells_for, table_text, tune
from services.bench.kinect.workers import workers
from services.biomech.whole_body.constrained_ekf import OURS
from services.biomech.whole_body.presets import CORRECTED
from services.biomech.whole_body.task_presets import values_of, with_values
from services.biomech.whole_body.tuning import Search, residuals

CASE = Case(0, 2, "clinic", "published")


def test_the_same_work_gives_or_fails_the_same_in_other_processes() -> None:
    work = [(CASE, CORRECTED), (CASE, with_values(CORRECTED, (1e-3, 0.1, *np.full(11, 10.0))))]
    with workers(2) as spread:
        there = list(spread(residuals_of, work))
        with pytest.raises(ValueError, match="math domain"):
            list(spread(_fail, [1.0, 2.0]))
    with workers(1) as spread:
        here = list(spread(residuals_of, work))
    assert all((a == b).all() for a, b in zip(there, here, strict=True))
    assert (there[0] != there[1]).any()


def test_no_process_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one"), workers(0):
        pass


def _fail(_: float) -> float:
    raise ValueError("math domain")


def test_eq_8_lowers_the_error_of_the_person_it_is_tuned_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tuning_runs, "SEARCH", Search(1e-1, 1e5, 2))
    monkeypatch.setattr(tuning_runs, "recording_of", _short)
    monkeypatch.setattr(tuning_runs, "residuals_of", _residuals_of_short)
    steps: list[int] = []
    found = tune("published", 2, 0, "clinic", map, lambda: steps.append(1))
    assert found.cost_at_optimum < found.cost_at_start
    assert found.optimum.camera == CORRECTED.camera
    assert steps


def _short(case: Case):
    whole = recording_of(case)
    return whole._replace(centres=whole.centres[:150], state=whole.state[:150], angles=whole.angles[:150])


def _residuals_of_short(work) -> np.ndarray:
    case, settings = work
    return residuals([_short(case)], settings, [3, 6, 7, 10])


def test_values_go_into_settings_and_come_back() -> None:
    values = (2e-3, 0.05, *range(1, 12))
    assert values_of(with_values(OURS, values)) == values
    assert with_values(OURS, values).priors == OURS.priors


def test_the_table_that_is_written_is_what_was_found() -> None:
    values = (2e-3, 0.05, *(float(k) for k in range(1, 12)))
    text = table_text("person 0", {"ours": {1: values, 3: values}})
    names = {node.target.id if isinstance(node, ast.AnnAssign) else node.targets[0].id: ast.literal_eval(node.value)
             for node in ast.parse(text).body if isinstance(node, ast.Assign | ast.AnnAssign)}  # fmt: skip
    assert names == {"TUNED_ON": "person 0", "TABLES": {"ours": {1: values, 3: values}}}
    assert all(len(line) <= 120 for line in text.splitlines())


def test_who_is_scored_does_not_tune() -> None:
    with pytest.raises(ValueError, match="scored"):
        tuning_board.run(Order(person=3), Console(file=io.StringIO()))


def test_cells_are_those_of_people_and_settings_of_the_task() -> None:
    asked: list[int] = []
    found = cells_for(lambda task: asked.append(task) or OURS, "ours", "clinic", [1], [2], map)
    assert asked == [2]
    assert {cell.task for cell in found} == {2}


def test_it_prints_where_values_began_and_ended_and_writes_only_what_was_tuned(tmp_path, monkeypatch) -> None:
    other = with_values(OURS, (2e-3, 0.05, *np.full(11, 7.0)))
    monkeypatch.setattr(tuning_board, "tune", lambda way, task, *_: Tuned(way, task, OURS, other, "deg RMS", 4.0, 3.0))
    console, file = Console(file=io.StringIO(), width=200), tmp_path / "tables.py"
    tuning_board.run(Order(["ours"], [2], processes=1), console, file)
    said = console.file.getvalue()
    assert "4.00 -> 3.00" in said
    assert f"{OURS.camera.variance:.3g} -> 0.002" in said
    assert "as it began" in said
    assert "2: (0.002, 0.05, 7" in file.read_text()
    assert "person 0" in file.read_text()
