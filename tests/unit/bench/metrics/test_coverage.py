"""Coverage of intervals: what counts, and that the truth is how the footfalls were planned."""

import itertools

import numpy as np
import pytest

from schemas.vocabulary import Side
from services.bench.metrics.coverage_scores import Family, family_of, score
from services.bench.metrics.coverage_truth import true_strides
from services.definitions.table import BY_NAME
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.patients.walk import PatientWalk
from services.metrics import summary
from services.metrics.intervals import Interval


def metric(name: str, value: float, half: float, side: str | None = None):
    interval = Interval(value - half, value + half)
    return summary.shown(BY_NAME[name], side, value, None, half / 4, 10, interval)


def test_a_truth_within_the_interval_counts_and_the_naive_one_is_scored_beside():
    families: dict[str, Family] = {}
    truth = {("walking_speed", None): 1.0, ("stride_length", None): 1.2, ("cadence", None): 100.0}
    told = [metric("walking_speed", 1.05, 0.08), metric("stride_length", 1.3, 0.05), metric("cadence", 101.0, 8.0)]
    score(told, truth, families)
    lengths = families["lengths and speed"]
    assert lengths.within == [True, False]
    assert lengths.coverage == 50.0
    # 0.02 m/s of standard error: 1.05 +- 0.039 does not reach 1.0.
    assert lengths.within_naive == [False, False]
    assert lengths.widths[0] == pytest.approx(0.16)
    assert families["stride and step times"].coverage_naive == 100.0


def test_what_is_withheld_is_counted_apart():
    families: dict[str, Family] = {}
    score([summary.withheld(BY_NAME["walking_speed"], None, 0, "too few")], {("walking_speed", None): 1.0}, families)
    assert (families["lengths and speed"].within, families["lengths and speed"].withheld) == ([], 1)


def test_families_leave_out_counts_and_what_says_the_same_again():
    assert family_of("strides_counted") is None
    assert family_of("step_length_symmetry_index") is None
    assert family_of("step_length_ratio_paretic_to_non_paretic") == "symmetry ratios"
    assert family_of("step_length_cv") == "variability"
    assert family_of("hip_rotation_range") == "hip angles"


def test_true_strides_are_those_of_the_plan():
    walk = PatientWalk(WalkParameters.parse("patient=hemiparetic&speed=0.8&seed=9&duration=20"))
    strides = true_strides(walk)
    for side in Side:
        own = [stride for stride in strides if stride.side is side]
        assert len(own) >= 4
        assert all(first.end_ns == second.start_ns for first, second in itertools.pairwise(own))
    # Two steps make a stride, both feet's supports make the whole of it.
    for first, second in itertools.pairwise(strides):
        assert first.side is second.side.other
        assert second.stride_length_m == pytest.approx(first.step_length_m + second.step_length_m)
    speeds = [stride.walking_speed for stride in strides]
    assert np.mean(speeds) == pytest.approx(0.8, rel=0.1)
    assert all(stride.start_ns < stride.opposite_toe_off_ns < stride.opposite_contact_ns for stride in strides)
