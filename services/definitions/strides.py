"""Metrics that every stride has: the mean over the strides is shown."""

from services.definitions.definition import Basis, Definition
from services.definitions.stride_measures import (
    at_contact,
    depth,
    double_support,
    extent,
    field,
    in_seconds,
    in_stance,
    in_swing,
    initial_double_support,
    mean,
    of_curve,
    single_support,
    steps_per_minute,
    swing_fraction,
    terminal_double_support,
)

_CONTACTS, _TOE_OFFS, _LENGTHS = Basis.CONTACTS, Basis.TOE_OFFS, Basis.LENGTHS

_WHOLE_STRIDE: tuple[Definition, ...] = (
    Definition("stride_time", "s", False, "Time of a stride, of either foot.", field("stride_time_s"), _CONTACTS),
    Definition("cadence", "steps/min", False, "Two steps per stride time.", steps_per_minute, _CONTACTS),
    Definition(
        "stride_length",
        "m",
        False,
        "Forward distance between two successive placements of the same foot: the sum of the two steps.",
        field("stride_length_m"),
        _LENGTHS,
    ),
    Definition("walking_speed", "m/s", False, "Stride length / stride time.", field("walking_speed"), _LENGTHS),
)

_STEPS: tuple[Definition, ...] = (
    Definition(
        "step_length",
        "m",
        True,
        "Forward distance from the other foot to this foot at this foot's initial contact; this foot leads.",
        field("step_length_m"),
        _LENGTHS,
    ),
    Definition(
        "step_time",
        "s",
        True,
        "Time from the other foot's initial contact to this foot's next one; this foot leads.",
        field("step_time_s"),
        _CONTACTS,
    ),
    Definition(
        "step_width",
        "m",
        False,
        "Sideways distance of the feet at initial contact; from a camera only.",
        field("step_width_m"),
        Basis.WIDTH,
    ),
    Definition(
        "circumduction",
        "m",
        True,
        "How far the ankle swings outward of the straight line between its two contacts.",
        field("circumduction_m"),
        _LENGTHS,
    ),
)

_STANCE: tuple[Definition, ...] = (
    Definition(
        "stance_fraction",
        "1",
        True,
        "Share of the stride from initial contact to toe-off of the same foot.",
        field("stance_fraction"),
        _TOE_OFFS,
    ),
    Definition(
        "stance_time",
        "s",
        True,
        "Time from initial contact to toe-off of the same foot.",
        in_seconds(field("stance_fraction")),
        _TOE_OFFS,
    ),
    Definition("swing_fraction", "1", True, "Share of the stride that is not stance.", swing_fraction, _TOE_OFFS),
    Definition(
        "swing_time",
        "s",
        True,
        "Time from toe-off to the next initial contact of the same foot.",
        in_seconds(swing_fraction),
        _TOE_OFFS,
    ),
)

_SUPPORT: tuple[Definition, ...] = (
    Definition(
        "initial_double_support_fraction",
        "1",
        True,
        "Share of the stride from this foot's initial contact to the other foot's toe-off.",
        initial_double_support,
        _TOE_OFFS,
    ),
    Definition(
        "terminal_double_support_fraction",
        "1",
        True,
        "Share of the stride from the other foot's initial contact to this foot's toe-off.",
        terminal_double_support,
        _TOE_OFFS,
    ),
    Definition(
        "single_support_fraction",
        "1",
        True,
        "Share of the stride in which this foot alone is on the ground.",
        single_support,
        _TOE_OFFS,
    ),
    Definition(
        "double_support_fraction",
        "1",
        False,
        "Share of the stride in which both feet are on the ground: initial and terminal double support.",
        double_support,
        _TOE_OFFS,
    ),
    Definition(
        "initial_double_support_time",
        "s",
        True,
        "Time from this foot's initial contact to the other foot's toe-off.",
        in_seconds(initial_double_support),
        _TOE_OFFS,
    ),
    Definition(
        "terminal_double_support_time",
        "s",
        True,
        "Time from the other foot's initial contact to this foot's toe-off.",
        in_seconds(terminal_double_support),
        _TOE_OFFS,
    ),
    Definition(
        "single_support_time",
        "s",
        True,
        "Time of a stride in which this foot alone is on the ground.",
        in_seconds(single_support),
        _TOE_OFFS,
    ),
    Definition(
        "double_support_time",
        "s",
        False,
        "Time of a stride in which both feet are on the ground.",
        in_seconds(double_support),
        _TOE_OFFS,
    ),
)


def _angle(name: str, sentence: str, joint: str, take: str) -> Definition:
    measure = {
        "range": of_curve(joint, extent),
        "mean": of_curve(joint, mean),
        "largest": of_curve(joint, max),
        "smallest": of_curve(joint, min),
        "depth": of_curve(joint, depth),
        "contact": of_curve(joint, at_contact),
        "swing largest": in_swing(joint, max),
        "swing mean": in_swing(joint, mean),
        "swing depth": in_swing(joint, depth),
        "stance smallest": in_stance(joint, min),
    }[take]
    basis = Basis(joint.split("_", maxsplit=1)[0])
    return Definition(name, "rad", basis is not Basis.PELVIS, sentence, measure, basis)


_ANGLES: tuple[Definition, ...] = (
    _angle("knee_flexion_range", "Largest minus smallest knee flexion.", "knee_flexion", "range"),
    _angle("knee_flexion_at_contact", "Knee flexion at initial contact.", "knee_flexion", "contact"),
    _angle(
        "knee_flexion_smallest_stance",
        "Smallest knee flexion from initial contact to toe-off; negative: overstretched.",
        "knee_flexion",
        "stance smallest",
    ),
    _angle("knee_flexion_peak_swing", "Largest knee flexion after toe-off.", "knee_flexion", "swing largest"),
    _angle("hip_flexion_range", "Largest minus smallest hip flexion.", "hip_flexion", "range"),
    _angle("hip_flexion_at_contact", "Hip flexion at initial contact.", "hip_flexion", "contact"),
    _angle("hip_flexion_peak", "Largest hip flexion within the stride.", "hip_flexion", "largest"),
    _angle(
        "hip_extension_peak",
        "Largest hip extension, the negative of the smallest hip flexion.",
        "hip_flexion",
        "depth",
    ),
    _angle("hip_adduction_mean_swing", "Mean hip adduction after toe-off.", "hip_adduction", "swing mean"),
    _angle(
        "hip_abduction_peak_swing",
        "Largest hip abduction after toe-off, the negative of the smallest hip adduction.",
        "hip_adduction",
        "swing depth",
    ),
    _angle(
        "hip_rotation_range",
        "Largest minus smallest internal rotation of the hip.",
        "hip_internal_rotation",
        "range",
    ),
    _angle(
        "hip_rotation_mean",
        "Mean internal rotation of the hip over the stride; negative: turned outward.",
        "hip_internal_rotation",
        "mean",
    ),
    _angle("ankle_dorsiflexion_at_contact", "Dorsiflexion at initial contact.", "ankle_dorsiflexion", "contact"),
    _angle(
        "ankle_dorsiflexion_peak_swing", "Largest dorsiflexion after toe-off.", "ankle_dorsiflexion", "swing largest"
    ),
    _angle("pelvis_tilt_mean", "Mean forward tilt of the pelvis over the stride.", "pelvis_tilt", "mean"),
    _angle("pelvis_tilt_range", "Largest minus smallest forward tilt of the pelvis.", "pelvis_tilt", "range"),
    _angle("pelvis_obliquity_range", "Largest minus smallest obliquity of the pelvis.", "pelvis_obliquity", "range"),
    _angle(
        "pelvis_rotation_range",
        "Largest minus smallest rotation of the pelvis about the vertical within a stride.",
        "pelvis_rotation",
        "range",
    ),
)

STRIDE_METRICS: tuple[Definition, ...] = (*_WHOLE_STRIDE, *_STEPS, *_STANCE, *_SUPPORT, *_ANGLES)
