import json
import random

import pytest

from schemas.kinematics import JointCentres, JointState, SegmentMotion
from schemas.rhythm import Rhythm
from services.segmentation.pairing import Pairing


def joints(*captured_ns: int) -> JointState:
    return JointState.model_construct(model="lower_body", captured_ns=list(captured_ns))


def rhythm(*captured_ns: int) -> Rhythm:
    return Rhythm.model_construct(captured_ns=list(captured_ns))


def fed(pairing: Pairing, messages) -> list[tuple[list[int], bool]]:
    pairs = []
    for message in messages:
        add = pairing.add_joints if isinstance(message, JointState) else pairing.add_rhythm
        pairs += add(message)
    pairs += pairing.flush()
    return [(j.captured_ns, r is not None and r.captured_ns == j.captured_ns) for j, r, *_ in pairs]


def shuffled(first: list, second: list, seed: int) -> list:
    """Both lists in their own order, interleaved at random."""
    rng = random.Random(seed)
    first, second, merged = list(first), list(second), []
    while first or second:
        source = first if not second or (first and rng.random() < 0.5) else second
        merged.append(source.pop(0))
    return merged


JOINTS = [joints(0, 1), joints(2, 3), joints(4, 5), joints(6, 7), joints(9)]
RHYTHMS = [rhythm(0, 1), rhythm(4, 5), rhythm(6), rhythm(8), rhythm(9)]
EXPECTED = [([0, 1], True), ([2, 3], False), ([4, 5], True), ([6, 7], False), ([9], True)]


@pytest.mark.parametrize("seed", range(20))
def test_interleaving_does_not_matter(seed):
    assert fed(Pairing(), shuffled(JOINTS, RHYTHMS, seed)) == EXPECTED


def test_one_stream_after_the_other():
    assert fed(Pairing(), JOINTS + RHYTHMS) == EXPECTED
    assert fed(Pairing(), RHYTHMS + JOINTS) == EXPECTED


def test_a_stream_without_any_rhythm_is_kept_for_the_end():
    assert fed(Pairing(), JOINTS) == [(message.captured_ns, False) for message in JOINTS]


def test_snapshot_keeps_what_waits():
    waiting = Pairing()
    full = JointState(
        model="lower_body",
        captured_ns=[5],
        position=[[0.1]],
        velocity=[[0.2]],
        acceleration=[[0.3]],
        position_std=[[0.4]],
        velocity_std=[[0.5]],
        valid=[True],
        observed=[],
    )
    waiting.add_joints(full)
    resumed = Pairing()
    resumed.restore(json.loads(json.dumps(waiting.snapshot())))
    [(kept, partner, *_)] = resumed.add_rhythm(
        Rhythm(captured_ns=[5], phase=[1], frequency=[1], quality=[1], locked=[True])
    )
    assert kept == full
    assert partner is not None


def motion(*captured_ns: int) -> SegmentMotion:
    return SegmentMotion(captured_ns=list(captured_ns), segments=[])


MOTIONS = [motion(0, 1), motion(2, 3), motion(6, 7), motion(9)]


@pytest.mark.parametrize("seed", range(20))
def test_three_streams_come_together_however_they_interleave(seed):
    pairing, complete = Pairing(with_motion=True), []
    for message in shuffled(shuffled(JOINTS, RHYTHMS, seed), MOTIONS, seed + 100):
        if isinstance(message, JointState):
            complete += pairing.add_joints(message)
        elif isinstance(message, Rhythm):
            complete += pairing.add_rhythm(message)
        else:
            complete += pairing.add_motion(message)
    complete += pairing.flush()
    partners = [(t.joints.captured_ns, t.rhythm is not None, t.motion is not None) for t in complete]
    moved = [True, True, False, True, True]
    assert partners == [(ns, found, found_too) for (ns, found), found_too in zip(EXPECTED, moved, strict=True)]


def test_motion_that_waits_survives_a_snapshot():
    waiting = Pairing(with_motion=True)
    waiting.add_motion(motion(4, 5))
    waiting.add_rhythm(Rhythm(captured_ns=[4, 5], phase=[1, 2], frequency=[1, 1], quality=[1, 1], locked=[True, True]))
    resumed = Pairing(with_motion=True)
    resumed.restore(json.loads(json.dumps(waiting.snapshot())))
    [together] = resumed.add_joints(joints(4, 5))
    assert together.motion == motion(4, 5)
    assert together.rhythm is not None


def centres(*captured_ns: int) -> JointCentres:
    return JointCentres(captured_ns=list(captured_ns), position=[], seen=[])


def test_joint_centres_are_waited_for_where_a_camera_is_used():
    pairing = Pairing(with_centres=True)
    assert pairing.add_joints(joints(0, 1)) == []
    assert pairing.add_rhythm(rhythm(0, 1)) == []
    [together] = pairing.add_centres(centres(0, 1))
    assert together.centres == centres(0, 1)
    pairing.add_joints(joints(2, 3))
    pairing.add_rhythm(rhythm(2, 3))
    [lost] = pairing.add_centres(centres(4, 5))
    assert (lost.joints.captured_ns, lost.centres) == ([2, 3], None)
    resumed = Pairing(with_centres=True)
    resumed.restore(json.loads(json.dumps(pairing.snapshot())))
    resumed.add_joints(joints(4, 5))
    [found] = resumed.add_rhythm(rhythm(4, 5))
    assert found.centres == centres(4, 5)
