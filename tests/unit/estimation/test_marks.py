"""Standing that the operator marks while the session runs: taken, refused with a reason, a new zero; replayed alike."""

import json
from functools import cache
from itertools import groupby

import numpy as np
import pytest
from numpy.typing import NDArray

from schemas.imu import ImuBatch
from schemas.session import Placement
from schemas.signals import CALIBRATION
from schemas.standing import StandingMark
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import SensorMount
from services.biomech.pinocchio_model import PinocchioBody
from services.biomech.rotations import rotation_about
from services.estimation.lower_body.node import LowerBodyNode
from services.flow.message import Message, Output
from tests.unit.estimation import estimation_walks as walks

Array = NDArray[np.float64]

DESCRIPTION = walks.describe()
KNEE = walks.NAMES.index("knee_flexion_left")
BENT_FROM_S, BENT_S = 9.0, 6.0
TICK_NS = 10_000_000


def mark(from_s: float, to_s: float, given_s: float | None = None) -> StandingMark:
    times = (from_s, to_s, to_s if given_s is None else given_s)
    return StandingMark(**dict(zip(("from_ns", "to_ns", "given_ns"), (round(t * 1e9) for t in times), strict=True)))


def with_mark(stream: list[Message], given: StandingMark) -> list[Message]:
    """As ingest sends it: in the first message later than the mark."""
    carrier = next(i for i, m in enumerate(stream) if m.envelope.captured_ns > given.given_ns)
    message = stream[carrier]
    assert isinstance(message.payload, ImuBatch)
    marked = ImuBatch(sensors=message.payload.sensors, marks=[given])
    return [*stream[:carrier], Message(message.stream, message.envelope, marked), *stream[carrier + 1 :]]


def bent_standing(flexion: float) -> Array:
    """(n, 5, 6) of somebody who stands with bent left hip and knee, the trunk upright."""
    oracle = PinocchioBody(walks.MODEL, [SensorMount(segment, walks.mounting()[segment]) for segment in SEGMENTS])
    x = np.zeros((3, 15))
    x[0, KNEE], x[0, walks.NAMES.index("hip_flexion_left")] = flexion, 0.5 * flexion
    sample = np.array([oracle.sample(s, x) for s in range(5)])
    sample[:, :3] += walks.gyro_bias()
    noise = np.random.default_rng(3).normal(size=(round(BENT_S * 100), 5, 6))
    return sample + 0.02 * noise


def walk_then_stand(flexion: float = 0.2) -> Array:
    return np.concatenate([walks.walk()[1], bent_standing(flexion)])


@cache
def without_mark() -> list[Output]:
    return walks.run(LowerBodyNode(DESCRIPTION), walks.messages(DESCRIPTION, walk_then_stand()))


@cache
def with_marks(*given: StandingMark) -> list[Output]:
    stream = walks.messages(DESCRIPTION, walk_then_stand())
    for each in given:
        stream = with_mark(stream, each)
    return walks.run(LowerBodyNode(DESCRIPTION), stream)


def notices(outputs: list[Output]) -> set[str]:
    return {pose.notice for pose in walks.pictures(outputs)} - {""}


def knee(outputs: list[Output]) -> dict[int, float]:
    return walks.angles(outputs, "knee_flexion_left")


def test_a_mark_before_the_first_steps_is_the_standing_that_counts() -> None:
    stream = walks.messages(DESCRIPTION, walks.walk()[1])
    outputs = walks.run(LowerBodyNode(DESCRIPTION), with_mark(stream, mark(0.5, 1.9)))
    (calibration,) = [output.payload for output in outputs if output.signal is CALIBRATION]
    assert calibration.method == "standing, marked by the operator + walking"
    assert notices(outputs) == {"Standing taken as marked"}


def test_no_standing_is_refused_and_changes_nothing() -> None:
    refused = {
        mark(1.5, 4.5): "moved",
        mark(11.0, 11.4): "only 0.4 s of samples, 1 s are needed",
        mark(5.0, 8.0, 13.0): "moved",
        mark(14.5, 13.5): "only 0 s of samples, 1 s are needed",
    }
    outputs = with_marks(*refused)
    assert knee(outputs) == knee(without_mark())
    said = [notice for notice, _ in groupby(pose.notice for pose in walks.pictures(outputs)) if notice]
    assert len(said) == 4
    for notice, reason in zip(said, refused.values(), strict=True):
        assert notice.startswith("Not taken as standing: ")
        assert reason in notice


def test_while_estimating_a_mark_is_the_new_zero_from_then_on() -> None:
    """The clinician sees that the patient stands bent and says so: angles refer to that from the mark on."""
    outputs = with_marks(mark(10.0, 12.0))
    before, after = knee(without_mark()), knee(outputs)
    at = 12_000_000_000
    assert all(after[t] == before[t] for t in after if t <= at)
    assert before[14_500_000_000] == pytest.approx(0.2, abs=0.05)
    assert after[14_500_000_000] == pytest.approx(0.0, abs=0.01)
    calibrations = [output for output in outputs if output.signal is CALIBRATION]
    assert [c.captured_ns for c in calibrations[1:]] == [at + TICK_NS]
    assert calibrations[1].payload.method == "standing, marked by the operator + walking"
    doubtful = [state for state in walks.joint_states(outputs) if at < state.captured_ns[0] <= at + 900_000_000]
    assert not any(any(state.valid) for state in doubtful)
    assert all(walks.joint_states(outputs)[-1].valid)
    assert notices(outputs) == {"Angles refer to the marked standing from now on"}


@pytest.mark.parametrize("worn", [Placement.ANTERIOR, Placement.LATERAL])
def test_sitting_is_refused_where_it_can_be_told(worn: Placement) -> None:
    """Before the calibration by sensors on the front of the thigh; after it by all."""
    sitting = bent_standing(0.2)
    forward = rotation_about(np.array([0.0, 0.0, 1.0]), np.pi / 2)
    for segment in (Segment.THIGH_LEFT, Segment.THIGH_RIGHT):
        s, mounting = SEGMENTS.index(segment), walks.mounting()[segment]
        sitting[:, s, 3:] = mounting.T @ forward.T @ np.array([0.0, 9.81, 0.0])
    sides = {segment: worn for segment in SEGMENTS if segment is not Segment.PELVIS}
    description = walks.describe(placements=sides | {Segment.PELVIS: Placement.POSTERIOR})
    later = walks.messages(description, np.concatenate([walks.walk()[1], sitting]))
    outputs = walks.run(LowerBodyNode(description), with_mark(later, mark(10.0, 12.0)))
    assert notices(outputs) == {"Not taken as standing: sitting, not standing"}
    if worn is Placement.ANTERIOR:
        at_once = walks.messages(description, sitting)
        outputs = walks.run(LowerBodyNode(description), with_mark(at_once, mark(1.0, 3.0)))
        assert notices(outputs) == {"Not taken as standing: sitting, not standing"}
        assert "Sitting, not standing: please stand up straight" in {p.message for p in walks.pictures(outputs)}


@pytest.mark.parametrize(("given", "ticks"), [(mark(0.5, 1.9), 3), (mark(10.0, 12.0), 1), (mark(9.5, 12.0, 12.4), 3)])
def test_batches_and_restarts_change_nothing(given: StandingMark, ticks: int) -> None:
    whole = with_marks(given)
    stream = with_mark(walks.messages(DESCRIPTION, walk_then_stand(), ticks=ticks), given)
    node, outputs = LowerBodyNode(DESCRIPTION), []
    for number, message in enumerate(stream):
        if number % (100 // ticks) == 13:
            state = json.loads(json.dumps(node.snapshot()))
            node = LowerBodyNode(DESCRIPTION)
            node.restore(state)
        outputs += node.step(message)
    outputs += node.finish()
    found, expected = knee(outputs), knee(whole)
    assert found == {t: value for t, value in expected.items() if t in found}
    assert len(found) > len(expected) - ticks


def test_hubs_may_interleave_as_they_like() -> None:
    description = walks.describe(hubs=(walks.SEGMENTS[:3], walks.SEGMENTS[3:]))
    stream = with_mark(walks.messages(description, walk_then_stand()), mark(10.0, 12.0))
    other = sorted(stream, key=lambda m: (m.envelope.captured_ns, -int(m.stream.source[-1])))
    results = [walks.run(LowerBodyNode(description), order) for order in (stream, other)]
    assert knee(results[0]) == knee(results[1])
    assert len(notices(results[0])) == 1
