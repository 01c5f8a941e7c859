"""Verdicts, and the rules they come from as codes with parameters: a page or a report says them in its language."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """The three words of the clinical conventions, section 10.4."""

    REAL_CHANGE = "real_change"
    WITHIN_MEASUREMENT_ERROR = "within_measurement_error"
    CANNOT_TELL = "cannot_tell"


class Direction(StrEnum):
    """Of a real change, where the measure has a better side."""

    BETTER = "better"
    WORSE = "worse"


class JointWord(StrEnum):
    """How a joint goes with walking speed."""

    RECOVERY = "recovery"
    COMPENSATION_POSSIBLE = "compensation_possible"
    CANNOT_TELL = "cannot_tell"


class RuleCode(StrEnum):
    """Why a verdict is what it is, or why a value takes no part. `RULES` lists the parameters of each."""

    CHANGE_BEYOND_MDC = "change_beyond_mdc"
    CHANGE_WITHIN_MDC = "change_within_mdc"
    INTERVAL_REACHES_MDC = "interval_reaches_mdc"
    OWN_ERROR_NOT_SMALLER = "own_error_not_smaller"
    BELOW_SMALLEST_CHANGE = "below_smallest_change"
    NO_BASELINE = "no_baseline"
    NO_BASELINE_VALUE = "no_baseline_value"
    BASELINE_ONLY = "baseline_only"
    NO_VALUE = "no_value"
    NO_INTERVAL = "no_interval"
    GRADE_TOO_LOW = "grade_too_low"
    TOO_FEW_STRIDES = "too_few_strides"
    POPULATION_UNSAID = "population_unsaid"
    POPULATION_CHANGED = "population_changed"
    NO_THRESHOLD = "no_threshold"
    NO_BASELINE_SPEED = "no_baseline_speed"
    DIFFERENCE = "difference"
    UNSAID = "unsaid"
    REFERENCE_CHANGED = "reference_changed"
    SPEED_UP_SIDES_CLOSER = "speed_up_sides_closer"
    SPEED_UP_OTHER_MOTION_GREW = "speed_up_other_motion_grew"
    SIDES_CLOSER_AND_OTHER_MOTION_GREW = "sides_closer_and_other_motion_grew"
    SPEED_NOT_UP = "speed_not_up"
    SIDES_NOT_CLOSER = "sides_not_closer"


RULES: Mapping[RuleCode, tuple[str, ...]] = {
    RuleCode.CHANGE_BEYOND_MDC: ("change", "low", "high", "mdc", "limit"),
    RuleCode.CHANGE_WITHIN_MDC: ("change", "low", "high", "mdc", "limit"),
    RuleCode.INTERVAL_REACHES_MDC: ("change", "low", "high", "mdc", "limit"),
    RuleCode.OWN_ERROR_NOT_SMALLER: ("half_interval", "mdc"),
    RuleCode.BELOW_SMALLEST_CHANGE: ("change", "smallest"),
    RuleCode.NO_BASELINE: (),
    RuleCode.NO_BASELINE_VALUE: ("visit",),
    RuleCode.BASELINE_ONLY: ("visit",),
    RuleCode.NO_VALUE: ("because",),
    RuleCode.NO_INTERVAL: (),
    RuleCode.GRADE_TOO_LOW: ("grade",),
    RuleCode.TOO_FEW_STRIDES: ("strides", "least"),
    RuleCode.POPULATION_UNSAID: (),
    RuleCode.POPULATION_CHANGED: ("now", "baseline"),
    RuleCode.NO_THRESHOLD: ("population", "occasion"),
    RuleCode.NO_BASELINE_SPEED: ("visit",),
    RuleCode.DIFFERENCE: ("what", "now", "baseline"),
    RuleCode.UNSAID: ("what",),
    RuleCode.REFERENCE_CHANGED: ("set", "now", "baseline"),
    RuleCode.SPEED_UP_SIDES_CLOSER: ("speed_change", "distance_change"),
    RuleCode.SPEED_UP_OTHER_MOTION_GREW: ("speed_change", "motion", "motion_change"),
    RuleCode.SIDES_CLOSER_AND_OTHER_MOTION_GREW: ("distance_change", "motion", "motion_change"),
    RuleCode.SPEED_NOT_UP: ("speed_change", "low", "high"),
    RuleCode.SIDES_NOT_CLOSER: ("distance_change", "low", "high"),
}
"""Parameters of each rule, in SI, in the order in which a sentence may take them. `change`, `low`, `high`, `mdc`,
`limit` (the MDC and our own error together), `half_interval` and `smallest` are in the unit of the measure;
`speed_change` in m/s, `distance_change` in rad."""


Parameter = float | int | str | None


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule that applied, with its numbers."""

    code: RuleCode
    parameters: dict[str, Parameter]


def rule(code: RuleCode, *parameters: Parameter) -> Rule:
    """A rule with its parameters in the order of `RULES`."""
    return Rule(code, dict(zip(RULES[code], parameters, strict=True)))
