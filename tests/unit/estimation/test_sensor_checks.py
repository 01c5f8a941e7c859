import math

import pytest

from schemas.health import Reason
from schemas.vocabulary import SensorState
from services.estimation.parameters import CheckParameters
from services.estimation.sensor_checks import SensorChecks

MS = 1_000_000


def values(k: int, rate: float = 0.0, force: float = 9.81) -> tuple[float, ...]:
    """Differs from sample to sample as a real sensor's last digits do."""
    return (rate + 1e-4 * (k % 7), 0.0, 0.0, 0.0, force, 1e-3 * (k % 3))


def checks() -> SensorChecks:
    return SensorChecks(["left", "right"])


def fill(subject: SensorChecks, first: int, last: int) -> None:
    for k in range(first, last):
        assert subject.accept(0, k * 10 * MS, values(k), k * 10 * MS)


def counted(subject: SensorChecks) -> dict[tuple[str, Reason], int]:
    return {(entry.subject, entry.reason): entry.count for entry in subject.rejections()}


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("place", range(6))
def test_numbers_that_are_none_are_refused(bad: float, place: int) -> None:
    subject = checks()
    fill(subject, 0, 5)
    broken = list(values(5))
    broken[place] = bad
    assert not subject.accept(0, 50 * MS, tuple(broken), 50 * MS)
    assert counted(subject) == {("left", Reason.NOT_FINITE): 1}
    assert subject.accept(0, 60 * MS, values(6), 60 * MS)


@pytest.mark.parametrize("captured_ns", [40 * MS, 30 * MS, 0])
def test_time_must_go_forward(captured_ns: int) -> None:
    subject = checks()
    fill(subject, 0, 5)
    assert not subject.accept(0, captured_ns, values(9), 50 * MS)
    assert counted(subject) == {("left", Reason.CLOCK_BACKWARDS): 1}
    assert subject.accept(0, 50 * MS, values(6), 50 * MS)


def test_a_time_far_from_its_message_is_no_time() -> None:
    subject = checks()
    fill(subject, 0, 5)
    assert not subject.accept(0, 3_600_000 * MS, values(5), 50 * MS)
    assert subject.accept(0, 60 * MS, values(6), 60 * MS), "the wrong time must not make later ones run backwards"


@pytest.mark.parametrize("wild", [(50.0, 9.81), (0.0, 500.0), (-50.0, 9.81)])
def test_more_than_a_sensor_can_measure(wild: tuple[float, float]) -> None:
    subject = checks()
    fill(subject, 0, 5)
    assert not subject.accept(0, 50 * MS, values(5, *wild), 50 * MS)
    assert counted(subject) == {("left", Reason.OUT_OF_RANGE): 1}


def test_a_lone_jump_is_refused_and_a_lasting_one_believed() -> None:
    subject = checks()
    fill(subject, 0, 5)
    assert not subject.accept(0, 50 * MS, values(5, rate=30.0), 50 * MS)
    assert subject.accept(0, 60 * MS, values(6), 60 * MS), "back to where it was: the jump was alone"
    assert not subject.accept(0, 70 * MS, values(7, rate=30.0), 70 * MS)
    assert subject.accept(0, 80 * MS, values(8, rate=20.5), 80 * MS)


def test_a_stuck_sensor_is_refused_after_a_while_and_named() -> None:
    subject = SensorChecks(["left"], CheckParameters(stuck_after=10))
    same = values(1)
    accepted = [subject.accept(0, k * 10 * MS, same, k * 10 * MS) for k in range(60)]
    assert accepted == [True] * 10 + [False] * 50
    assert counted(subject) == {("left", Reason.STUCK): 50}
    assert subject.state_of(0, 590 * MS)[0] is SensorState.STUCK
    assert subject.accept(0, 600 * MS, values(2), 600 * MS)
    assert subject.state_of(0, 600 * MS)[0] is SensorState.OK


def test_states() -> None:
    subject = checks()
    fill(subject, 0, 5)
    assert subject.state_of(1, 40 * MS) == (SensorState.MISSING, 0)
    assert subject.state_of(0, 100 * MS)[0] is SensorState.OK
    assert subject.state_of(0, 1_000 * MS) == (SensorState.MISSING, 40 * MS)
    for k in range(100, 150):
        subject.accept(0, k * 10 * MS, values(k, rate=60.0), k * 10 * MS)
    assert subject.state_of(0, 1_490 * MS) == (SensorState.REJECTED, 40 * MS)


def test_goes_on_from_a_snapshot() -> None:
    first, second = checks(), checks()
    fill(first, 0, 5)
    first.accept(0, 50 * MS, values(5, rate=20.0), 50 * MS)
    second.restore(first.snapshot())
    assert second.rejections() == first.rejections()
    assert second.snapshot() == first.snapshot()
    for subject in (first, second):
        assert subject.accept(0, 60 * MS, values(6, rate=20.0), 60 * MS)
