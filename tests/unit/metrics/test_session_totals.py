import math

import numpy as np
import pytest

from schemas.gait import StrideCurve
from schemas.vocabulary import Side
from services.definitions.rhythm import RHYTHMS
from services.definitions.symmetry import PARETIC_RATIOS
from services.definitions.table import WALK
from services.metrics.parameters import MetricsParameters
from services.metrics.session_totals import SessionTotals, sides_of
from services.metrics.shared_errors import SharedErrors

PARAMETERS = MetricsParameters()
ALL_COUNT = MetricsParameters(least_steady_strides=1000)


def table(totals: SessionTotals, parameters: MetricsParameters = ALL_COUNT) -> dict:
    return {(metric.name, metric.side): metric for metric in totals.metrics(parameters)}


@pytest.fixture
def totals(stride):
    """Builds totals from strides per side with a changing quantity."""

    def build(left: list[dict], right: list[dict]) -> SessionTotals:
        built = SessionTotals()
        for side, changes in ((Side.LEFT, left), (Side.RIGHT, right)):
            for index, change in enumerate(changes):
                built.add(stride(side, index, **change))
        return built

    return build


def test_every_row_of_the_table_in_its_order(totals):
    for built in (totals([], []), totals([{}] * 12, [{}] * 12)):
        expected = [(d.name, side) for d in WALK if d not in (*RHYTHMS, *PARETIC_RATIOS) for side in sides_of(d)]
        assert [(m.name, m.side) for m in built.metrics(PARAMETERS)] == expected
        assert all((m.value is None) == (m.withheld_because is not None) for m in built.metrics(PARAMETERS))


def test_values_by_hand(totals):
    found = table(totals([{}] * 4, [{}] * 4))
    values = {
        ("stride_time", None): 1.0,
        ("cadence", None): 120.0,
        ("stride_length", None): 1.2,
        ("walking_speed", None): 1.2,
        ("step_length", "left"): 0.6,
        ("step_time", "right"): 0.5,
        ("stance_fraction", "left"): 0.6,
        ("stance_time", "left"): 0.6,
        ("swing_time", "right"): 0.4,
        ("knee_flexion_range", "left"): 0.8,
        ("knee_flexion_at_contact", "left"): 0.5,
        ("knee_flexion_peak_swing", "right"): 0.5 + 0.4 * np.sin(2 * np.pi),
        ("hip_flexion_range", "right"): 0.4,
        ("hip_flexion_peak", "left"): 0.3,
        ("hip_extension_peak", "left"): 0.1,
        ("strides_counted", "right"): 4.0,
    }
    for key, value in values.items():
        assert found[key].value == pytest.approx(value), key
    assert found["cadence", None].strides == 8
    assert found["step_length", "left"].strides == 4


def test_spread_and_standard_error(totals):
    lengths = [0.5, 0.6, 0.7, 0.8]
    found = table(totals([{"step_length_m": value} for value in lengths], [{}] * 4))["step_length", "left"]
    assert found.value == pytest.approx(0.65)
    assert found.spread == pytest.approx(np.std(lengths, ddof=1))
    assert found.mean_std == pytest.approx(np.std(lengths, ddof=1) / 2)


def test_overlapping_strides_count_half_in_the_error_of_the_whole_body(totals):
    times = [0.9, 1.0, 1.1, 1.0]
    found = table(totals([{"stride_time_s": t} for t in times], [{"stride_time_s": t} for t in times]))
    metric = found["stride_time", None]
    assert metric.strides == 8
    assert metric.mean_std == pytest.approx(np.std(times * 2, ddof=1) / 2)


def test_too_few_strides_are_withheld_with_their_number(totals):
    found = table(totals([{}] * 2, []))
    assert found["step_length", "left"].value is None
    assert found["step_length", "left"].strides == 2
    assert found["step_length", "left"].withheld_because == "2 of at least 3 strides"
    assert found["step_length", "right"].withheld_because == "not observed in any stride that counts"
    assert found["step_length_ratio_larger_to_smaller", None].value is None
    assert found["strides_counted", "left"].value == 2


def test_turning_and_rejected_strides_are_only_counted(totals):
    bad = [{"turning": True}] * 2 + [{"valid": False, "rejected_because": "gap", "stride_time_s": 9.0}] * 3
    found = table(totals([{}] * 3 + bad, [{}] * 3))
    assert found["stride_time", None].value == pytest.approx(1.0)
    assert found["strides_counted", "left"].value == 3
    assert found["strides_turning", "left"].value == 2
    assert found["strides_rejected", "left"].value == 3


def test_what_a_stride_lacks_is_left_out_of_its_mean_only(totals):
    missing = {"toe_off_ns": None, "stance_fraction": None, "curves": {}}
    found = table(totals([{}] * 3 + [missing], [{}] * 3))
    assert found["stance_time", "left"].strides == 3
    assert found["knee_flexion_range", "left"].strides == 3
    assert found["knee_flexion_peak_swing", "left"].strides == 3
    assert found["stride_time", None].strides == 7


def test_ratio_is_larger_to_smaller_whichever_side(totals):
    long, short = {"step_length_m": 0.6}, {"step_length_m": 0.4}
    for left, right in ((long, short), (short, long)):
        found = table(totals([left] * 4, [right] * 4))["step_length_ratio_larger_to_smaller", None]
        assert found.value == pytest.approx(1.5)
        assert found.mean_std == pytest.approx(0.0)
        assert found.strides == 4


def test_ratio_has_the_error_of_both_sides(totals):
    left = [{"step_length_m": value} for value in (0.55, 0.6, 0.65)]
    right = [{"step_length_m": value} for value in (0.38, 0.40, 0.42)]
    found = table(totals(left, right))["step_length_ratio_larger_to_smaller", None]
    expected = 1.5 * math.hypot(0.05 / math.sqrt(3) / 0.6, 0.02 / math.sqrt(3) / 0.4)
    assert found.mean_std == pytest.approx(expected)


def test_a_ratio_with_a_step_backwards_is_withheld(totals):
    found = table(totals([{"step_length_m": -0.1}] * 3, [{}] * 3))["step_length_ratio_larger_to_smaller", None]
    assert found.value is None
    assert "not positive" in found.withheld_because


def test_variability_needs_ten_strides(totals):
    lengths = [{"step_length_m": 0.6 + 0.01 * k} for k in range(10)]
    found = table(totals(lengths, lengths[:9]))
    values = [0.6 + 0.01 * k for k in range(10)]
    assert found["step_length_sd", "left"].value == pytest.approx(np.std(values, ddof=1))
    assert found["step_length_cv", "left"].value == pytest.approx(np.std(values, ddof=1) / np.mean(values))
    assert found["step_length_sd", "right"].withheld_because == "9 of at least 10 strides"


def test_cv_about_zero_is_withheld(totals):
    found = table(totals([{"step_length_m": 0.0}] * 10, [{}] * 10))
    assert found["step_length_sd", "left"].value == 0.0
    assert found["step_length_cv", "left"].value is None


def test_mean_curves(totals):
    curves = {curve.degree_of_freedom: curve for curve in totals([{}] * 3, [{}] * 5).curves(PARAMETERS)}
    assert curves["knee_flexion_left"].strides == 3
    assert curves["knee_flexion_right"].strides == 5
    assert curves["pelvis_tilt"].strides == 5
    assert max(curves["knee_flexion_left"].mean) == pytest.approx(0.9)
    assert max(curves["knee_flexion_left"].spread) == pytest.approx(0.0)
    assert np.mean(curves["pelvis_rotation"].mean) == pytest.approx(0.0, abs=1e-6)
    assert totals([{}] * 2, []).curves(PARAMETERS) == []


HALF = {"step_length_m": 0.2, "stride_time_s": 1.4}
"""The half step beside the other foot that ends a walk."""


def test_starting_and_stopping_strides_are_left_out_and_counted(totals):
    walk = [{"step_length_m": 0.4}, *[{}] * 3, HALF]
    found = table(totals(walk, walk), PARAMETERS)
    for side in ("left", "right"):
        assert found["strides_counted", side].value == 3
        assert found["strides_starting_or_stopping", side].value == 2
        assert found["step_length", side].value == pytest.approx(0.6)
        assert found["step_length", side].spread == pytest.approx(0.0)
    assert found["stride_time", None].strides == 6


def test_all_strides_count_while_too_few_are_steady(totals):
    walk = [{"step_length_m": 0.4}, *[{}] * 2, HALF]
    found = table(totals(walk, [{}] * 9), PARAMETERS)
    assert found["strides_counted", "left"].value == 4
    assert found["strides_counted", "right"].value == 9
    assert found["strides_starting_or_stopping", "right"].value == 0
    assert found["step_length", "left"].value == pytest.approx((0.4 + 0.6 + 0.6 + 0.2) / 4)


def test_a_foot_that_is_not_seen_is_not_waited_for(totals):
    found = table(totals([{}] * 5, []), PARAMETERS)
    assert found["strides_counted", "left"].value == 3
    assert found["strides_starting_or_stopping", "right"].value == 0


def test_each_walk_of_a_session_has_its_ends(stride):
    totals = SessionTotals()
    for index in (0, 1, 2, 3, 7, 8, 9, 10, 11, 15):
        for side in Side:
            totals.add(stride(side, index))
    found = table(totals, PARAMETERS)
    # 1, 2 and 8, 9, 10 are between strides that they go on from; 15 is a walk of one stride.
    assert found["strides_counted", "left"].value == 5
    assert found["strides_starting_or_stopping", "left"].value == 5


def test_a_turn_within_a_walk_is_no_end_of_it(totals):
    walk = [{}, {}, {"turning": True}, {}, {}, {}]
    found = table(totals(walk, walk), PARAMETERS)
    assert found["strides_counted", "left"].value == 3
    assert found["strides_turning", "left"].value == 1
    assert found["strides_starting_or_stopping", "left"].value == 2


def test_a_walk_that_ends_in_a_rejected_stride_leaves_out_that_one_only(totals):
    walk = [*[{}] * 4, {"valid": False, "rejected_because": "gap"}]
    found = table(totals(walk, walk), PARAMETERS)
    assert found["strides_counted", "left"].value == 3
    assert found["strides_starting_or_stopping", "left"].value == 1


def test_reporting_changes_nothing(totals):
    built = totals([{}] * 6, [HALF] * 6)
    before = built.snapshot()
    assert built.metrics(PARAMETERS) == built.metrics(PARAMETERS)
    built.curves(PARAMETERS)
    assert built.snapshot() == before


def test_curves_of_the_whole_body(stride):
    """What only that model has: the trunk's, over the right foot's strides, and an arm's, over its own side's."""
    totals = SessionTotals()
    line = StrideCurve(position=np.linspace(0.0, 0.2, 101).tolist(), position_std=0.05)
    for index in range(5):
        for side in Side:
            totals.add(stride(side, index, curves={"trunk_flexion": line, "shoulder_flexion_left": line}))
    curves = {curve.degree_of_freedom: curve for curve in totals.curves(ALL_COUNT)}
    assert set(curves) == {"trunk_flexion", "shoulder_flexion_left"}
    assert curves["trunk_flexion"].mean == pytest.approx(line.position, abs=1e-6)


def test_ratios_are_of_the_paretic_side_where_one_is_declared(stride):
    for paretic, expected in ((Side.LEFT, 0.5), (Side.RIGHT, 2.0)):
        totals = SessionTotals(paretic)
        for index in range(4):
            totals.add(stride(Side.LEFT, index, step_length_m=0.3))
            totals.add(stride(Side.RIGHT, index, step_length_m=0.6))
        found = table(totals)
        assert found["step_length_ratio_paretic_to_non_paretic", None].value == pytest.approx(expected)
        assert ("step_length_ratio_larger_to_smaller", None) not in found
        assert [side.reference_side for side in totals.sides(PARAMETERS)] == [paretic.other] * 4
        # (0.6 - 0.3) / 0.45, ln of the ratio, (45 deg - arctan 0.5) / 90 deg.
        assert found["step_length_symmetry_index", None].value == pytest.approx(2 / 3)
        assert found["step_length_gait_asymmetry", None].value == pytest.approx(math.log(expected))
        assert found["step_length_symmetry_angle", None].value == pytest.approx(0.2048, abs=1e-4)


def test_supports_from_both_feet(stride):
    """The other foot lifts 0.1 s after this one's contact and comes down at 0.5 s; this one lifts at 0.6 s."""
    totals = SessionTotals()
    for index in range(4):
        for side in Side:
            start = stride(side, index).start_ns
            totals.add(stride(side, index, opposite_toe_off_ns=start + 100_000_000))
    found = table(totals)
    for side in ("left", "right"):
        assert found["initial_double_support_fraction", side].value == pytest.approx(0.1)
        assert found["terminal_double_support_time", side].value == pytest.approx(0.1)
        assert found["single_support_fraction", side].value == pytest.approx(0.4)
    assert found["double_support_time", None].value == pytest.approx(0.2)


def test_the_interval_holds_what_all_strides_share(stride, description):
    alone, together = SessionTotals(), SessionTotals(shared=SharedErrors(description, PARAMETERS.shared))
    for totals in (alone, together):
        for index in range(6):
            for side in Side:
                totals.add(stride(side, index))
    narrow, wide = table(alone)["walking_speed", None], table(together)["walking_speed", None]
    assert (narrow.low, narrow.high) == pytest.approx((1.2, 1.2))
    # A body measured to 3 %: 1.2 m/s +- 7 % at least.
    assert wide.high - 1.2 == pytest.approx(1.2 - wide.low)
    assert wide.high - 1.2 > 1.96 * 0.03 * 1.2
