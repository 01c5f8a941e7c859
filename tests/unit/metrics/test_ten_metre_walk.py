"""What the trials of a ten-metre walk amount to."""

import json
import math

import pytest

from schemas.tasks import TaskPhase
from schemas.vocabulary import TASK_PHASES, Task, TaskPhaseKind
from services.ingest.source import open_source
from services.metrics.parameters import MetricsParameters
from services.metrics.ten_metre_walk import TenMetreTotals

UP, ZONE, OUT = TASK_PHASES[Task.TEN_METRE_WALK]
DESCRIBED = open_source("synthetic:ten_metres").describe()
FEET = open_source("synthetic:walk?worn=3").describe().model_copy(update={"task": Task.TEN_METRE_WALK})


def phase(kind: TaskPhaseKind, attempt: int, start_s: float, end_s: float | None, *, given_up: bool = False,
          distance_m: float = 6.0, change: float | None = 0.02) -> TaskPhase:  # fmt: skip
    return TaskPhase(
        task=Task.TEN_METRE_WALK, attempt=attempt, phase=kind, start_ns=round(start_s * 1e9), start_std_s=0.06,
        end_ns=None if end_s is None else round(end_s * 1e9),
        end_std_s=None if end_s is None or given_up else 0.08, steps=9, distance_m=distance_m, distance_std_m=0.0,
        speed_change=change,
    )  # fmt: skip


def totals_of(*phases: TaskPhase, description=DESCRIBED) -> TenMetreTotals:
    totals = TenMetreTotals(description, MetricsParameters())
    for each in phases:
        totals.add(each)
    return totals


def metrics_of(totals: TenMetreTotals, *, final: bool = True) -> dict:
    return {metric.name.removeprefix("ten_metre_walk_"): metric for metric in totals.metrics(final=final)}


def test_speed_is_zone_over_time_and_the_trials_are_averaged() -> None:
    found = metrics_of(
        totals_of(*(phase(ZONE, k, 20.0 * k, 20.0 * k + 6.0 / v) for k, v in enumerate((1.0, 1.1, 1.2))))
    )
    speed = found["speed"]
    assert (speed.value, speed.spread, speed.strides) == (pytest.approx(1.1), pytest.approx(0.1), 3)
    assert speed.low < 1.1 < speed.high
    # What the lines err by is common to all trials: it does not average out.
    assert speed.mean_std > math.hypot(0.1 / math.sqrt(3), 0.1 / 6.0)
    assert found["time"].value == pytest.approx((6.0 + 6.0 / 1.1 + 5.0) / 3)
    assert (found["strides"].value, found["trials"].value, found["trials_aborted"].value) == (4.5, 3.0, 0.0)


def test_one_trial_has_the_deviation_of_its_lines() -> None:
    speed = metrics_of(totals_of(phase(ZONE, 0, 10.0, 16.0)))["speed"]
    assert speed.spread is None
    assert speed.mean_std == pytest.approx(1.0 / 6.0 * 0.1)


def test_what_is_told_again_replaces_what_was_told() -> None:
    totals = totals_of(phase(ZONE, 0, 10.0, 16.0), phase(OUT, 0, 16.0, 18.0), phase(ZONE, 0, 10.1, 15.6))
    assert metrics_of(totals)["time"].value == pytest.approx(5.5)
    assert [each.phase for each in totals.phases] == [ZONE, OUT]


def test_a_trial_that_was_given_up_is_told_and_in_no_mean() -> None:
    totals = totals_of(phase(ZONE, 0, 10.0, 16.0), phase(UP, 1, 30.0, 32.0), phase(ZONE, 1, 32.0, 34.0, given_up=True))
    found = metrics_of(totals)
    assert (found["trials"].value, found["trials_aborted"].value, found["speed"].strides) == (1.0, 1.0, 1)


def test_a_trial_that_goes_on_is_not_given_up_until_the_session_ends() -> None:
    totals = totals_of(phase(ZONE, 0, 10.0, 16.0), phase(UP, 1, 30.0, None))
    assert metrics_of(totals, final=False)["trials_aborted"].value == 0.0
    assert metrics_of(totals)["trials_aborted"].value == 1.0


def test_steady_is_within_a_tenth() -> None:
    changes = (0.05, -0.05, 0.2, -0.3)
    found = metrics_of(totals_of(*(phase(ZONE, k, 20.0 * k, 20.0 * k + 6.0, change=c) for k, c in enumerate(changes))))
    assert found["steady_trials"].value == 2.0
    unknown = metrics_of(totals_of(phase(ZONE, 0, 10.0, 16.0, change=None)))["steady_trials"]
    assert (unknown.value, unknown.withheld_because) == (None, "not observed in any completed trial")


def test_without_step_lengths_it_says_what_would_be_needed() -> None:
    found = metrics_of(totals_of(description=FEET))
    assert "sensors on pelvis, both thighs and both shanks" in found["speed"].withheld_because
    assert metrics_of(totals_of())["speed"].withheld_because == "no completed trial"


def test_split_and_resume() -> None:
    phases = [
        phase(kind, k, 20.0 * k + i, 20.0 * k + i + 1) for k in range(3) for i, kind in enumerate((UP, ZONE, OUT))
    ]
    resumed = TenMetreTotals(DESCRIBED, MetricsParameters())
    resumed.restore(json.loads(json.dumps(totals_of(*phases[:4]).snapshot())))
    for each in phases[4:]:
        resumed.add(each)
    assert resumed.metrics(final=True) == totals_of(*phases).metrics(final=True)
