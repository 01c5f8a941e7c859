"""What each metric of a timed up and go is: rows of the same table, measured on attempts instead of strides."""

from collections.abc import Callable, Mapping

from schemas.tasks import TaskPhase
from schemas.vocabulary import TaskPhaseKind
from services.definitions.definition import Definition

Attempt = Mapping[TaskPhaseKind, TaskPhase]
"""The ended phases of one attempt."""

Measured = tuple[float, float | None]
"""A value of one attempt with its deviation; None where it is not known."""

_RISE, _TURN, _SIT = TaskPhaseKind.SIT_TO_STAND, TaskPhaseKind.TURN, TaskPhaseKind.TURN_TO_SIT


def _between(first: TaskPhaseKind, last: TaskPhaseKind) -> Callable[[Attempt], Measured | None]:
    def measure(attempt: Attempt) -> Measured | None:
        begun, over = attempt[first], attempt[last]
        if over.end_ns is None or over.end_std_s is None:
            return None
        return (over.end_ns - begun.start_ns) / 1e9, (begun.start_std_s**2 + over.end_std_s**2) ** 0.5

    return measure


def _largest(phase: TaskPhaseKind, field: str) -> Callable[[Attempt], Measured | None]:
    def measure(attempt: Attempt) -> Measured | None:
        value = getattr(attempt[phase], field)
        return None if value is None else (value, None)

    return measure


def _steps(attempt: Attempt) -> Measured | None:
    counted = [phase.steps for kind, phase in attempt.items() if kind is not _RISE]
    known = [steps for steps in counted if steps is not None]
    return (float(sum(known)), None) if len(known) == len(counted) else None


def _time_of(kind: TaskPhaseKind, sentence: str) -> tuple[Definition, Callable[[Attempt], Measured | None]]:
    return Definition(f"tug_{kind}_time", "s", False, sentence), _between(kind, kind)


TUG_TIME = "tug_time"

TUG_MEANS: tuple[tuple[Definition, Callable[[Attempt], Measured | None]], ...] = (
    (
        Definition(
            TUG_TIME,
            "s",
            False,
            "Timed up and go: time from the first motion of rising until the person sits again. A stopwatch that is "
            "started at the word go shows the time to react as well.",
        ),
        _between(_RISE, _SIT),
    ),
    _time_of(_RISE, "Time from the first motion of rising until upright."),
    _time_of(TaskPhaseKind.WALK_OUT, "Time from upright to the begin of the turn at the marker."),
    _time_of(_TURN, "Time of the turn at the marker."),
    _time_of(TaskPhaseKind.WALK_BACK, "Time from the end of the turn at the marker to the begin of the turn to sit."),
    _time_of(_SIT, "Time from the begin of the turn before the chair until the person sits."),
    (
        Definition("tug_turn_rate", "rad/s", False, "Largest rate of turning in the turn at the marker, over 0.4 s."),
        _largest(_TURN, "largest_turn_rate"),
    ),
    (
        Definition(
            "tug_turn_to_sit_rate", "rad/s", False, "Largest rate of turning in the turn before the chair, over 0.4 s."
        ),
        _largest(_SIT, "largest_turn_rate"),
    ),
    (
        Definition("tug_rise_rate", "rad/s", False, "Largest rate at which the thighs turn upright in rising."),
        _largest(_RISE, "largest_thigh_rate"),
    ),
    (Definition("tug_steps", "1", False, "Number of steps of both legs from upright until the person sits."), _steps),
)
"""Metrics that every completed attempt has: the mean over the attempts is shown."""

TUG_COMPLETED = Definition("tug_attempts", "1", False, "Number of attempts of the timed up and go that were completed.")
TUG_ABORTED = Definition(
    "tug_attempts_aborted", "1", False, "Number of attempts that were given up or not seen to their end."
)

TUG: tuple[Definition, ...] = (*(definition for definition, _ in TUG_MEANS), TUG_COMPLETED, TUG_ABORTED)
"""All metrics of a timed up and go, in the order of every message of a session whose task it is."""
