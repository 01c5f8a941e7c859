"""Symmetry of the two sides' means: one ratio on pages, three other numbers of the same in files."""

from services.definitions.definition import PARETIC_RATIO_SUFFIX, RATIO_SUFFIX, Basis, Definition
from services.definitions.strides import STRIDE_METRICS

RATIOS_OF = (
    "step_length",
    "step_time",
    "stance_time",
    "swing_time",
    "single_support_time",
    "knee_flexion_range",
    "hip_flexion_range",
)
INDEX_SUFFIX, LOG_SUFFIX, ANGLE_SUFFIX = "_symmetry_index", "_gait_asymmetry", "_symmetry_angle"

BASIS_OF: dict[str, Basis] = {definition.name: definition.basis for definition in STRIDE_METRICS}

RATIOS: tuple[Definition, ...] = tuple(
    Definition(
        name + RATIO_SUFFIX,
        "1",
        False,
        f"Symmetry ratio: the larger of the two sides' mean {name} / the smaller; 1 is symmetric.",
        basis=BASIS_OF[name],
    )
    for name in RATIOS_OF
)
"""Where no side is declared to be the paretic one."""

PARETIC_RATIOS: tuple[Definition, ...] = tuple(
    Definition(
        name + PARETIC_RATIO_SUFFIX,
        "1",
        False,
        f"Symmetry ratio: mean {name} of the paretic side / that of the other; 1 is symmetric.",
        basis=BASIS_OF[name],
    )
    for name in RATIOS_OF
)
"""Where a side is."""


def _for_export(name: str, suffix: str, sentence: str) -> Definition:
    return Definition(name + suffix, "1", False, sentence, basis=BASIS_OF[name], export_only=True)


OTHER_SYMMETRY: tuple[Definition, ...] = tuple(
    definition
    for name in RATIOS_OF
    for definition in (
        _for_export(
            name,
            INDEX_SUFFIX,
            f"Symmetry index of {name}: (right - left) / mean of both; 0 is symmetric.",
        ),
        _for_export(
            name,
            LOG_SUFFIX,
            f"Gait asymmetry of {name}: natural logarithm of its symmetry ratio; 0 is symmetric.",
        ),
        _for_export(
            name,
            ANGLE_SUFFIX,
            f"Symmetry angle of {name}: (45 deg - arctan(left / right)) / 90 deg; 0 is symmetric.",
        ),
    )
)
"""For exports only."""
