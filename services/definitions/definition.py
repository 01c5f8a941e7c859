"""One row of the table that computation, reports, exports and documentation derive from."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from schemas.gait import Stride

STRIDE_DEFINITION = "A stride lasts from one initial contact of a foot to the next initial contact of the same foot."

RATIO_SUFFIX = "_ratio_larger_to_smaller"
PARETIC_RATIO_SUFFIX = "_ratio_paretic_to_non_paretic"
SD_SUFFIX, CV_SUFFIX = "_sd", "_cv"

Measure = Callable[[Stride], float | None]
"""The value of one stride; None where the stride does not tell it."""


class Basis(StrEnum):
    """What a number rests on: which sensors it needs, and which error all strides share."""

    CONTACTS = "contacts"
    TOE_OFFS = "toe_offs"
    LENGTHS = "lengths"
    PELVIS = "pelvis"
    HIP = "hip"
    KNEE = "knee"
    ANKLE = "ankle"
    WIDTH = "width"
    TRUNK = "trunk"
    RHYTHM = "rhythm"
    TASK = "task"
    COUNT = "count"


ANGLES = (Basis.PELVIS, Basis.HIP, Basis.KNEE, Basis.ANKLE)


@dataclass(frozen=True, slots=True)
class Definition:
    """`measure` gives the value of one stride; None where the metric rests on others.

    A number that is for export only stands in files and is shown on no page: it says again what another one says.
    """

    name: str
    unit: str
    per_side: bool
    sentence: str
    measure: Measure | None = None
    basis: Basis = Basis.TASK
    export_only: bool = False
