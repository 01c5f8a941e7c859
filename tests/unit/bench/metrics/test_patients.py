"""How walks of known truth are judged."""

import numpy as np
import pytest

from schemas.gait import Stride
from schemas.vocabulary import Side
from services.bench.metrics.patients import RATIOS, errors_of, rows_of
from services.bench.metrics.walked import TrueStride, Walked, _paired, true_strides
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.patients.walk import PatientWalk

SECOND = 1_000_000_000


def told(side: Side, start_s: float, **changes: object) -> Stride:
    fields = {
        "side": side, "index": 0, "start_ns": round(start_s * SECOND), "end_ns": round((start_s + 1.0) * SECOND),
        "toe_off_ns": round((start_s + 0.6) * SECOND), "opposite_contact_ns": round((start_s + 0.5) * SECOND),
        "opposite_toe_off_ns": round((start_s + 0.1) * SECOND), "stride_time_s": 1.0, "stance_fraction": 0.6,
        "step_time_s": 0.5, "step_length_m": 0.5, "step_length_std_m": 0.01, "stride_length_m": 1.0,
        "walking_speed": 1.0, "step_width_m": None, "circumduction_m": 0.02, "turn": 0.0, "phase_advance": None,
        "turning": False, "valid": True, "rejected_because": None, "curves": {},
    }  # fmt: skip
    return Stride.model_validate({**fields, **changes})


def truth(side: Side, start_s: float, **changes: float) -> TrueStride:
    return TrueStride(side, start_s, start_s + 1.0, 0.6, 0.5, 1.0, 0.1, 0.02)._replace(**changes)


def walk_of(pairs: list[tuple[Stride, TrueStride]]) -> Walked:
    return Walked("hemiparetic", 1.0, Side.LEFT, pairs, len(pairs), 0)


def test_what_is_told_right_has_no_error():
    pairs = [(told(side, at), truth(side, at)) for at in (1.0, 2.0) for side in Side]
    errors = errors_of(walk_of(pairs))
    assert (errors.speed, errors.cadence, errors.found, errors.invented) == (0.0, 0.0, 100.0, 0)
    assert [*errors.steps, *errors.stances, *errors.supports, *errors.circumduction] == pytest.approx([0.0] * 10)
    assert errors.ratios == dict.fromkeys(RATIOS, 0.0)


def test_errors_have_the_sign_of_found_minus_true():
    left = (
        told(Side.LEFT, 1.0, stance_fraction=0.64, step_length_m=0.55, walking_speed=1.1, stride_time_s=0.98),
        truth(Side.LEFT, 1.0),
    )
    errors = errors_of(walk_of([left, (told(Side.RIGHT, 1.5), truth(Side.RIGHT, 1.5))]))
    assert errors.speed == pytest.approx(0.05)
    assert errors.steps == pytest.approx([0.05, 0.0])
    assert errors.cadence == pytest.approx(100 * (1.0 / 0.99 - 1.0))
    assert errors.stances == pytest.approx([4.0, 0.0])
    assert errors.ratios["step length"] == pytest.approx(0.1)
    assert errors.ratios["stance time"] == pytest.approx(0.98 * 0.64 / 0.6 - 1.0)
    assert errors.ratios["swing time"] == pytest.approx(0.98 * 0.36 / 0.4 - 1.0)


def test_rows_hold_the_mean_absolute_error_the_offset_and_the_worst():
    walks = [errors_of(walk_of([(told(s, 1.0, walking_speed=v), truth(s, 1.0)) for s in Side])) for v in (1.02, 0.9)]
    rows = {row.name: row for row in rows_of("some", walks, walks)}
    assert rows["some: walking speed, mean absolute error"].value == pytest.approx(0.06)
    assert rows["some: walking speed, mean absolute error"].met is False
    assert rows["some: walking speed, offset"].value == pytest.approx(-0.04)
    assert rows["some: walking speed, worst"].value == pytest.approx(0.1)
    assert rows["some: cadence, mean absolute error"].met is True


def test_a_walk_in_which_a_leg_was_not_seen_has_no_ratio():
    errors = errors_of(walk_of([(told(Side.LEFT, 1.0), truth(Side.LEFT, 1.0))]))
    assert errors.found == 0.0
    assert np.isnan(errors.ratios["stance time"])


def test_the_truth_of_strides_is_the_plan():
    walk = PatientWalk(WalkParameters.parse("patient=stiff_knee&speed=0.7&seed=31&duration=24"))
    strides = true_strides(walk)
    assert len(strides) >= 8
    speed = sum(one.stride_length_m for one in strides) / sum(one.time_s for one in strides)
    assert speed == pytest.approx(0.7, rel=0.06)
    stiff = [one.circumduction_m for one in strides if one.side is walk.affected]
    other = [one.circumduction_m for one in strides if one.side is not walk.affected]
    assert np.mean(stiff) > np.mean(other) + 0.03
    for one in strides:
        assert 0.5 < one.stance_fraction < 0.8
        assert 0.0 < one.first_double_support < 0.3


def test_a_stride_is_true_when_both_of_its_contacts_are():
    true = [truth(Side.LEFT, 1.0), truth(Side.LEFT, 2.0)]
    right, elsewhere, long = told(Side.LEFT, 2.05), told(Side.RIGHT, 2.0), told(Side.LEFT, 1.0, end_ns=3 * SECOND)
    assert _paired([right, elsewhere, long], true) == [(right, true[1])]
