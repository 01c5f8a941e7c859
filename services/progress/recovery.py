"""Recovery or compensation: whether the legs come closer, or other motions grow, while walking gets faster.

A patient with a stiff knee may turn the hip outward instead of recovering (Joukov, fig. 15), so each joint's distance
from the other leg is set beside speed, hip rotation and circumduction.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date

from schemas.conditions import SpeedInstruction
from schemas.vocabulary import Task
from services.progress.estimates import Z95, Estimate, change, over_trials
from services.progress.rules import JointWord, Rule, RuleCode, rule
from services.progress.series import Series, VisitValue
from services.progress.visits import Trial, Visit

OTHER_MOTIONS = ("circumduction", "hip_rotation_range")
"""Measures whose growth may stand for a joint that did not recover."""


@dataclass(frozen=True, slots=True)
class JointVisit:
    """Distance of one joint of one leg from the other's at one visit, rad."""

    visit: int
    day: date
    sessions: list[str]
    distance: float
    low: float
    high: float
    speed: float | None
    """m/s at that visit; null where it is not comparable."""


@dataclass(frozen=True, slots=True)
class JointRecovery:
    """One joint over the visits of one test, and the word for it."""

    task: Task
    instruction: SpeedInstruction | None
    joint: str
    visits: list[JointVisit]
    change: Estimate | None
    """rad, of the distance, newest visit against baseline."""
    word: JointWord
    rules: list[Rule]


def joint_recovery(
    joint: str, visits: Sequence[tuple[Visit, Sequence[Trial]]], speed: Series | None, others: Sequence[Series]
) -> JointRecovery | None:
    """One joint. `visits` holds each visit from the baseline on with its trials that are like the baseline's; `others`
    the series of `OTHER_MOTIONS` on the sides that count. Null where no trial compares the legs."""
    speeds = {} if speed is None else {each.visit: each for each in speed.visits}
    told = [_at(visit, trials, joint, speeds) for visit, trials in visits]
    known = [each for each in told if each is not None]
    if speed is None or not known:
        return None
    since = None if len(known) < 2 else change(_estimate(known[0]), _estimate(known[-1]))
    word, rules = _word(since, _change_at(speed, known[-1].visit), known[-1].visit, others)
    return JointRecovery(speed.task, speed.instruction, joint, known, since, word, rules)


def _estimate(visit: JointVisit) -> Estimate:
    return Estimate(visit.distance, visit.low, visit.high)


def _at(visit: Visit, trials: Sequence[Trial], joint: str, speeds: dict[int, VisitValue]) -> JointVisit | None:
    told = [(trial.session, side) for trial in trials if (side := trial.comparison(joint)) is not None]
    if not told:
        return None
    mean = over_trials(
        [Estimate(side.rmse, side.rmse - Z95 * side.rmse_std, side.rmse + Z95 * side.rmse_std) for _, side in told]
    )
    at = speeds.get(visit.number)
    sessions = [session for session, _ in told]
    speed = None if at is None else at.value
    return JointVisit(visit.number, visit.day, sessions, mean.value, mean.low, mean.high, speed)


def _change_at(series: Series, visit: int) -> Estimate | None:
    return next((each.change for each in series.visits if each.visit == visit), None)


def _word(
    distance: Estimate | None, speed: Estimate | None, visit: int, others: Sequence[Series]
) -> tuple[JointWord, list[Rule]]:
    """Speed up and legs closer: recovery. Speed up and another motion grown: compensation possible. Else cannot tell.

    Up, closer and grown mean that the whole 95 % interval of the change lies on that side of zero.
    """
    if distance is None or speed is None:
        return JointWord.CANNOT_TELL, [rule(RuleCode.BASELINE_ONLY, visit)]
    if speed.low <= 0:
        return JointWord.CANNOT_TELL, [rule(RuleCode.SPEED_NOT_UP, speed.value, speed.low, speed.high)]
    closer = distance.high < 0
    grown = [(each.measure, at.value) for each in others if (at := _change_at(each, visit)) is not None and at.low > 0]
    if closer and grown:
        code = RuleCode.SIDES_CLOSER_AND_OTHER_MOTION_GREW
        return JointWord.CANNOT_TELL, [rule(code, distance.value, name, value) for name, value in grown]
    if closer:
        return JointWord.RECOVERY, [rule(RuleCode.SPEED_UP_SIDES_CLOSER, speed.value, distance.value)]
    if grown:
        code = RuleCode.SPEED_UP_OTHER_MOTION_GREW
        return JointWord.COMPENSATION_POSSIBLE, [rule(code, speed.value, name, value) for name, value in grown]
    return JointWord.CANNOT_TELL, [rule(RuleCode.SIDES_NOT_CLOSER, distance.value, distance.low, distance.high)]
