"""Reasons against a number: each from its own inputs, the gravest first, withheld below the bar."""

import pytest

from schemas.metrics import DoubtKind, TrustGrade
from schemas.quality import DataQuality, SourceQuality
from schemas.vocabulary import Side
from services.definitions.table import BY_NAME
from services.metrics import summary
from services.metrics.intervals import Interval
from services.metrics.parameters import RULES
from services.metrics.trust import Trust, ruled

GOOD, FAIR, POOR, WITHHELD = TrustGrade.GOOD, TrustGrade.FAIR, TrustGrade.POOR, TrustGrade.WITHHELD
SENSORS = ("pelvis", "thigh_left", "thigh_right", "shank_left", "shank_right")


def quality(changes: dict[str, dict] | None = None, **fields) -> DataQuality:
    """A minute in which everything was well, but for the named sensors' changes."""
    well = {"expected": 6000, "used": 6000, "rejected": 0, "longest_silence_s": 0.01, "misplaced": False}
    whole = {
        "captured_ns": 60_000_000_000,
        "calibrated": True,
        "absolute": True,
        "spanned_s": 58.0,
        "estimated_s": 58.0,
        "moving_s": 50.0,
        "locked_s": 45.0,
        "late": 0,
    }
    sources = [SourceQuality(name=name, **(well | (changes or {}).get(name, {}))) for name in SENSORS]
    return DataQuality(sources=sources, **(whole | fields))


@pytest.fixture
def judge(description):
    names = {s.segment.value: s.name for hub in description.hubs for s in hub.sensors}
    trust = Trust(description)

    def judged(name: str, side: str | None = None, value: float = 1.0, strides: int = 40, width: float = 0.0, **told):
        known = told.pop("quality", quality())
        known = known.model_copy(
            update={"sources": [each.model_copy(update={"name": names[each.name]}) for each in known.sources]}
        )
        interval = Interval(value - width, value + width)
        metric = summary.shown(BY_NAME[name], side, value, 0.1, 0.02, strides, interval)
        [found] = trust.judged([metric], known, told.get("rejected", {}))
        return found

    return judged


def kinds(metric) -> list[DoubtKind]:
    return [doubt.kind for doubt in metric.doubts]


def test_without_a_reason_a_number_is_good(judge):
    for name, side in (("walking_speed", None), ("knee_flexion_range", "left"), ("stance_fraction", "right")):
        found = judge(name, side)
        assert (found.grade, found.doubts, found.value) == (GOOD, [], 1.0)


def test_a_lost_shank_speaks_against_its_own_leg_alone(judge):
    """The left shank is silent from 50 s on: 60 % of its samples are gone."""
    lost = quality({"shank_left": {"used": 2400, "longest_silence_s": 36.0}}, estimated_s=22.0)
    left = judge("knee_flexion_range", "left", quality=lost)
    assert (left.grade, left.value, left.low, left.mean_std) == (WITHHELD, None, None, None)
    assert kinds(left)[0] is DoubtKind.LOSS
    assert left.withheld_because.startswith("60% of the samples of ")
    assert judge("knee_flexion_range", "right", quality=lost).grade is GOOD
    assert judge("stance_fraction", "right", quality=lost).grade is GOOD
    assert judge("stance_fraction", "left", quality=lost).grade is WITHHELD
    # Either foot tells the cadence; a ratio needs both, and a step's length every joint between the feet.
    assert judge("cadence", value=110.0, quality=lost).grade is GOOD
    assert judge("stance_time_ratio_larger_to_smaller", quality=lost).grade is WITHHELD
    assert judge("step_length", "right", quality=lost).grade is WITHHELD
    assert judge("pelvis_tilt_range", quality=lost).grade is GOOD


@pytest.mark.parametrize(("used", "grade"), [(5990, GOOD), (5700, FAIR), (5000, POOR), (2900, WITHHELD)])
def test_the_more_is_lost_the_less_a_number_is_worth(judge, used, grade):
    assert judge("knee_flexion_range", "left", quality=quality({"thigh_left": {"used": used}})).grade is grade


def test_the_gravest_reason_comes_first(judge):
    known = quality({"thigh_left": {"used": 5700}, "shank_left": {"used": 5000}})
    found = judge("knee_flexion_range", "left", strides=4, quality=known)
    assert found.grade is POOR
    assert kinds(found) == [DoubtKind.LOSS, DoubtKind.FEW_CYCLES, DoubtKind.LOSS]
    assert found.doubts[0].limit == RULES[DoubtKind.LOSS].poor


def test_few_strides_and_rejected_ones(judge):
    assert kinds(judge("step_time", "left", strides=5)) == [DoubtKind.FEW_CYCLES]
    # Ten strides of both feet are five of each.
    assert kinds(judge("cadence", value=100.0, strides=10)) == [DoubtKind.FEW_CYCLES]
    half = judge("step_time", "left", rejected={"left": 0.6})
    assert (half.grade, kinds(half)) == (POOR, [DoubtKind.REJECTED_CYCLES])
    most = judge("step_time", "left", rejected={"left": 0.9})
    assert most.withheld_because == "90% of the strides of the left foot were rejected; at most 80%"


def test_levels_need_a_zero_and_ranges_do_not(judge):
    for known, kind in (
        (quality(calibrated=False, absolute=False), DoubtKind.NOT_CALIBRATED),
        (quality(absolute=False), DoubtKind.NOT_ABSOLUTE),
    ):
        level = judge("knee_flexion_peak_swing", "left", quality=known)
        assert (level.grade, kinds(level)) == (POOR, [kind])
        assert judge("knee_flexion_range", "left", quality=known).grade is GOOD
        assert judge("cadence", value=110.0, quality=known).grade is GOOD


def test_a_misplaced_sensor_withholds_its_leg(judge):
    known = quality({"thigh_right": {"misplaced": True}})
    found = judge("hip_flexion_range", "right", quality=known)
    assert found.withheld_because.endswith("is worn otherwise than declared")
    assert judge("hip_flexion_range", "left", quality=known).grade is GOOD


def test_coverage_speaks_against_what_needs_every_joint(judge):
    assert judge("step_length", "left", quality=quality(estimated_s=10.0)).grade is WITHHELD
    assert judge("stance_time", "left", quality=quality(estimated_s=10.0)).grade is GOOD


def test_an_interval_wider_than_what_one_would_want_to_see(judge):
    """0.05 m/s is a small change of speed."""
    assert judge("walking_speed", width=0.04).grade is GOOD
    assert judge("walking_speed", width=0.07).grade is FAIR
    assert judge("walking_speed", width=0.2).grade is POOR


def test_weak_measures_and_unlikely_values_are_flagged(judge):
    assert kinds(judge("double_support_fraction", value=0.25)) == [DoubtKind.WEAK_MEASURE]
    assert judge("double_support_fraction", value=0.25).grade is POOR
    slow = judge("walking_speed", value=0.05)
    assert (slow.grade, kinds(slow)) == (POOR, [DoubtKind.IMPLAUSIBLE])
    assert (slow.doubts[0].value, slow.doubts[0].limit) == (0.05, 0.10)
    assert judge("cadence", value=180.0).doubts[0].limit == 157.0


def test_a_rhythm_that_was_seldom_locked(judge):
    assert kinds(judge("rhythm_side_timing", quality=quality(locked_s=20.0))) == [DoubtKind.NOT_LOCKED]
    assert judge("walking_speed", quality=quality(locked_s=20.0)).grade is GOOD


def test_a_walk_shorter_than_the_filter_takes_to_settle(judge):
    short = quality(moving_s=9.0, locked_s=8.0)
    assert kinds(judge("knee_flexion_range", "left", quality=short)) == [DoubtKind.WARM_UP]
    assert judge("cadence", value=110.0, quality=short).grade is GOOD


def test_what_no_sensor_on_the_body_sees_says_so(description):
    metric = summary.withheld(BY_NAME["step_width"], None, 0, "not observed in any stride that counts")
    [found] = Trust(description).judged([metric], None, {})
    assert found.withheld_because == "not observable from sensors on the body"
    assert kinds(found) == [DoubtKind.NOT_OBSERVED]


def test_numbers_of_strides_are_what_they_are(judge):
    assert judge("strides_counted", "left", strides=0).grade is GOOD


def test_every_rule_names_its_source_and_grades_get_worse():
    for kind, rule in RULES.items():
        assert rule.source
        limits = [limit for limit in (rule.fair, rule.poor, rule.withheld) if limit is not None]
        assert limits == sorted(limits, reverse=rule.below), kind
        beyond = limits[-1] - 1e-9 if rule.below else limits[-1] + 1e-9
        assert ruled(kind, beyond)


def test_sides_are_named_in_doubts(judge):
    assert judge("step_time", Side.LEFT.value, strides=5).doubts[0].subject == "left"
