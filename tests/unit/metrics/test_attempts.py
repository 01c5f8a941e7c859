"""Attempts of a timed up and go, made by hand."""

import json

import pytest

from schemas.tasks import TaskPhase
from schemas.vocabulary import TASK_PHASES, Task, TaskPhaseKind
from services.metrics.attempts import AttemptTotals
from services.metrics.parameters import MetricsParameters

PARAMETERS = MetricsParameters()


def phases(attempt: int = 0, lasts: float = 2.0, first_s: float = 0.0, **changes) -> list[TaskPhase]:
    """Begin and end of all five phases, each as long."""
    found = []
    for number, kind in enumerate(TASK_PHASES[Task.TIMED_UP_AND_GO]):
        start_s = first_s + number * lasts
        fields = {
            "task": Task.TIMED_UP_AND_GO,
            "attempt": attempt,
            "phase": kind,
            "start_ns": round(start_s * 1e9),
            "start_std_s": 0.03,
            "largest_turn_rate": 2.0 + attempt if "turn" in kind else None,
            "largest_thigh_rate": 1.5 if kind is TaskPhaseKind.SIT_TO_STAND else None,
            "steps": 3,
            **changes,
        }
        found.append(TaskPhase(**fields, end_ns=None, end_std_s=None))
        found.append(TaskPhase(**fields, end_ns=round((start_s + lasts) * 1e9), end_std_s=0.04))
    return found


def totals(*attempts: list[TaskPhase]) -> AttemptTotals:
    made = AttemptTotals(PARAMETERS)
    for attempt in attempts:
        for phase in attempt:
            made.add(phase)
    return made


def by_name(made: AttemptTotals, *, final: bool = True) -> dict:
    return {metric.name: metric for metric in made.metrics(final=final)}


def test_one_attempt_has_a_time_with_the_error_of_its_boundaries() -> None:
    found = by_name(totals(phases()))
    assert found["tug_time"].value == pytest.approx(10.0)
    assert found["tug_time"].mean_std == pytest.approx(0.05)
    assert found["tug_time"].spread is None
    assert found["tug_turn_time"].value == pytest.approx(2.0)
    assert found["tug_turn_rate"].value == pytest.approx(2.0)
    assert found["tug_rise_rate"].value == pytest.approx(1.5)
    assert found["tug_rise_rate"].mean_std is None
    assert found["tug_steps"].value == 12.0
    assert found["tug_attempts"].value == 1.0


def test_the_mean_of_attempts_has_a_spread_and_both_errors() -> None:
    found = by_name(totals(phases(0, 2.0), phases(1, 2.4, 60.0)))
    assert found["tug_time"].value == pytest.approx(11.0)
    assert found["tug_time"].spread == pytest.approx(2**0.5)
    assert found["tug_time"].mean_std == pytest.approx(((2.0 + 0.05**2) / 2) ** 0.5)
    assert found["tug_time"].strides == 2


def test_an_attempt_that_was_given_up_is_counted_and_in_no_mean() -> None:
    given_up = phases(0)[:3]
    given_up.append(given_up[-1].model_copy(update={"end_ns": 5_000_000_000}))
    found = by_name(totals(given_up, phases(1, 2.0, 60.0)))
    assert (found["tug_attempts"].value, found["tug_attempts_aborted"].value) == (1.0, 1.0)
    assert found["tug_time"].value == pytest.approx(10.0)


def test_an_attempt_that_goes_on_is_not_yet_given_up() -> None:
    made = totals(phases()[:5])
    assert by_name(made, final=False)["tug_attempts_aborted"].value == 0.0
    assert by_name(made, final=True)["tug_attempts_aborted"].value == 1.0


def test_without_an_attempt_times_are_withheld_with_a_reason() -> None:
    found = by_name(AttemptTotals(PARAMETERS))
    assert found["tug_time"].value is None
    assert found["tug_time"].withheld_because == "no completed attempt"
    assert found["tug_attempts"].value == 0.0


def test_what_no_sensor_saw_is_withheld() -> None:
    found = by_name(totals(phases(largest_thigh_rate=None, steps=None)))
    assert found["tug_rise_rate"].withheld_because == "not observed in any completed attempt"
    assert found["tug_steps"].value is None
    assert found["tug_time"].value is not None


def test_each_phase_is_listed_once_as_it_was_last_told() -> None:
    made = totals(phases(0), phases(1, 2.0, 60.0)[:3])
    assert len(made.phases) == 7
    assert [phase.end_ns is None for phase in made.phases] == [False] * 6 + [True]


def test_the_list_of_phases_is_bounded() -> None:
    made = totals(*(phases(attempt, 2.0, 20.0 * attempt) for attempt in range(120)))
    assert len(made.phases) == PARAMETERS.most_phases
    assert by_name(made)["tug_attempts"].value == 120.0


@pytest.mark.parametrize("at", [1, 4, 9, 12])
def test_split_and_resume_is_bit_identical(at: int) -> None:
    every = [*phases(0), *phases(1, 2.3, 60.0)]
    whole = totals(every)
    first = totals(every[:at])
    resumed = AttemptTotals(PARAMETERS)
    resumed.restore(json.loads(json.dumps(first.snapshot())))
    for phase in every[at:]:
        resumed.add(phase)
    assert resumed.metrics(final=True) == whole.metrics(final=True)
    assert resumed.snapshot() == whole.snapshot()
