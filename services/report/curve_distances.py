"""How far a visit's sagittal curves are from those of the baseline visit.

Clinical conventions, section 4: a trend within one person, of four variables, never called a score of gait.
"""

import math
from collections.abc import Mapping, Sequence

from schemas.metrics import SessionMetrics
from schemas.vocabulary import Side
from services.progress.likeness import differences, unsaid
from services.progress.visits import Trial, Visit
from services.reference.curve_distance import VARIABLES, curve_distance
from services.report.source import CurveDistance

UNIT = "rad"


def curve_distances(visits: Sequence[Visit], like: Trial, baseline: int | None) -> tuple[CurveDistance, ...]:
    """One for each visit after the baseline with a trial done as `like` was, in order; the last such trial counts.

    Empty where the baseline has no such trial, or shares no curve with it.
    """
    first = None if baseline is None else _trial(visits, baseline, like)
    if first is None or first.metrics is None or baseline is None:
        return ()
    found = []
    for visit in visits:
        trial = _trial(visits, visit.number, like)
        if visit.number <= baseline or trial is None or trial.metrics is None:
            continue
        told = _distance(visit, first.metrics, trial.metrics)
        if told is not None:
            found.append(told)
    return tuple(found)


def _trial(visits: Sequence[Visit], number: int, like: Trial) -> Trial | None:
    trials = [trial for visit in visits if visit.number == number for trial in visit.of(like.task)]
    alike = [trial for trial in trials if trial.metrics is not None and _is_like(trial, like)]
    return alike[-1] if alike else None


def _is_like(trial: Trial, like: Trial) -> bool:
    return not unsaid(trial) and not differences(trial, like, UNIT)


def _distance(visit: Visit, one: SessionMetrics, other: SessionMetrics) -> CurveDistance | None:
    """Both legs count alike: the mean of their squared distances, variable by variable and of all four."""
    legs = [curve_distance(_leg(one, side), _leg(other, side)) for side in Side]
    legs = [leg for leg in legs if leg.by_variable]
    if not legs:
        return None
    by_variable = {}
    for name in VARIABLES:
        values = [leg.by_variable[name] for leg in legs if name in leg.by_variable]
        if values:
            by_variable[name] = _root_mean_square(values)
    whole = [leg.distance for leg in legs if leg.distance is not None]
    distance = _root_mean_square(whole) if len(whole) == len(legs) else None
    return CurveDistance(visit.number, visit.day, distance, by_variable)


def _leg(metrics: SessionMetrics, side: Side) -> Mapping[str, Sequence[float]]:
    """The curves of one leg, and those of the pelvis, by variable without side."""
    suffix = f"_{side}"
    own = {
        each.degree_of_freedom.removesuffix(suffix): each.mean
        for each in metrics.curves
        if each.degree_of_freedom.endswith(suffix)
    }
    pelvis = {each.degree_of_freedom: each.mean for each in metrics.curves if each.degree_of_freedom in VARIABLES}
    return {**own, **pelvis} if own else {}


def _root_mean_square(values: Sequence[float]) -> float:
    return math.sqrt(sum(value**2 for value in values) / len(values))
