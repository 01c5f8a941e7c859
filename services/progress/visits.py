"""The sessions of a patient in order, as visits."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import date, datetime, timedelta

from schemas.conditions import Conditions
from schemas.metrics import Metric, SessionMetrics, SideComparison
from schemas.session import WalkPath
from schemas.vocabulary import Task

SAME_VISIT = timedelta(hours=12)
"""Sessions that began less than this after the first one of a visit are trials of the same visit."""


@dataclass(frozen=True, slots=True)
class Trial:
    """One session as progress needs it. `metrics` are null until they are final."""

    session: str
    began: datetime
    task: Task
    conditions: Conditions
    walkway_m: float | None
    walk_path: WalkPath | None
    estimator: str
    sensors: tuple[str, ...]
    """What measured: segment and side of the segment of every sensor, kind of every camera; in order."""
    leg_length_m: float | None
    """Thigh and shank as they were declared; lengths walked are in proportion to it."""
    lengths_from: str | None
    """Measured, from stature, or of nobody in particular."""
    datum: str | None
    """What an angle of zero means; null where nothing was calibrated."""
    metrics: SessionMetrics | None

    def metric(self, name: str, side: str | None) -> Metric | None:
        """One number of the session; null where it does not know such a one."""
        if self.metrics is None:
            return None
        return next((each for each in self.metrics.metrics if (each.name, each.side) == (name, side)), None)

    def comparison(self, joint: str) -> SideComparison | None:
        """One joint of one leg against the other's."""
        return None if self.metrics is None else next((e for e in self.metrics.sides if e.joint == joint), None)


@dataclass(frozen=True, slots=True)
class Visit:
    """What a patient did at one coming."""

    number: int
    """1 for the first."""
    trials: tuple[Trial, ...]
    """In the order in which they began; at least one."""

    @property
    def began(self) -> datetime:
        """When the first trial began, UTC."""
        return self.trials[0].began

    @property
    def day(self) -> date:
        """Date of the first trial, UTC."""
        return self.began.date()

    def of(self, task: Task) -> tuple[Trial, ...]:
        """The trials of one task."""
        return tuple(trial for trial in self.trials if trial.task is task)


def visit_lengths(began: Sequence[datetime]) -> list[int]:
    """How many of the sessions that began at these times, in order, belong to the first visit, the second, and so on.

    A visit takes what began less than `SAME_VISIT` after its own first session, so that it cannot grow without end.
    """
    lengths: list[int] = []
    first: datetime | None = None
    for at in began:
        if first is None or at - first >= SAME_VISIT:
            first = at
            lengths.append(0)
        lengths[-1] += 1
    return lengths


def in_visits(trials: Iterable[Trial]) -> list[Visit]:
    """All trials of a patient, in any order, as visits in order."""
    ordered = sorted(trials, key=lambda trial: (trial.began, trial.session))
    visits, start = [], 0
    for number, length in enumerate(visit_lengths([trial.began for trial in ordered]), start=1):
        visits.append(Visit(number, tuple(ordered[start : start + length])))
        start += length
    return visits


def numbers_of_sessions(visits: Iterable[Visit]) -> dict[str, int]:
    """Session -> number of its visit."""
    return {trial.session: visit.number for visit in visits for trial in visit.trials}
