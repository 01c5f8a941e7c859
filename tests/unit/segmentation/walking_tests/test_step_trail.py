"""The steps of a walk in order, and how far each has brought the person."""

import json

import pytest

from schemas.vocabulary import Side
from services.segmentation.walking_tests.parameters import WalkingTestParameters
from services.segmentation.walking_tests.step_trail import Landing, StepTrail

P = WalkingTestParameters()
S = 10**9


def landing(k: int, *, side: Side | None = None, apart: float | None = 0.6, lost: float = 0.0, **more) -> Landing:
    fields = {"onward": 1.0, "turning": False, "missed_m": 0.0} | more
    side = side or (Side.LEFT if k % 2 else Side.RIGHT)
    return Landing(side, k * S // 2, 0.02, fields["onward"], apart, lost, fields["turning"], fields["missed_m"])


def trail_of(*landings: Landing, measured: float | None = 0.7) -> StepTrail:
    trail = StepTrail(P)
    for number, each in enumerate(landings):
        trail.land(each, stands=number == 0)
        if measured is not None and number:
            trail._measure(each.at_ns, each.side, measured, 0.01)
    trail.settle(None)
    return trail


def test_strides_tell_lengths_and_the_feet_the_first_step() -> None:
    trail = trail_of(*(landing(k) for k in range(1, 6)))
    assert trail.walked(5 * S // 2)[0] == pytest.approx(0.6 + 4 * 0.7)
    assert trail.walked(9 * S // 4)[0] == pytest.approx(0.6 + 3.5 * 0.7)
    assert trail.steps(5 * S // 2) == 5


def test_without_any_measured_length_nothing_was_walked() -> None:
    assert trail_of(*(landing(k, apart=None) for k in range(1, 6)), measured=None).walked(2 * S) is None


def test_a_first_step_that_was_not_seen_is_added_and_the_walk_began_earlier() -> None:
    seen, unseen = (trail_of(landing(1, missed_m=m), landing(2)) for m in (0.0, 0.3))
    assert unseen.walked(S)[0] - seen.walked(S)[0] == pytest.approx(0.3)
    assert unseen.state.begun_ns == seen.state.begun_ns - round(P.first_step_s * 1e9)


def test_a_turning_step_is_as_long_as_the_feet_are_apart_and_counts_by_its_direction() -> None:
    trail = trail_of(landing(1), landing(2), landing(3, turning=True, onward=0.5, apart=0.4))
    assert trail.walked(3 * S // 2)[0] == pytest.approx(0.6 + 0.7 + 0.2)


def test_where_samples_are_missing_the_own_speed_fills_in_and_is_less_sure() -> None:
    whole = [landing(k) for k in (1, 2, 3)]
    trail = trail_of(*whole, landing(9, lost=2.5))
    walked_m, variance = trail.walked(9 * S // 2)
    assert walked_m == pytest.approx(0.6 + 2 * 0.7 + 3.0 * 1.4)
    assert variance > 1.0


def test_memory_is_bounded_and_counts_go_on() -> None:
    trail = StepTrail(P)
    for k in range(1, 2000):
        trail.land(landing(k), stands=k == 1)
        trail.settle(k * S // 2 + S)
    assert len(trail.state.marks) < 2.2 * P.steps_memory_s
    assert trail.steps(1000 * S) == 1999
    assert trail.walked(2000 * S) is None


def test_a_snapshot_is_json_and_restores_to_the_bit() -> None:
    trail = trail_of(*(landing(k) for k in range(1, 6)))
    trail.land(landing(6), stands=False)
    other = StepTrail(P)
    other.restore(json.loads(json.dumps(trail.snapshot())))
    assert other.state == trail.state
