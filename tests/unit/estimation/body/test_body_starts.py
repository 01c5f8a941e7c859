"""Where a person begins to be followed: standing, moving, seated, marked; and where somebody else does."""

import numpy as np
import pytest

from services.biomech.whole_body.model import DOF
from services.estimation.body.recent import RecentFrames
from tests.unit.estimation.body import body_sessions as sessions

KNEES = [sessions.NAMES.index(f"knee_flexion_{side}") for side in ("right", "left")]


def frames(seconds: float) -> int:
    return round(seconds * sessions.RATE_HZ)


def outputs_of(q: np.ndarray, offset_m: float = 0.02, **marks: float):
    stream = sessions.messages(sessions.seen(q, 3, offset_m=offset_m))
    return sessions.run(sessions.node(), sessions.marked(stream, **marks) if marks else stream)


def knee_error_deg(outputs, q: np.ndarray, from_s: float) -> float:
    times, position, _ = sessions.table(outputs)
    k = np.round(times * sessions.RATE_HZ / 1e9).astype(int) - 1
    late = k >= frames(from_s)
    error = position[late][:, KNEES] - q[k[late]][:, [3 + i for i in KNEES]]
    return float(np.degrees(np.sqrt(np.mean(error**2))))


def absolute(outputs) -> list[bool]:
    """Of the calibrations, one after another, without those that only say that lengths are held."""
    found = [c.absolute for c in sessions.calibrations(outputs)]
    return [flag for i, flag in enumerate(found) if i == 0 or flag != found[i - 1]]


def test_who_moves_from_the_start_is_followed_without_a_datum_and_anew_once_still():
    q = np.concatenate([sessions.squats(7.5)[20:], sessions.standing(1.6), sessions.squats(6.0)])
    outputs = outputs_of(q)
    assert absolute(outputs) == [False, True]
    first, *_ = sessions.calibrations(outputs)
    assert first.quality <= 0.4
    assert "nobody stood still" in first.datum
    times, _, _ = sessions.table(outputs)
    assert times.tolist() == [sessions.time_ns(k) for k in range(len(q))]
    moving = next(p for p in sessions.pictures(outputs) if p.phase == "estimating")
    assert "stand still" in moving.message
    assert sessions.pictures(outputs)[-1].message == ""
    assert knee_error_deg(outputs, q, 8.6) < 5.0


def error_deg(outputs, q: np.ndarray, from_s: float) -> float:
    """Of pelvis, hips, knees and trunk."""
    _, position, _ = sessions.table(outputs)
    columns = [i for i, name in enumerate(sessions.NAMES[:12]) if "rotation" not in name]
    first = frames(from_s)
    return float(np.degrees(np.sqrt(np.mean((position[first:, columns] - q[first:, [3 + i for i in columns]]) ** 2))))


def test_a_new_start_in_a_pause_makes_angles_absolute(monkeypatch):
    q = np.concatenate([sessions.squats(7.5)[20:], sessions.standing(1.6), sessions.squats(6.0)])
    with_pause = outputs_of(q, 0.03)
    monkeypatch.setattr(RecentFrames, "newest_second", lambda _: [])
    without = outputs_of(q, 0.03)
    assert absolute(without) == [False]
    assert absolute(with_pause) == [False, True]
    assert max(error_deg(with_pause, q, 8.6), error_deg(without, q, 8.6)) < 4.0


def test_who_sits_still_does_not_stand():
    q = sessions.seated(4.0)
    outputs = outputs_of(q)
    assert absolute(outputs) == [False]
    assert len(sessions.table(outputs)[0]) == len(q)


def test_who_raises_the_arms_does_not_stand_at_rest():
    q = sessions.standing(4.0)
    for side in ("right", "left"):
        q[:, 3 + DOF[f"shoulder_flexion_{side}"]] = np.radians(80.0)
    assert absolute(outputs_of(q)) == [False]


def test_a_recording_that_ends_early_is_followed_with_what_there_is():
    q = sessions.squats(4.5)[20:65]
    outputs = outputs_of(q)
    assert absolute(outputs) == [False]
    assert len(sessions.table(outputs)[0]) == len(q)


def test_a_marked_standing_is_taken():
    """What was marked had been too short to be found."""
    q = np.concatenate([sessions.squats(9.0)[20:], sessions.standing(1.2), sessions.squats(3.0)])
    given = len(q) / sessions.RATE_HZ - 2.5
    # Shaken just too much to be found by itself in any whole second, as the marked part is.
    outputs = outputs_of(q, from_s=8.4, to_s=9.45, given_s=given)
    assert absolute(outputs) == [False, True]
    notices = {pose.notice for pose in sessions.pictures(outputs)} - {""}
    assert notices == {"Angles refer to the marked standing from now on"}
    assert knee_error_deg(outputs, q, given + 0.1) < 5.0


@pytest.mark.parametrize(
    ("from_s", "to_s", "reason"),
    [(3.0, 5.0, "the person moved"), (0.2, 0.6, "in view for only"), (7.2, 8.6, "the legs were bent")],
)
def test_a_mark_that_was_no_standing_is_refused_with_a_reason(from_s, to_s, reason):
    q = np.concatenate([sessions.standing(1.5), sessions.squats(5.5), sessions.seated(2.5)])
    outputs = outputs_of(q, from_s=from_s, to_s=to_s, given_s=8.8)
    (notice,) = {pose.notice for pose in sessions.pictures(outputs)} - {""}
    assert notice.startswith("Not taken as standing: ")
    assert reason in notice
    assert absolute(outputs) == [True]


def test_a_standing_of_the_description_counts_as_marked():
    q = np.concatenate([sessions.standing(1.5), sessions.squats(3.0)])
    description = sessions.describe(standing=[(0.1, 1.3)])
    outputs = sessions.run(sessions.node(description), sessions.messages(sessions.seen(q)))
    assert absolute(outputs) == [True]
    assert {pose.notice for pose in sessions.pictures(outputs)} - {""} <= {
        "Angles refer to the marked standing from now on", "Standing taken as marked",
    }  # fmt: skip


def test_nothing_of_a_person_leaks_into_the_next_one():
    """The second person's messages are those of a session of their own, apart from the phase of the rhythm."""
    first, second = sessions.seen(sessions.squats(5.0), 1, offset_m=0.03), sessions.seen(
        np.concatenate([sessions.standing(1.5), sessions.squats(3.0)]), 2, offset_m=0.03
    )  # fmt: skip
    n = len(first)
    both = sessions.messages(np.concatenate([first, second]), body=[1] * n + [2] * len(second))
    outputs = sessions.run(sessions.node(), both)
    alone = sessions.run(sessions.node(), both[n:])
    for quantity in ("position", "position_std", "velocity"):
        times, values, valid = sessions.table(outputs, quantity)
        own_times, own_values, own_valid = sessions.table(alone, quantity)
        mine = times >= own_times[0]
        assert (times[mine] == own_times).all()
        assert (values[mine] == own_values).all()
        assert (valid[mine] == own_valid).all()
    assert len(sessions.calibrations(outputs)) > len(sessions.calibrations(alone))
    assert sessions.calibrations(outputs)[-1] == sessions.calibrations(alone)[-1]


def test_two_people_in_view_are_told():
    outputs = sessions.run(
        sessions.node(), sessions.messages(sessions.seen(sessions.standing(1.5)), people=2)
    )  # fmt: skip
    first, *_, last = sessions.pictures(outputs)
    assert first.message.startswith("2 people in view: only one of them is followed. Stand still")
    assert last.message == "2 people in view: only one of them is followed"
    assert last.cameras[0].people == 2
