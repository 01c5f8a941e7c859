"""What marching on the spot amounts to."""

import json

import pytest

from schemas.vocabulary import Side
from services.definitions.marching import MARCHING
from services.metrics.marching import MarchingTotals
from services.metrics.parameters import MetricsParameters
from tests.unit.metrics.conftest import made


def marched(*cycle_s: float, side: Side = Side.LEFT) -> list:
    """Cycles of one foot, one after the other."""
    found, at_ns = [], 10**9
    for index, lasts in enumerate(cycle_s):
        end_ns = at_ns + round(lasts * 1e9)
        found.append(made(side, index, start_ns=at_ns, end_ns=end_ns, stride_time_s=lasts))
        at_ns = end_ns
    return found


def metrics_of(strides: list) -> dict:
    totals = MarchingTotals()
    for stride in strides:
        totals.add(stride)
    return {(metric.name, metric.side): metric for metric in totals.metrics(MetricsParameters())}


def test_lifts_times_and_cadence_but_neither_length_nor_speed() -> None:
    found = metrics_of(marched(*[1.0] * 12))
    assert {name for name, _ in found} <= {definition.name for definition in MARCHING}
    assert found["marching_cadence", None].value == pytest.approx(120.0)
    assert found["marching_hip_flexion_range", "left"].value == pytest.approx(0.4, abs=1e-3)
    assert found["marching_knee_flexion_range", "left"].value == pytest.approx(0.8, abs=1e-3)
    assert not any("length" in name or "speed" in name for name, _ in found)


def test_a_tempo_that_drifts_is_no_irregularity() -> None:
    drifting = metrics_of(marched(*(1.0 + 0.01 * k for k in range(30))))
    uneven = metrics_of(marched(*(1.0 + 0.05 * (-1) ** k for k in range(30))))
    assert drifting["marching_stride_time_cv", None].value > 0.05
    assert drifting["marching_rhythm_cv", None].value == pytest.approx(0.01 / 2**0.5 / 1.15, rel=0.02)
    assert uneven["marching_rhythm_cv", None].value == pytest.approx(0.1 / 2**0.5, rel=0.02)


def test_a_pause_is_no_irregularity_either() -> None:
    first, second = marched(*[1.0] * 8), marched(*[1.0] * 8)
    later = [
        each.model_copy(update={"start_ns": each.start_ns + 10**11, "end_ns": each.end_ns + 10**11}) for each in second
    ]
    assert metrics_of(first + later)["marching_rhythm_cv", None].value == pytest.approx(0.0, abs=1e-9)


def test_a_few_cycles_are_no_rhythm() -> None:
    assert metrics_of(marched(*[1.0] * 6))["marching_rhythm_cv", None].value is None


def test_split_and_resume() -> None:
    strides = marched(*(1.0 + 0.03 * (k % 3) for k in range(20)))
    totals, resumed = MarchingTotals(), MarchingTotals()
    for stride in strides[:9]:
        totals.add(stride)
    resumed.restore(json.loads(json.dumps(totals.snapshot())))
    for stride in strides[9:]:
        totals.add(stride)
        resumed.add(stride)
    assert resumed.metrics(MetricsParameters()) == totals.metrics(MetricsParameters())
