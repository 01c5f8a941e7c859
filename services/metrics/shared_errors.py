"""Errors that every stride of a session has alike, and that no number of strides averages out.

Lengths of segments as somebody measured them, the bias of contacts and toe-offs, how sensors are aligned with bones,
and the share of the filter's own deviation that stays the same from stride to stride.
"""

import math
from collections.abc import Mapping

from schemas.session import SessionDescription
from services.definitions.definition import ANGLES, Basis, Definition
from services.metrics.parameters import SharedErrorParameters

FILTER_STEP = "step"
"""Key of the filter's mean deviation of a step, m, beside those of the curves, rad, by degree of freedom."""

Deviations = Mapping[str, float]

_EVENT_PAIRS = {
    "stance": 1.0,
    "swing": 1.0,
    "single_support": 1.0,
    "initial_double_support": 1.0,
    "terminal_double_support": 1.0,
    "double_support": math.sqrt(2.0),
}
_STEPS_IN = {"step_length": 1.0, "stride_length": math.sqrt(2.0), "walking_speed": math.sqrt(2.0)}
"""How many times the deviation of one step is in it: a stride is the sum of two that err independently."""
_EXTENTS = ("_range", "_peak_swing")
_OTHER_WAY = {"hip_extension": "hip_flexion", "hip_abduction": "hip_adduction"}
"""Metrics that count an angle the other way."""
_CURVES = {"hip_rotation": "hip_internal_rotation"}
"""Joints whose curve is called otherwise than its metrics."""


class SharedErrors:
    """Of one session."""

    def __init__(self, description: SessionDescription, parameters: SharedErrorParameters) -> None:
        self._p = parameters
        self._length = parameters.relative_length[description.anthropometry.source]

    def std(
        self, definition: Definition, value: float, side: str | None, stride_time_s: float, deviations: Deviations
    ) -> float:
        """Standard deviation in the metric's unit; stride_time_s and deviations are means over the strides."""
        name, p = definition.name, self._p
        if definition.basis is Basis.LENGTHS:
            return self._of_length(name, value, stride_time_s, deviations)
        if definition.basis is Basis.TOE_OFFS:
            measure, _, what = name.rpartition("_")
            seconds = _EVENT_PAIRS[measure] * math.hypot(p.contact_bias_s, p.toe_off_bias_s)
            return seconds if what == "time" else seconds / stride_time_s
        if definition.basis is Basis.CONTACTS:
            return self._of_contacts(name, value)
        if definition.basis in ANGLES:
            return self._of_angle(definition, side, deviations)
        return p.width_m if definition.basis is Basis.WIDTH else 0.0

    def _of_contacts(self, name: str, value: float) -> float:
        p = self._p
        if name == "step_time":
            return math.sqrt(2.0) * p.foot_difference_s
        return p.relative_stride_time * abs(value)

    def _of_length(self, name: str, value: float, stride_time_s: float, deviations: Deviations) -> float:
        p = self._p
        if name == "circumduction":
            return p.circumduction_m
        steps = _STEPS_IN[name]
        filtered = steps * p.filter_share * deviations.get(FILTER_STEP, 0.0)
        if name == "walking_speed":
            filtered /= stride_time_s
        return math.hypot(self._length * value, filtered, p.relative_stride_time * value)

    def _of_angle(self, definition: Definition, side: str | None, deviations: Deviations) -> float:
        name, p = definition.name, self._p
        joint = "_".join(name.split("_")[:2])
        joint = _OTHER_WAY.get(joint, joint)
        if name.endswith(_EXTENTS) and joint in p.extents:
            return p.extents[joint]
        curve = _CURVES.get(joint, joint)
        filtered = deviations.get(f"{curve}_{side}" if side else curve, 0.0)
        return math.hypot(p.levels.get(joint, 0.0), p.filter_share * filtered)

    def log_std(self, definition: Definition) -> float:
        """Of a ratio of both sides, relative: what both sides share cancels, this is what does not."""
        measures = (name for name in self._p.ratios if definition.name.startswith(f"{name}_"))
        return max((self._p.ratios[name] for name in measures), default=0.0)

    def noise(self, definition: Definition, mean: float) -> float:
        """Scatter from stride to stride that measuring adds, in the unit of a standard deviation or, as a CV, of 1."""
        p = self._p
        absolute = {
            Basis.CONTACTS: p.contact_jitter_s,
            Basis.TOE_OFFS: p.toe_off_jitter_s,
            Basis.LENGTHS: p.length_jitter,
        }
        jitter = absolute.get(definition.basis, 0.0)
        return jitter / mean if definition.name.endswith("_cv") and mean > 0 else jitter
