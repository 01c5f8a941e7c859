"""Scatter over the strides as a metric of its own, and how many strides there were."""

from services.definitions.definition import CV_SUFFIX, SD_SUFFIX, Basis, Definition
from services.definitions.strides import STRIDE_METRICS

VARIABILITY_OF = (
    "stride_time",
    "stride_length",
    "walking_speed",
    "step_length",
    "step_time",
    "stance_time",
    "swing_time",
)

_BY_NAME = {definition.name: definition for definition in STRIDE_METRICS}

VARIABILITY: tuple[Definition, ...] = tuple(
    definition
    for name in VARIABILITY_OF
    for definition in (
        Definition(
            name + SD_SUFFIX,
            _BY_NAME[name].unit,
            _BY_NAME[name].per_side,
            f"Standard deviation of {name} over the strides.",
            basis=_BY_NAME[name].basis,
        ),
        Definition(
            name + CV_SUFFIX,
            "1",
            _BY_NAME[name].per_side,
            f"Coefficient of variation of {name}: standard deviation / mean.",
            basis=_BY_NAME[name].basis,
        ),
    )
)

COUNTED, TURNING, REJECTED = "strides_counted", "strides_turning", "strides_rejected"
ENDS = "strides_starting_or_stopping"

COUNTS: tuple[Definition, ...] = tuple(
    Definition(name, "1", True, sentence, basis=Basis.COUNT)
    for name, sentence in (
        (COUNTED, "Number of strides that count: valid, straight and, where enough are, steady."),
        (
            ENDS,
            "Number of strides left out because they are the foot's first or last of a walk; 0 while too few would "
            "remain.",
        ),
        (TURNING, "Number of valid strides within which the pelvis turned; they do not count."),
        (REJECTED, "Number of strides that do not count because something about them is wrong."),
    )
)
