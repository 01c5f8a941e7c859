"""Like with like: in what two trials differ, so that a change could be that instead of the patient's."""

from schemas.conditions import Conditions
from schemas.vocabulary import Task
from services.progress.rules import Rule, RuleCode, rule
from services.progress.visits import Trial

SAID_BY_TASK: dict[Task, tuple[str, ...]] = {
    Task.WALK: ("aid", "orthosis", "footwear", "speed_instruction"),
    Task.TEN_METRE_WALK: ("aid", "orthosis", "footwear", "speed_instruction", "start"),
    Task.SIX_MINUTE_WALK: ("aid", "orthosis", "footwear"),
    Task.TIMED_UP_AND_GO: ("aid", "orthosis", "footwear"),
    Task.MARCHING: ("aid", "orthosis", "footwear"),
}
"""Conditions that must have been said on both sides: what nobody said cannot be shown to be the same. Movements that
are no walking need only the orthosis."""

_OTHERWISE = ("orthosis",)
_NEEDS_WALKWAY = (Task.TIMED_UP_AND_GO, Task.SIX_MINUTE_WALK)
ALIKE_LENGTHS = 0.1
"""Relative: a tape finds a leg's length again within this; a larger difference is another body's (proposal)."""
_NOT_HOW = ("paretic_side",)
"""Whose side is the paretic one is no way of doing a test."""


def unsaid(trial: Trial) -> list[Rule]:
    """What had to be said of how the trial was done, and was not."""
    needed = SAID_BY_TASK.get(trial.task, _OTHERWISE)
    missing = [name for name in needed if getattr(trial.conditions, name) is None]
    if trial.task in _NEEDS_WALKWAY and trial.walkway_m is None:
        missing.append("walkway_m")
    return [rule(RuleCode.UNSAID, name) for name in missing]


def differences(now: Trial, baseline: Trial, unit: str) -> list[Rule]:
    """In what a trial differs from that of the baseline, for a measure in this unit (rule 6.3.6).

    What measured and what computed count as well: estimator, sensors and their places, software; of angles the datum.
    """
    pairs = [(name, getattr(now.conditions, name), getattr(baseline.conditions, name)) for name in _HOW]
    pairs += [
        (name, getattr(now, name), getattr(baseline, name))
        for name in ("walkway_m", "walk_path", "estimator", "lengths_from")
    ]
    pairs.append(("sensors", " ".join(now.sensors), " ".join(baseline.sensors)))
    pairs.append(("software", _software(now), _software(baseline)))
    if _lengths_differ(now, baseline):
        pairs.append(("leg_length_m", now.leg_length_m, baseline.leg_length_m))
    if unit == "rad":
        pairs.append(("datum", now.datum, baseline.datum))
    return [rule(RuleCode.DIFFERENCE, name, mine, theirs) for name, mine, theirs in pairs if mine != theirs]


_WITH = ("walkway_m", "walk_path", "estimator", "lengths_from")
_HOW = tuple(name for name in Conditions.model_fields if name not in _NOT_HOW)


def _lengths_differ(now: Trial, baseline: Trial) -> bool:
    if now.leg_length_m is None or baseline.leg_length_m is None:
        return now.leg_length_m is not baseline.leg_length_m
    return abs(now.leg_length_m - baseline.leg_length_m) > ALIKE_LENGTHS * baseline.leg_length_m


def _software(trial: Trial) -> str | None:
    return None if trial.metrics is None else trial.metrics.software
