"""What a walk for time amounts to, out of its phases."""

import json

import pytest

from schemas.conditions import UNSAID
from schemas.tasks import TaskPhase
from schemas.vocabulary import Segment, Task, TaskPhaseKind
from services.ingest.source import open_source
from services.metrics.parameters import MetricsParameters
from services.metrics.six_minute_walk import SixMinuteTotals

WALK, TURN, REST = TaskPhaseKind.WALK, TaskPhaseKind.TURN, TaskPhaseKind.REST
LEGS = open_source("synthetic:walk").describe()
PELVIS = open_source("synthetic:walk?worn=3").describe()


def described(base=LEGS, corridor: float | None = 20.0, duration: float = 120.0):
    conditions = UNSAID.model_copy(update={"test_duration_s": duration})
    return base.model_copy(update={"task": Task.SIX_MINUTE_WALK, "walkway_m": corridor, "conditions": conditions})


def walk_of(lengths: int, *, speed: float = 1.0, slower: float = 0.0, scale: float = 1.0, rest_s: float = 0.0,
            measured: bool = True, until_s: float = 120.0) -> list[TaskPhase]:  # fmt: skip
    """Lengths of 20 m with turns of 2 s that cover nothing, a rest after the second turn, and the rest of the time."""
    found, now = [], 10.0
    parts: list[tuple[TaskPhaseKind, float, float]] = []
    for k in range(lengths):
        parts += [(WALK, 20.0 / (speed - slower * k), 20.0), (TURN, 2.0, 0.0)]
        if k == 1 and rest_s:
            parts.append((REST, rest_s, 0.0))
    walked_s = sum(lasts for _, lasts, _ in parts)
    parts.append((WALK, until_s - walked_s, (until_s - walked_s) * (speed - slower * lengths)))
    for kind, lasts, walked in parts:
        found.append(TaskPhase(
            task=Task.SIX_MINUTE_WALK, attempt=0, phase=kind, start_ns=round(now * 1e9), start_std_s=0.1,
            end_ns=round((now + lasts) * 1e9), end_std_s=0.1, steps=10,
            distance_m=walked / scale if measured else None, distance_std_m=0.04 * walked if measured else None,
        ))  # fmt: skip
        now += lasts
    return found


def metrics_of(phases: list[TaskPhase], description=None, *, final: bool = True) -> dict:
    totals = SixMinuteTotals(described() if description is None else description, MetricsParameters())
    for phase in phases:
        totals.add(phase.model_copy(update={"end_ns": None, "end_std_s": None}))
        assert totals.add(phase)
    return {metric.name.removeprefix("six_minute_walk_"): metric for metric in totals.metrics(final=final)}


def test_the_corridor_scales_the_steps() -> None:
    # Steps that are 8 % short: 4 lengths of 20 m, and 32 s at 1 m/s.
    found = metrics_of(walk_of(4, scale=1.08))
    assert found["distance_by_laps"].value == pytest.approx(112.0)
    assert found["distance_by_strides"].value == pytest.approx(112.0 / 1.08)
    assert found["distance"].value == pytest.approx(112.0, abs=0.5)
    assert found["distance"].low < 112.0 < found["distance"].high
    assert (found["turns"].value, found["laps"].value, found["turn_time"].value) == (4.0, 2.0, 2.0)


def test_a_corridor_that_contradicts_the_steps_is_not_believed() -> None:
    found = metrics_of(walk_of(4), described(corridor=30.0))
    assert found["distance_by_laps"].value is None
    assert "20.0 m of what was said to be 30.0 m" in found["distance_by_laps"].withheld_because
    assert found["distance"].value == found["distance_by_strides"].value == pytest.approx(112.0)


def test_a_missed_turn_is_noticed_by_its_length() -> None:
    phases = walk_of(9, until_s=210.0)
    phases[5] = phases[5].model_copy(update={"phase": WALK})
    found = metrics_of(phases, described(duration=210.0))
    assert "differs by 100 %" in found["distance_by_laps"].withheld_because
    assert found["distance"].value == found["distance_by_strides"].value == pytest.approx(192.0)
    alone = [each.model_copy(update={"distance_m": None, "distance_std_m": None}) for each in phases]
    assert metrics_of(alone, described(PELVIS, duration=210.0))["distance"].value is None


def test_without_a_corridor_the_steps_are_all_there_is() -> None:
    found = metrics_of(walk_of(4), described(corridor=None))
    assert found["distance"].value == pytest.approx(112.0)
    assert found["distance_by_laps"].withheld_because == "the length of the corridor is not known"


def test_a_lone_pelvis_counts_laps_and_the_time_of_the_last() -> None:
    found = metrics_of(walk_of(4, measured=False), described(PELVIS))
    assert found["distance"].value == pytest.approx(80.0 + 20.0, abs=1.0)
    assert "sensors on pelvis, both thighs" in found["distance_by_strides"].withheld_because
    assert found["speed_first_minute"].value is None


def test_speed_of_each_minute_and_slope() -> None:
    found = metrics_of(walk_of(4, speed=1.2, slower=0.05))
    first, second = found["speed_first_minute"], found["speed_second_minute"]
    assert first.value > second.value > 0.8
    assert "speed_third_minute" not in found
    slope = found["speed_slope"]
    assert slope.value == pytest.approx(-0.05 / (20.9 / 60), rel=0.1)
    assert slope.low < slope.value < slope.high < 0
    assert metrics_of(walk_of(3))["speed_slope"].withheld_because == "2 of at least 3 lengths walked from turn to turn"


def test_rests_count_and_the_clock_runs_on() -> None:
    found = metrics_of(walk_of(3, rest_s=30.0))
    assert (found["rests"].value, found["rest_time"].value) == (1.0, 30.0)
    assert found["time"].value == pytest.approx(120.0)
    assert found["speed"].value == pytest.approx(found["distance"].value / 120.0)


def test_a_session_that_ends_early_has_no_distance_but_had_one_so_far() -> None:
    phases = walk_of(4)[:-1]
    assert metrics_of(phases, final=False)["distance"].value == pytest.approx(80.0, abs=0.5)
    assert metrics_of(phases)["distance"].withheld_because == "seen for 88 s of 120 s"


def test_nobody_walked() -> None:
    found = metrics_of([])
    assert all(metric.value is None for name, metric in found.items())


def test_split_and_resume() -> None:
    phases = walk_of(4)
    whole, half = (SixMinuteTotals(described(), MetricsParameters()) for _ in range(2))
    for phase in phases:
        whole.add(phase)
    for phase in phases[:5]:
        half.add(phase)
    resumed = SixMinuteTotals(described(), MetricsParameters())
    resumed.restore(json.loads(json.dumps(half.snapshot())))
    for phase in phases[5:]:
        resumed.add(phase)
    assert resumed.metrics(final=True) == whole.metrics(final=True)
    assert resumed.phases == whole.phases


def test_legs_wear_what_step_lengths_need() -> None:
    assert {Segment.PELVIS, Segment.SHANK_LEFT} <= {sensor.segment for hub in LEGS.hubs for sensor in hub.sensors}
