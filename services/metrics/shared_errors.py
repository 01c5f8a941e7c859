"""Errors that every stride of a session has alike, and that no number of strides averages out.

Lengths of segments as somebody measured them, the bias of contacts and toe-offs, how sensors are aligned with bones,
and the share of the filter's own deviation that stays the same from stride to stride.
"""

import math
from collections.abc import Mapping

from schemas.session import SessionDescription
from services.definitions.definition import Basis, Definition
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
    "double_support": 2.0,
}
_STEPS_IN = {"step_length": 1.0, "stride_length": 2.0, "walking_speed": 2.0}


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
        if definition.basis in p.angles:
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
        p = self._p
        level, extent = p.angles[definition.basis]
        if definition.name.endswith("_range"):
            return extent
        seen = [std for joint, std in deviations.items() if joint.startswith(definition.basis.value)]
        own = [std for joint, std in deviations.items() if joint == f"{definition.basis}_flexion_{side}"]
        filtered = (own or seen or [0.0])[0]
        return math.hypot(level, p.filter_share * filtered)

    def log_std(self, definition: Definition) -> float:
        """Of a ratio of both sides, relative: what both sides share cancels, this is what does not."""
        return self._p.ratios.get(definition.basis, 0.0)

    def noise(self, definition: Definition, mean: float) -> float:
        """Scatter from stride to stride that measuring adds, in the unit of a standard deviation or, as a CV, of 1."""
        p = self._p
        absolute = {Basis.CONTACTS: p.event_jitter_s, Basis.TOE_OFFS: p.event_jitter_s, Basis.LENGTHS: p.length_jitter}
        jitter = absolute.get(definition.basis, 0.0)
        return jitter / mean if definition.name.endswith("_cv") and mean > 0 else jitter
