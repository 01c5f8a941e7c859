"""Distances of learned rhythms in the final metrics: their sides, their kinds, and why there is none."""

import json

import numpy as np
import pytest

from schemas.rhythm import KnownRhythm, LearnedJoint, LearnedRhythm
from schemas.signals import LEARNED_RHYTHM, STRIDE
from schemas.vocabulary import Side
from services.definitions.rhythm import RHYTHMS
from services.flow.message import Envelope, Message, Stream
from services.metrics.node import build
from services.metrics.rhythms import rhythm_metrics

ORDER = np.arange(1, 6)


def joint(name: str, seed: int, shift: float = 0.0, scale: float = 1.0, spread: float = 0.01) -> LearnedJoint:
    """q(W + shift) = scale times what the seed draws."""
    rng = np.random.default_rng(seed)
    drawn = (rng.standard_normal(5) + 1j * rng.standard_normal(5)) * 0.3 / ORDER
    z = scale * drawn * np.exp(-1j * ORDER * shift)
    return LearnedJoint(
        degree_of_freedom=name, cosine=z.real.tolist(), sine=(-z.imag).tolist(), spread=[spread] * len(ORDER)
    )


def rhythm(late: float = 0.0, scale: float = 1.0, joints=("knee_flexion", "hip_flexion"), strides=8) -> LearnedRhythm:
    """Equal legs half a stride apart, the right one `late` rad later and its amplitudes scaled."""
    learned = [joint(f"{name}_left", seed) for seed, name in enumerate(joints)]
    learned += [joint(f"{name}_right", seed, np.pi + late, scale) for seed, name in enumerate(joints)]
    return LearnedRhythm(
        captured_ns=9, frequency=6.0, frequency_spread=0.1, strides=strides, quality=0.9, joints=learned
    )


def table(metrics):
    return {(metric.name, metric.side): metric for metric in metrics}


def message(payload: LearnedRhythm, sequence: int = 0) -> Message:
    return Message(Stream(LEARNED_RHYTHM, "estimation"), Envelope(0, sequence, payload.captured_ns), payload)


def test_equal_legs_half_a_stride_apart_are_symmetric():
    found = table(rhythm_metrics(rhythm(), [], final=True))
    assert found["rhythm_side_distance", None].value == pytest.approx(0.0, abs=1e-9)
    assert found["rhythm_side_shape", None].value == pytest.approx(0.0, abs=1e-6)
    assert found["rhythm_side_timing", None].value == pytest.approx(0.0, abs=1e-9)
    assert len(found) == 3


@pytest.mark.parametrize("late", [-0.5, 0.3])
def test_a_late_right_leg_shows_as_timing_and_not_as_distance(late):
    found = table(rhythm_metrics(rhythm(late), [], final=True))
    assert found["rhythm_side_timing", None].value == pytest.approx(late / (2.0 * np.pi))
    assert found["rhythm_side_distance", None].value == pytest.approx(0.0, abs=1e-9)


def test_a_smaller_leg_shows_as_distance_and_not_as_shape():
    values = [
        table(rhythm_metrics(rhythm(scale=scale), [], final=True))["rhythm_side_distance", None].value
        for scale in (1.0, 0.9, 0.7, 0.4)
    ]
    assert values == sorted(values)
    assert values[-1] > 0.1
    found = table(rhythm_metrics(rhythm(scale=0.4), [], final=True))
    assert found["rhythm_side_shape", None].value == pytest.approx(0.0, abs=1e-6)


def test_each_leg_is_compared_with_every_kind_that_is_known():
    known = [
        KnownRhythm(name="a", kind="previous visit", rhythm=rhythm(late=1.0, scale=0.5, strides=4)),
        KnownRhythm(name="b", kind="exemplar", rhythm=rhythm()),
    ]
    found = table(rhythm_metrics(rhythm(), known, final=True))
    left, right = (found["rhythm_distance_previous_visit", side] for side in ("left", "right"))
    assert left.value == pytest.approx(0.0, abs=1e-9)
    assert right.value > 0.08
    assert right.strides == 4
    assert found["rhythm_distance_exemplar", "right"].value == pytest.approx(0.0, abs=1e-9)
    assert {name for name, _ in found} == {d.name for d in RHYTHMS if "trial" not in d.name}


def test_spread_and_error_come_from_the_scatter_of_the_strides():
    metric = table(rhythm_metrics(rhythm(strides=4), [], final=True))["rhythm_side_distance", None]
    # 5 harmonics of spread 0.01: a stride is sqrt(5) 0.01 from its mean; a mean of 4 half of that, two means sqrt(2).
    assert metric.spread == pytest.approx(0.01 * np.sqrt(5.0))
    assert metric.mean_std == pytest.approx(0.01 * np.sqrt(5.0) / 2.0 * np.sqrt(2.0))


@pytest.mark.parametrize("kept", [["knee_flexion_left"], ["knee_flexion_left", "hip_flexion_right"]])
def test_withheld_where_no_joint_is_shared(kept):
    whole = rhythm()
    part = whole.model_copy(update={"joints": [j for j in whole.joints if j.degree_of_freedom in kept]})
    known = [KnownRhythm(name="a", kind="previous trial", rhythm=whole)]
    found = table(rhythm_metrics(part, known, final=True))
    assert found["rhythm_side_distance", None].withheld_because == "no joint was learned on both sides"
    assert found["rhythm_distance_previous_trial", "left"].value is not None
    right = found["rhythm_distance_previous_trial", "right"]
    assert (right.value is None) == (len(kept) == 1)


@pytest.mark.parametrize(("final", "because"), [(False, "at the end"), (True, "3 whole strides")])
def test_withheld_without_a_learned_rhythm(final, because):
    known = [KnownRhythm(name="a", kind="exemplar", rhythm=rhythm())]
    metrics = rhythm_metrics(None, known, final=final)
    assert len(metrics) == 3 + 4
    assert all(metric.value is None and because in metric.withheld_because for metric in metrics)


def test_the_order_in_which_the_streams_come_changes_nothing(stride, description):
    strides = [
        Message(Stream(STRIDE, "segmentation"), Envelope(0, i, made.end_ns), made)
        for i, made in enumerate(stride(side, index) for index in range(5) for side in Side)
    ]
    learned = [message(rhythm(strides=3)), message(rhythm(late=0.2, strides=7), 1)]

    def run(messages):
        node = build(description)
        outputs = [output for each in messages for output in node.step(each)] + node.finish()
        return [output.payload.model_dump_json() for output in outputs]

    first = run(strides + learned)
    assert run(learned + strides) == first
    assert run([*strides[:3], learned[0], *strides[3:], learned[1]]) == first
    assert '"name":"rhythm_side_timing","side":null,"unit":"1","value":0.03' in first[-1]


def test_what_was_learned_survives_a_resume(description):
    first, second = build(description), build(description)
    first.step(message(rhythm(late=0.2)))
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert [out.payload for out in second.finish()] == [out.payload for out in first.finish()]
