"""Out of view and back, lost frames, guessed centres; and frames that cannot be used."""

import numpy as np
import pytest

from schemas.health import Reason
from schemas.vocabulary import SensorState, TrackingState
from tests.unit.estimation.body import body_sessions as sessions

KNEES = [sessions.NAMES.index(f"knee_flexion_{side}") for side in ("right", "left")]


def rows_of(q: np.ndarray, away: slice, *, missing: bool = False, centres: np.ndarray | None = None):
    seen = sessions.seen(q, 4) if centres is None else centres
    body: list[int | None] = [1] * len(q)
    stream = sessions.messages(
        seen, body=[None if k in range(*away.indices(len(q))) else b for k, b in enumerate(body)]
    )
    if missing:
        del stream[away]
    outputs = sessions.run(sessions.node(), stream)
    return outputs, *sessions.table(outputs)


def exercise() -> np.ndarray:
    return np.concatenate([sessions.standing(2.0), sessions.squats(9.0)])


def test_out_of_view_angles_are_told_for_a_moment_then_nothing_is_valid():
    outputs, times, position, valid = rows_of(exercise(), slice(150, 210))
    assert len(times) == len(exercise())
    assert valid[151, KNEES].all()
    assert not valid[165:210].any()
    assert (position[165:210] == position[164]).all()
    away = [p for p in sessions.pictures(outputs) if sessions.time_ns(165) <= p.captured_ns < sessions.time_ns(210)]
    assert {p.message for p in away} == {"Nobody in view"}
    assert all(p.angles == {} and p.centres == {} and p.cameras[0].people == 0 for p in away)
    unseen = [c for c in sessions.centres(outputs) if not any(c.seen)]
    assert {t for c in unseen for t in c.captured_ns} >= {sessions.time_ns(k) for k in range(170, 210)}


@pytest.mark.parametrize("missing", [False, True])
def test_who_comes_back_elsewhere_in_another_posture_is_right_after_a_moment(missing):
    q = exercise()
    q[210:, 0] += 0.8
    q[210:, 2] -= 0.6
    # Leaves deep in a squat, comes back nearly upright.
    outputs, times, position, valid = rows_of(q, slice(105, 240), missing=missing)
    k = np.round(times * sessions.RATE_HZ / 1e9).astype(int) - 1
    late = k >= 255
    assert valid[late][:, KNEES].all()
    error = np.degrees(position[late][:, KNEES] - q[k[late]][:, [3 + i for i in KNEES]])
    assert np.sqrt(np.mean(error**2)) < 4.0
    assert [c.absolute for c in sessions.calibrations(outputs)][-1]
    assert len(sessions.calibrations(outputs)) <= 2


def test_a_few_lost_frames_change_nothing_of_note():
    whole = rows_of(exercise(), slice(0, 0))
    lost = rows_of(exercise(), slice(150, 154), missing=True)
    kept = np.isin(whole[1], lost[1])
    assert (lost[3][:, KNEES]).all()
    assert np.degrees(np.abs(whole[2][kept][:, KNEES] - lost[2][:, KNEES])).max() < 8.0


def test_a_leg_that_is_only_guessed_is_not_shown():
    q = exercise()
    state = np.full((len(q), 15), 2)
    state[150:200, [10, 11]] = 1
    outputs = sessions.run(sessions.node(), sessions.messages(sessions.seen(q, 4), state))
    times, _, valid = sessions.table(outputs)
    assert not valid[165:200, KNEES[0]].any()
    assert valid[165:200, KNEES[1]].all()
    assert valid[215:, KNEES[0]].all()
    observed = {t: s.observed for s in sessions.states(outputs) for t in s.captured_ns}
    assert [segment.value for segment in observed[times[180]]] == ["pelvis", "torso", "thigh_left", "shank_left"]


def test_validity_does_not_flicker():
    q = exercise()
    seen = sessions.seen(q, 4, std=0.015)
    outputs = sessions.run(sessions.node(), sessions.messages(seen))
    _, _, valid = sessions.table(outputs)
    for column in valid.T:
        runs = np.split(column, np.flatnonzero(np.diff(column.astype(int))) + 1)
        hidden = [len(run) for run in runs[1:-1] if not run[0]]
        assert min(hidden, default=99) >= 9


def refused(stream) -> dict[Reason, int]:
    node = sessions.node()
    outputs = sessions.run(node, stream)
    assert all(np.isfinite(sessions.table(outputs, quantity)[1]).all() for quantity in ("position", "velocity_std"))
    return {rejection.reason: rejection.count for rejection in node.rejections()}


def test_frames_that_cannot_be_used_are_counted():
    stream = sessions.messages(sessions.seen(exercise()[:120]))
    batch = stream[70].payload
    short = sessions.changed(stream[70], position=[batch.position[0][:-1]], state=[batch.state[0][:-1]])
    far = sessions.changed(stream[75], position=[[[99.0, 0.0, 0.0], *batch.position[0][1:]]])
    broken = sessions.changed(stream[80], position=[[[np.nan, 0.0, 0.0], *batch.position[0][1:]]])
    untimely = sessions.changed(stream[85], captured_ns=[stream[85].envelope.captured_ns + 20_000_000_000])
    odd = [*stream[:70], short, *stream[71:75], far, *stream[76:80], broken, *stream[81:85], untimely, *stream[86:]]
    doubled = [*odd[:90], odd[89], odd[88], *odd[90:]]
    assert refused(doubled) == {
        Reason.WRONG_SHAPE: 1, Reason.OUT_OF_RANGE: 2, Reason.NOT_FINITE: 1, Reason.CLOCK_BACKWARDS: 2,
    }  # fmt: skip


def test_a_camera_that_repeats_itself_is_told():
    centres = sessions.seen(exercise()[:150])
    centres[60:] = centres[60]
    node = sessions.node()
    outputs = sessions.run(node, sessions.messages(centres))
    assert {r.reason: r.count for r in node.rejections()} == {Reason.STUCK: 60}
    assert sessions.pictures(outputs)[-1].cameras[0].state is SensorState.STUCK
    assert sessions.table(outputs)[0][-1] == sessions.time_ns(89)


def test_centres_without_a_position_are_not_tracked_whatever_their_state():
    stream = sessions.messages(sessions.seen(exercise()[:90]))
    batch = stream[60].payload
    none = sessions.changed(
        stream[60], position=[[None, *batch.position[0][1:]]], state=[[TrackingState.TRACKED] * 15]
    )  # fmt: skip
    assert refused([*stream[:60], none, *stream[61:]]) == {}
