"""The synthetic timed up and go: its kinematics agree with themselves, and its phases with what the body does."""

from itertools import pairwise

import numpy as np
import pytest

from schemas.vocabulary import TASK_PHASES, Segment, Task, TaskPhaseKind
from services.ingest.errors import InvalidOption
from services.ingest.synthetic.motions import parse_motion
from services.ingest.synthetic.parameters import TugParameters
from services.ingest.synthetic.tug import PHASE_CHANNEL, SyntheticTug


def tug(query: str = "seed=3") -> SyntheticTug:
    return SyntheticTug(TugParameters.parse(query))


def times_of(session: SyntheticTug, rate: float = 100.0) -> np.ndarray:
    return np.arange(int(session.parameters.duration * rate)) / rate


def test_velocity_and_acceleration_are_the_derivatives_of_the_position() -> None:
    session = tug("seed=4&rise_time=1.2&turn_steps=3")
    time_s = times_of(session, 400.0)
    pelvis = session.body(time_s).pelvis
    inside = slice(3, -3)
    velocity = np.gradient(pelvis.position, time_s, axis=0)
    acceleration = np.gradient(pelvis.velocity, time_s, axis=0)
    np.testing.assert_allclose(velocity[inside], pelvis.velocity[inside], atol=2e-3)
    np.testing.assert_allclose(acceleration[inside], pelvis.acceleration[inside], atol=0.1)


def test_gyroscope_and_orientation_agree() -> None:
    session = tug()
    time_s = times_of(session, 400.0)
    thigh = session.body(time_s).segments[Segment.THIGH_LEFT]
    R = thigh.R_world_from_body
    turned = np.einsum("nij,nkj->nik", R[1:], R[:-1]) * 400.0
    rate = np.column_stack([turned[:, 2, 1], turned[:, 0, 2], turned[:, 1, 0]])
    middle = (thigh.angular_velocity[1:] + thigh.angular_velocity[:-1]) / 2
    np.testing.assert_allclose(rate, middle, atol=2e-2)


def test_the_person_sits_on_the_chair_before_and_after_and_walks_the_walkway() -> None:
    session = tug("seed=5&walkway=4&seat_height=0.44")
    time_s = times_of(session)
    pelvis = session.body(time_s).pelvis.position
    phases = {true.phase: true for true in session.phases}
    rise, turn, sit = (
        phases[kind] for kind in (TaskPhaseKind.SIT_TO_STAND, TaskPhaseKind.TURN, TaskPhaseKind.TURN_TO_SIT)
    )
    seated = pelvis[int(100 * (rise.start_s - 0.5)), 1]
    assert seated == pytest.approx(0.44 + 0.08, abs=0.01)
    assert pelvis[int(100 * (rise.end_s)), 1] == pytest.approx(0.89, abs=0.01)
    assert pelvis[int(100 * (sit.end_s + 0.4)), 1] == pytest.approx(seated, abs=0.01)
    middle = int(50 * (turn.start_s + turn.end_s))
    assert np.hypot(*(pelvis[middle] - pelvis[int(100 * rise.end_s)])[[0, 2]]) == pytest.approx(4.0, abs=0.6)
    assert np.hypot(*(pelvis[int(100 * sit.start_s)] - pelvis[int(100 * rise.end_s)])[[0, 2]]) < 1.6


def test_phases_follow_each_other_and_bound_what_they_name() -> None:
    session = tug("seed=6&attempts=2&speed=0.7&turn_time=3")
    assert [true.phase for true in session.phases] == 2 * list(TASK_PHASES[Task.TIMED_UP_AND_GO])
    assert [true.attempt for true in session.phases] == 5 * [0] + 5 * [1]
    for first in (0, 5):
        for one, next_one in pairwise(session.phases[first : first + 5]):
            assert one.start_s < one.end_s == next_one.start_s
    turn = session.phases[2]
    time_s = np.array([turn.start_s, turn.end_s])
    heading = session.timeline.heading(time_s).value
    assert abs(heading[1] - heading[0]) == pytest.approx(np.pi, rel=0.05)


def test_truth_carries_the_phase() -> None:
    session = tug("seed=3&attempts=1")
    names = [channel.name for channel in session.description().reference]
    values = np.vstack([block.reference.values for block in session.samples()])
    phase = values[:, names.index(PHASE_CHANNEL)]
    for number, true in enumerate(session.phases, start=1):
        middle = int(50 * (true.start_s + true.end_s))
        assert phase[middle] == number
    assert phase[0] == phase[-1] == 0


def test_the_description_says_task_and_walkway() -> None:
    description = parse_motion("tug", "walkway=7&worn=1&seated_start=1").description()
    assert (description.task, description.walkway_m) == (Task.TIMED_UP_AND_GO, 7.0)
    assert len(description.hubs[0].sensors) == 2


def test_false_starts_are_no_attempts_and_aborted_ones_end_early() -> None:
    session = tug("seed=3&false_starts=2&aborted=1&attempts=1")
    kinds = [(true.attempt, true.phase) for true in session.phases]
    assert kinds[:2] == [(0, TaskPhaseKind.SIT_TO_STAND), (0, TaskPhaseKind.WALK_OUT)]
    assert kinds[2:] == [(1, kind) for kind in TASK_PHASES[Task.TIMED_UP_AND_GO]]
    assert sum(change.rises for change in session.plan.changes) == 4


def test_a_stroll_and_a_hesitation_fit_in() -> None:
    plain, slow = tug("seed=3"), tug("seed=3&stroll=6&hesitation=3")
    assert slow.plan.end_s > plain.plan.end_s + 8.0
    assert len(slow.timeline.bouts) == 3


def test_a_session_shorter_than_its_attempts_is_refused() -> None:
    with pytest.raises(InvalidOption, match="take"):
        tug("duration=10")


def test_the_same_dials_make_the_same_person() -> None:
    one, other = (next(tug("seed=8&duration=60").samples()) for _ in range(2))
    np.testing.assert_array_equal(one.sensors[0].specific_force, other.sensors[0].specific_force)
