import math

import pytest

from services.definitions.definition import ANGLES, Basis
from services.definitions.strides import STRIDE_METRICS
from services.definitions.symmetry import RATIOS
from services.definitions.table import BY_NAME
from services.metrics.parameters import SharedErrorParameters
from services.metrics.shared_errors import FILTER_STEP, SharedErrors

P = SharedErrorParameters()


def errors(description, source: str = "measured") -> SharedErrors:
    body = description.anthropometry.model_copy(update={"source": source})
    return SharedErrors(description.model_copy(update={"anthropometry": body}), P)


def std(found: SharedErrors, name: str, value: float, side: str | None = None, **deviations: float) -> float:
    return found.std(BY_NAME[name], value, side, 1.25, deviations)


def test_a_length_is_as_good_as_the_body_is_known(description):
    by_source = {source: std(errors(description, source), "step_length", 0.6) for source in P.relative_length}
    assert by_source["measured"] == pytest.approx(0.6 * math.hypot(0.03, P.relative_stride_time))
    assert by_source["measured"] < by_source["regression"] < by_source["default"]


def test_the_filter_adds_a_share_of_its_own_deviation(description):
    found = errors(description)
    alone, with_filter = (std(found, "step_length", 0.6, "left", **{FILTER_STEP: each}) for each in (0.0, 0.08))
    assert with_filter == pytest.approx(math.hypot(alone, P.filter_share * 0.08))
    # A stride is two steps that err independently; a speed is a stride over its time.
    assert std(found, "stride_length", 0.0, **{FILTER_STEP: 0.08}) == pytest.approx(0.02 * math.sqrt(2))
    assert std(found, "walking_speed", 0.0, **{FILTER_STEP: 0.08}) == pytest.approx(0.02 * math.sqrt(2) / 1.25)


def test_events_are_early_or_late_by_the_same_in_time_and_share(description):
    found = errors(description)
    both = math.hypot(P.contact_bias_s, P.toe_off_bias_s)
    assert std(found, "stance_time", 0.7, "left") == pytest.approx(both)
    assert std(found, "stance_fraction", 0.6, "left") == pytest.approx(both / 1.25)
    # From contact to contact of the same foot the bias cancels.
    assert std(found, "stride_time", 1.25) < 0.005


def test_angles_have_the_deviation_of_their_own_curve(description):
    found = errors(description)
    curves = {"hip_flexion_left": 0.2, "hip_flexion_right": 0.0, "hip_internal_rotation_left": 0.1}
    assert std(found, "hip_extension_peak", 0.2, "left", **curves) == pytest.approx(math.hypot(0.06, 0.05))
    assert std(found, "hip_extension_peak", 0.2, "right", **curves) == pytest.approx(0.06)
    assert std(found, "hip_rotation_mean", 0.0, "left", **curves) == pytest.approx(
        math.hypot(P.levels["hip_rotation"], 0.025)
    )
    assert std(found, "hip_flexion_range", 0.7, "left", **curves) == P.extents["hip_flexion"]


def test_every_metric_of_strides_and_every_ratio_has_one(description):
    found = errors(description)
    for definition in STRIDE_METRICS:
        assert found.std(definition, 0.5, "left" if definition.per_side else None, 1.2, {}) > 0, definition.name
    assert all(found.log_std(definition) > 0 for definition in RATIOS)
    assert {definition.basis for definition in STRIDE_METRICS} <= {
        *ANGLES, Basis.CONTACTS, Basis.TOE_OFFS, Basis.LENGTHS, Basis.WIDTH
    }  # fmt: skip
