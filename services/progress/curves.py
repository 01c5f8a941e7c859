"""Sagittal curve distance (4 variables) over the visits: of a leg from its own baseline and from the other leg."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date

from schemas.conditions import SpeedInstruction
from schemas.metrics import MeanCurve
from schemas.vocabulary import Side, Task
from services.progress.visits import Trial, Visit
from services.reference.curve_distance import VARIABLES, CurveDistance, curve_distance

ONE_FOR_BOTH = ("pelvis_tilt",)
"""What is no leg's own."""

Curves = dict[str, list[float]]
"""Degree of freedom without side -> rad at 0, 1, ... 100 % of that leg's stride."""

LikeTrials = Sequence[tuple[Visit, Sequence[Trial]]]
"""Each visit from the baseline on with its trials that are like the baseline's."""


@dataclass(frozen=True, slots=True)
class CurveVisit:
    """One leg at one visit. A trend within the patient, never called GPS; no verdict rests on it."""

    task: Task
    instruction: SpeedInstruction | None
    side: Side
    visit: int
    day: date
    sessions: list[str]
    from_baseline: CurveDistance | None
    """Null at the baseline itself."""
    from_other_leg: CurveDistance
    """Of the leg's own joints, so never of all four variables."""


def curve_visits(visits: LikeTrials) -> list[CurveVisit]:
    """Every visit and leg with a sagittal curve; none where no curve was ever told of it."""
    found: list[CurveVisit] = []
    first: dict[Side, Curves] = {}
    for visit, trials in visits:
        legs = {side: leg_curves([_told(trial) for trial in trials], side) for side in Side}
        for side, curves in legs.items():
            if not curves:
                continue
            since = curve_distance(curves, first[side]) if side in first else None
            # The pelvis has one curve, which lies no distance from itself.
            other = {name: curve for name, curve in legs[side.other].items() if name not in ONE_FOR_BOTH}
            sessions = [trial.session for trial in trials]
            how = trials[0].task, trials[0].conditions.speed_instruction
            found.append(
                CurveVisit(*how, side, visit.number, visit.day, sessions, since, curve_distance(curves, other))
            )
            first.setdefault(side, curves)
    return found


def leg_curves(trials: Sequence[Mapping[str, MeanCurve]], side: Side) -> Curves:
    """Mean curves of one leg, over trials by their number of strides; the pelvis counts for both legs."""
    curves: Curves = {}
    for name in VARIABLES:
        told = [curve for trial in trials if (curve := trial.get(f"{name}_{side}") or trial.get(name)) is not None]
        strides = sum(curve.strides for curve in told)
        if strides:
            columns = zip(*(curve.mean for curve in told), strict=True)
            weights = [curve.strides / strides for curve in told]
            curves[name] = [sum(w * x for w, x in zip(weights, column, strict=True)) for column in columns]
    return curves


def _told(trial: Trial) -> dict[str, MeanCurve]:
    return {} if trial.metrics is None else {curve.degree_of_freedom: curve for curve in trial.metrics.curves}
