"""What each metric of a task of the whole body is, beside those that it shares with the exercises of a knee."""

from schemas.tasks import Repetition
from schemas.vocabulary import Side, Task
from services.definitions.definition import RATIO_SUFFIX, Definition
from services.definitions.repetitions import PEAK_VELOCITY_MEAN, RANGE, RANGE_MEAN, RepetitionMeans

EXERCISE_MEANS: RepetitionMeans = (
    RANGE_MEAN,
    (
        Definition(
            "repetition_time_out",
            "s",
            True,
            "Time from the start to the turn: down in a squat, with half of the hold there.",
        ),
        lambda repetition: (repetition.turn_ns - repetition.start_ns) / 1e9,
    ),
    (
        Definition(
            "repetition_time_back",
            "s",
            True,
            "Time from the turn to the end: up in a squat, with half of the hold at the turn.",
        ),
        lambda repetition: (repetition.end_ns - repetition.turn_ns) / 1e9,
    ),
    (
        Definition("repetition_hold", "s", True, "Time within 5 % of the range from the farthest point."),
        lambda repetition: repetition.hold_s,
    ),
    PEAK_VELOCITY_MEAN,
)
"""Metrics that every repetition of such a task has: the mean over the repetitions is shown."""

JOINT_RANGES: dict[str, Definition] = {
    "knee_flexion": Definition(
        "repetition_knee_flexion_range", "rad", True, "Largest minus smallest knee flexion within a repetition."
    ),
    "hip_flexion": Definition(
        "repetition_hip_flexion_range", "rad", True, "Largest minus smallest hip flexion within a repetition."
    ),
    "arm_elevation": Definition(
        "repetition_arm_elevation_range",
        "rad",
        True,
        "Largest minus smallest angle between upper arm and trunk within a repetition, where the arm was seen.",
    ),
}
"""By joint: what a repetition's ranges tell of it, side by side."""

JOINTS_OF: dict[Task, tuple[str, ...]] = {
    Task.SQUAT: ("knee_flexion", "hip_flexion", "arm_elevation"),
    Task.STEPPING: ("knee_flexion",),
}
"""Joints whose ranges a task tells: of both sides in a squat, of the leg that steps in stepping."""


def joint_range(repetition: Repetition, joint: str, side: Side) -> float | None:
    """rad; None where the joint was not seen all the time, or the repetition is of the other side."""
    return repetition.ranges.get(f"{joint}_{side}") if repetition.side in (None, side) else None


def _ratio(name: str) -> Definition:
    return Definition(
        name + RATIO_SUFFIX,
        "1",
        False,
        f"Symmetry ratio: the larger of the two sides' mean {name} / the smaller; 1 is symmetric.",
    )


RANGE_RATIO = _ratio(RANGE)
JOINT_RATIOS: dict[str, Definition] = {
    joint: _ratio(JOINT_RANGES[joint].name) for joint in ("knee_flexion", "hip_flexion")
}
"""Symmetry of legs; an arm that is held up is no matter of symmetry."""

_SHARED = (RANGE_MEAN[0], PEAK_VELOCITY_MEAN[0])
EXERCISES: tuple[Definition, ...] = (
    *(definition for definition, _ in EXERCISE_MEANS if definition not in _SHARED),
    *JOINT_RANGES.values(),
    RANGE_RATIO,
    *JOINT_RATIOS.values(),
)
"""Those that no exercise of a knee has."""
