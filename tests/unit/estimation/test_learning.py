"""A session's learned rhythm: sent when there is enough, right in angles, and a start for the next session."""

import json
from functools import cache

import numpy as np
import pytest

from schemas.rhythm import KnownRhythm, LearnedRhythm
from schemas.session import SessionDescription
from services.biomech.rhythm.reading import RhythmReading
from services.estimation.learning import RHYTHM_CHANNELS, RhythmLearning
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.rows import Row
from tests.unit.estimation import estimation_walks as walks

SECONDS = 12.0


@cache
def samples(seed: int) -> walks.Array:
    return walks.walk(SECONDS, seed=seed)[1]


def session(*known: KnownRhythm) -> SessionDescription:
    return walks.describe(estimator="rhythmic_ekf").model_copy(update={"known_rhythms": list(known)})


@cache
def cold() -> tuple:
    return tuple(walks.run(LowerBodyNode(session()), walks.messages(session(), samples(0))))


def learned(outputs) -> list[LearnedRhythm]:
    return [output.payload for output in outputs if isinstance(output.payload, LearnedRhythm)]


def known(kind: str) -> KnownRhythm:
    return KnownRhythm(name="before", kind=kind, rhythm=learned(cold())[-1])


def stream(ticks: int = 1) -> list:
    return walks.messages(session(), samples(1), ticks=ticks)


def run(description: SessionDescription) -> list:
    return walks.run(LowerBodyNode(description), stream())


SPLITS = (200, 330, 450, 900)


@cache
def warm() -> tuple:
    """What a session says that knows the previous trial, and what was kept of it at the splits."""
    return walks.run_and_freeze(LowerBodyNode(session(known("previous trial"))), stream(), SPLITS)


def first_lock_s(outputs) -> float:
    """s of walking until the rhythm is locked; a stride lasts one second."""
    rhythms = walks.rhythms(outputs)
    times = [t for each in rhythms for t, is_locked in zip(each.captured_ns, each.locked, strict=True) if is_locked]
    return min(times) / 1e9 - walks.STANDING_S


def test_the_last_message_says_what_was_learned_of_all_four_joints():
    rhythm = learned(cold())[-1]
    assert [joint.degree_of_freedom for joint in rhythm.joints] == list(RHYTHM_CHANNELS)
    assert rhythm.frequency == pytest.approx(2.0 * np.pi, rel=0.01)
    assert rhythm.strides >= 4
    assert rhythm.quality > 0.8
    for joint in rhythm.joints:
        size = np.hypot(joint.cosine, joint.sine)
        expected = [0.42, 0.18] if "knee" in joint.degree_of_freedom else [0.4, 0.0]
        assert size[:2] == pytest.approx(expected, abs=0.03)
        assert size[2:].max() < 0.03


def test_a_previous_trial_gives_a_lock_within_one_stride():
    assert first_lock_s(cold()) > 1.5
    outputs, _ = warm()
    assert first_lock_s(outputs) < 1.1
    assert learned(outputs)[-1].strides > learned(cold())[-1].strides


def test_the_phase_reference_is_that_of_the_previous_trial():
    now, before = learned(run(session(known("previous visit"))))[-1], learned(cold())[-1]
    for ours, theirs in zip(now.joints, before.joints, strict=True):
        assert ours.cosine[:2] == pytest.approx(theirs.cosine[:2], abs=0.03)
        assert ours.sine[:2] == pytest.approx(theirs.sine[:2], abs=0.03)


def test_an_exemplar_or_half_a_rhythm_starts_nothing():
    whole = known("previous trial")
    half = whole.rhythm.model_copy(update={"joints": whole.rhythm.joints[:2]})
    expected = walks.text(run(session()))
    assert walks.text(run(session(known("exemplar")))) == expected
    assert walks.text(run(session(whole.model_copy(update={"rhythm": half})))) == expected


@pytest.mark.parametrize("split", SPLITS)
def test_split_and_resume_with_a_known_rhythm_is_identical(split):
    outputs, kept = warm()
    resumed = LowerBodyNode(session(known("previous trial")))
    resumed.restore(json.loads(kept[split].state))
    assert walks.text(walks.run(resumed, stream()[split:])) == walks.text(outputs[kept[split].outputs :])


def test_batches_and_the_order_of_hubs_change_nothing_that_is_learned():
    expected = learned(warm()[0])
    description = session(known("previous trial"))
    batched = walks.run(LowerBodyNode(description), stream(ticks=5))
    assert learned(batched) == expected
    hubs = walks.describe(estimator="rhythmic_ekf", hubs=(walks.SEGMENTS[:3], walks.SEGMENTS[3:]))
    hubs = hubs.model_copy(update={"known_rhythms": description.known_rhythms})
    in_turn = walks.messages(hubs, samples(1))
    turned = sorted(in_turn, key=lambda m: (m.envelope.captured_ns, -int(m.stream.source[-1])))
    assert learned(walks.run(LowerBodyNode(hubs), turned)) == learned(walks.run(LowerBodyNode(hubs), in_turn))


def rows(strides: float, *, start: float = 0.0, locked: bool = True):
    """Rows at 100 Hz of a stride a second, every joint 0.5 cos of the phase."""
    for number in range(round(100 * strides)):
        phase = start + 2.0 * np.pi * number / 100
        velocity = [-0.5 * 2.0 * np.pi * float(np.sin(phase))] * 15
        reading = RhythmReading(phase, 2.0 * np.pi, 0.9, locked, np.zeros(4))
        captured_ns = round((start / (2.0 * np.pi) + number / 100) * 1e9)
        yield Row(captured_ns, [0.0] * 15, velocity, [0.0] * 15, [0.0] * 15, [0.0] * 15, reading)


SEEN = [True] * 15


def test_a_report_comes_when_a_bout_ends_and_once():
    learning = RhythmLearning()
    assert [learning.take(row, SEEN) for row in rows(7.5, start=0.1)] == [None] * 750
    [report] = [learning.take(row, SEEN) for row in rows(0.01, start=7.6 * 2.0 * np.pi, locked=False)]
    assert report.strides == 5
    assert report.joints[0].cosine[0] == pytest.approx(0.5, abs=0.01)
    assert learning.report() is None


def test_too_few_strides_are_not_reported():
    learning = RhythmLearning()
    for row in rows(4.5, start=0.1):
        learning.take(row, SEEN)
    assert learning.report() is None


def test_strides_in_which_a_joint_is_lost_do_not_count_and_joints_never_seen_are_left_out():
    learning = RhythmLearning()
    names = [dof.name for dof in walks.LOWER_BODY]
    seen = [name != "hip_flexion_left" for name in names]
    for number, row in enumerate(rows(9.5, start=0.1)):
        learning.take(row, [is_seen and not 300 < number < 310 for is_seen in seen])
    report = learning.report()
    assert [joint.degree_of_freedom for joint in report.joints] == [
        n for n in RHYTHM_CHANNELS if n != "hip_flexion_left"
    ]
    # 8 whole ones but the last; the third and the one before it, which it would have confirmed, fell out.
    assert report.strides == 5
