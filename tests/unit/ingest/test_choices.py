"""What the operator chose reaches the description of every kind of source; what she left open stays the source's."""

import json
from pathlib import Path

import pytest

from schemas.vocabulary import Task
from services.ingest.choices import Choices
from services.ingest.errors import InvalidOption
from services.ingest.orders import InvalidOrder, StartOrder, parse_order
from services.ingest.source import open_chosen, open_source
from services.ingest.synthetic import write_recording

WALK = "synthetic:walk?duration=5"


def test_the_task_and_its_walkway_reach_a_synthetic_session() -> None:
    chosen = open_source(WALK, task=Task.TIMED_UP_AND_GO, walkway_m=3.0).describe()
    assert (chosen.task, chosen.walkway_m) == (Task.TIMED_UP_AND_GO, 3.0)
    left = open_source(WALK).describe()
    assert (left.task, left.walkway_m) == (Task.WALK, None)


def test_a_recording_keeps_its_own_task_unless_another_was_chosen(tmp_path: Path) -> None:
    write_recording(tmp_path, "duration=5")
    manifest = tmp_path / "recording.toml"
    manifest.write_text(manifest.read_text().replace('task = "walk"', 'task = "timed_up_and_go"\nwalkway_m = 7.0'))
    kept = open_source(str(tmp_path)).describe()
    assert (kept.task, kept.walkway_m) == (Task.TIMED_UP_AND_GO, 7.0)
    changed = open_chosen(str(tmp_path), Choices(task=Task.WALK, walkway_m=3.0)).describe()
    assert (changed.task, changed.walkway_m) == (Task.WALK, 3.0)


def test_an_order_carries_the_choices() -> None:
    order = {"source": WALK, "speed": None, "task": "knee_flexion", "walkway_m": 4.5, "estimator": "ekf"}
    choices = parse_order(StartOrder, json.dumps(order).encode()).choices
    assert choices == Choices(estimator="ekf", task=Task.KNEE_FLEXION, walkway_m=4.5)
    assert parse_order(StartOrder, json.dumps({"source": WALK, "speed": 1}).encode()).choices == Choices()


def test_an_unknown_task_is_refused_by_name() -> None:
    with pytest.raises(InvalidOrder, match="task"):
        parse_order(StartOrder, json.dumps({"source": WALK, "speed": 1, "task": "dancing"}).encode())


@pytest.mark.parametrize("walkway_m", [0.0, -3.0, 101.0, float("nan")])
def test_an_impossible_walkway_is_refused(walkway_m: float) -> None:
    with pytest.raises(InvalidOption, match="walkway"):
        Choices(walkway_m=walkway_m)
