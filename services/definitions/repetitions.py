"""What each metric of an exercise is: rows of the same table, measured on repetitions instead of strides."""

from collections.abc import Callable

from schemas.tasks import Repetition
from services.definitions.definition import CV_SUFFIX, SD_SUFFIX, Definition


def _angles(repetition: Repetition) -> tuple[float, float, float]:
    return repetition.start_angle, repetition.turn_angle, repetition.end_angle


def range_of(repetition: Repetition) -> float:
    """rad, the largest minus the smallest angle."""
    return max(_angles(repetition)) - min(_angles(repetition))


def _flexes_first(repetition: Repetition) -> bool:
    return 2 * repetition.turn_angle > repetition.start_angle + repetition.end_angle


def _flexing_time(repetition: Repetition) -> float:
    there, back = repetition.turn_ns - repetition.start_ns, repetition.end_ns - repetition.turn_ns
    return (there if _flexes_first(repetition) else back) / 1e9


def _extending_time(repetition: Repetition) -> float:
    return (repetition.end_ns - repetition.start_ns) / 1e9 - _flexing_time(repetition)


RANGE = "repetition_range"

MeasureOfRepetition = Callable[[Repetition], float | None]
RepetitionMeans = tuple[tuple[Definition, MeasureOfRepetition], ...]

RANGE_MEAN = (
    Definition(RANGE, "rad", True, "Largest minus smallest angle of what is followed within a repetition."),
    range_of,
)
PEAK_VELOCITY_MEAN: tuple[Definition, MeasureOfRepetition] = (
    Definition("repetition_peak_velocity", "rad/s", True, "Largest angular velocity of what is followed, either way."),
    lambda repetition: repetition.largest_velocity,
)

REPETITION_MEANS: RepetitionMeans = (
    RANGE_MEAN,
    (
        Definition("repetition_flexion_largest", "rad", True, "Largest knee flexion of a repetition."),
        lambda repetition: max(_angles(repetition)),
    ),
    (
        Definition(
            "repetition_flexion_smallest",
            "rad",
            True,
            "Smallest knee flexion of a repetition: what is missing to full extension, where the exercise goes there.",
        ),
        lambda repetition: min(_angles(repetition)),
    ),
    (
        Definition(
            "repetition_time_flexing",
            "s",
            True,
            "Time in which the knee flexes, with half of the hold at the turn.",
        ),
        _flexing_time,
    ),
    (
        Definition(
            "repetition_time_extending",
            "s",
            True,
            "Time in which the knee extends, with half of the hold at the turn.",
        ),
        _extending_time,
    ),
    PEAK_VELOCITY_MEAN,
)
"""Metrics that every repetition of a knee has: the mean over the repetitions is shown."""

TEMPO = Definition(
    "repetition_tempo",
    "repetitions/min",
    True,
    "60 s / mean time from the start of a repetition to the start of the next, rests between sets left out.",
)
RANGE_SD = Definition(RANGE + SD_SUFFIX, "rad", True, f"Standard deviation of {RANGE} over the repetitions.")
RANGE_CV = Definition(RANGE + CV_SUFFIX, "1", True, f"Coefficient of variation of {RANGE}: standard deviation / mean.")
RANGE_SLOPE = Definition(
    "repetition_range_slope",
    "rad/repetition",
    True,
    f"By how much {RANGE} changes from one repetition to the next, least squares over all; negative: it gets smaller.",
)
REPETITIONS_COUNTED = Definition("repetitions_counted", "1", True, "Number of repetitions that count.")
REPETITIONS_REJECTED = Definition(
    "repetitions_rejected",
    "1",
    True,
    "Number of repetitions that do not count: partial, interrupted, or something about them is wrong.",
)

REPETITIONS: tuple[Definition, ...] = (
    REPETITIONS_COUNTED,
    REPETITIONS_REJECTED,
    *(definition for definition, _ in REPETITION_MEANS),
    RANGE_SD,
    RANGE_CV,
    RANGE_SLOPE,
    TEMPO,
)
"""All of them, in the order of every message of a session in which knees exercise."""
