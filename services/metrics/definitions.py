"""What each metric is: the table that computation, reports and documentation derive from."""

from collections.abc import Callable
from dataclasses import dataclass

from schemas.gait import Stride
from schemas.rhythm import RhythmKind

STRIDE_DEFINITION = "A stride lasts from one initial contact of a foot to the next initial contact of the same foot."

Measure = Callable[[Stride], float | None]


@dataclass(frozen=True, slots=True)
class Definition:
    """One row of the table. `measure` gives the value of one stride; None where the metric rests on others."""

    name: str
    unit: str
    per_side: bool
    sentence: str
    measure: Measure | None = None


def _steps_per_minute(stride: Stride) -> float | None:
    return 120.0 / stride.stride_time_s


def _stance_time(stride: Stride) -> float | None:
    return None if stride.stance_fraction is None else stride.stance_fraction * stride.stride_time_s


def _swing_time(stride: Stride) -> float | None:
    return None if stride.stance_fraction is None else (1 - stride.stance_fraction) * stride.stride_time_s


def _curve(stride: Stride, joint: str) -> list[float] | None:
    curve = stride.curves.get(f"{joint}_{stride.side}")
    return None if curve is None else curve.position


def _range(joint: str) -> Measure:
    def measure(stride: Stride) -> float | None:
        curve = _curve(stride, joint)
        return None if curve is None else max(curve) - min(curve)

    return measure


def _largest(joint: str) -> Measure:
    def measure(stride: Stride) -> float | None:
        curve = _curve(stride, joint)
        return None if curve is None else max(curve)

    return measure


def _hip_extension_peak(stride: Stride) -> float | None:
    curve = _curve(stride, "hip_flexion")
    return None if curve is None else -min(curve)


def _knee_at_contact(stride: Stride) -> float | None:
    curve = _curve(stride, "knee_flexion")
    return None if curve is None else curve[0]


def _knee_peak_swing(stride: Stride) -> float | None:
    curve = _curve(stride, "knee_flexion")
    if curve is None or stride.stance_fraction is None:
        return None
    return max(curve[round(100 * stride.stance_fraction) :])


STRIDE_METRICS: tuple[Definition, ...] = (
    Definition("stride_time", "s", False, "Time of a stride, of either foot.", lambda s: s.stride_time_s),
    Definition("cadence", "steps/min", False, "Two steps per stride time.", _steps_per_minute),
    Definition(
        "stride_length",
        "m",
        False,
        "Forward distance between two successive placements of the same foot: the sum of the two steps.",
        lambda s: s.stride_length_m,
    ),
    Definition("walking_speed", "m/s", False, "Stride length / stride time.", lambda s: s.walking_speed),
    Definition(
        "step_length",
        "m",
        True,
        "Forward distance from the other foot to this foot at this foot's initial contact; this foot leads.",
        lambda s: s.step_length_m,
    ),
    Definition(
        "step_time",
        "s",
        True,
        "Time from the other foot's initial contact to this foot's next one; this foot leads.",
        lambda s: s.step_time_s,
    ),
    Definition(
        "stance_fraction",
        "1",
        True,
        "Share of the stride from initial contact to toe-off of the same foot.",
        lambda s: s.stance_fraction,
    ),
    Definition("stance_time", "s", True, "Time from initial contact to toe-off of the same foot.", _stance_time),
    Definition("swing_time", "s", True, "Time from toe-off to the next initial contact of the same foot.", _swing_time),
    Definition("knee_flexion_range", "rad", True, "Largest minus smallest knee flexion.", _range("knee_flexion")),
    Definition("knee_flexion_at_contact", "rad", True, "Knee flexion at initial contact.", _knee_at_contact),
    Definition("knee_flexion_peak_swing", "rad", True, "Largest knee flexion after toe-off.", _knee_peak_swing),
    Definition("hip_flexion_range", "rad", True, "Largest minus smallest hip flexion.", _range("hip_flexion")),
    Definition("hip_flexion_peak", "rad", True, "Largest hip flexion within the stride.", _largest("hip_flexion")),
    Definition(
        "hip_extension_peak",
        "rad",
        True,
        "Largest hip extension, the negative of the smallest hip flexion.",
        _hip_extension_peak,
    ),
)
"""Metrics that every stride has: the mean over the strides is shown."""

RATIO_SUFFIX = "_ratio_larger_to_smaller"
RATIOS_OF = ("step_length", "step_time", "stance_time", "swing_time", "knee_flexion_range")
SD_SUFFIX, CV_SUFFIX = "_sd", "_cv"
VARIABILITY_OF = ("stride_time", "stride_length", "walking_speed", "step_length")

_BY_NAME = {definition.name: definition for definition in STRIDE_METRICS}

RATIOS: tuple[Definition, ...] = tuple(
    Definition(
        name + RATIO_SUFFIX,
        "1",
        False,
        f"Symmetry ratio: the larger of the two sides' mean {name} / the smaller; 1 is symmetric.",
    )
    for name in RATIOS_OF
)

VARIABILITY: tuple[Definition, ...] = tuple(
    definition
    for name in VARIABILITY_OF
    for definition in (
        Definition(
            name + SD_SUFFIX,
            _BY_NAME[name].unit,
            _BY_NAME[name].per_side,
            f"Standard deviation of {name} over the strides.",
        ),
        Definition(
            name + CV_SUFFIX,
            "1",
            _BY_NAME[name].per_side,
            f"Coefficient of variation of {name}: standard deviation / mean.",
        ),
    )
)

COUNTED, TURNING, REJECTED = "strides_counted", "strides_turning", "strides_rejected"
ENDS = "strides_starting_or_stopping"

COUNTS: tuple[Definition, ...] = (
    Definition(COUNTED, "1", True, "Number of strides that count: valid, straight and, where enough are, steady."),
    Definition(
        ENDS,
        "1",
        True,
        "Number of strides left out because they are the foot's first or last of a walk; 0 while too few would remain.",
    ),
    Definition(TURNING, "1", True, "Number of valid strides within which the pelvis turned; they do not count."),
    Definition(REJECTED, "1", True, "Number of strides that do not count because something about them is wrong."),
)

SIDE_DISTANCE = Definition(
    "rhythm_side_distance",
    "rad",
    False,
    "Root mean square difference of the learned hip and knee flexion of the two legs over the stride, each about its "
    "mean, after the one shift in time that makes it smallest.",
)
SIDE_SHAPE = Definition(
    "rhythm_side_shape",
    "1",
    False,
    "The same after one leg was scaled to the other by one factor, as a share of its size: 0 equal, 1 unlike.",
)
SIDE_TIMING = Definition(
    "rhythm_side_timing",
    "1",
    False,
    "By how much of a stride the right leg follows the left by more than half a stride; negative: by less.",
)


def _compared_with(name: str, whose: str) -> tuple[Definition, Definition]:
    distance = Definition(
        f"rhythm_distance_{name}",
        "rad",
        True,
        f"Root mean square difference of the leg's learned hip and knee flexion from {whose} over the stride, each "
        "about its mean, after the one shift in time that makes it smallest.",
    )
    shape = Definition(
        f"rhythm_shape_{name}",
        "1",
        True,
        f"The same after {whose} was scaled by one factor, as a share of its size: 0 equal, 1 unlike.",
    )
    return distance, shape


COMPARED_WITH: dict[RhythmKind, tuple[Definition, Definition]] = {
    "previous trial": _compared_with("previous_trial", "the previous trial's"),
    "previous visit": _compared_with("previous_visit", "the previous visit's"),
    "exemplar": _compared_with("exemplar", "the exemplar's"),
}
"""Distance and shape distance from each kind of known rhythm; in a message only where one of that kind is known."""

RHYTHMS: tuple[Definition, ...] = (
    SIDE_DISTANCE,
    SIDE_SHAPE,
    SIDE_TIMING,
    *(definition for pair in COMPARED_WITH.values() for definition in pair),
)

METRICS: tuple[Definition, ...] = (*STRIDE_METRICS, *RATIOS, *VARIABILITY, *COUNTS, *RHYTHMS)
"""All metrics, in the order of every message."""
