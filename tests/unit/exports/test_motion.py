import numpy as np
import pytest

from services.exports import motion as under_test
from services.exports.errors import ExportError
from services.exports.motion import Track, even_rate_hz, even_times, gather_motion, resampled


def track(times_s, value, valid=None):
    times = np.round(np.asarray(times_s) * 1e9).astype(np.int64)
    values = np.asarray(value, dtype=float).reshape(len(times), -1, 1)
    return Track(times, values, np.ones(values.shape[:2], dtype=bool) if valid is None else valid)


def test_a_session_becomes_arrays_in_order_of_time(made):
    states = made.joint_states(count=30)
    motion = gather_motion([states[1], states[0], states[2], states[0]])
    seconds = motion.angles.times_ns * 1e-9
    assert np.all(np.diff(motion.angles.times_ns) == 10_000_000)
    np.testing.assert_array_equal(motion.angles.value[..., 0], made.angles_at("lower_body", seconds))
    assert motion.centres is None


def test_what_is_hardly_ever_valid_is_not_told(made):
    valid = [True] * 15
    valid[3] = False
    some = [*made.joint_states(count=500), *made.joint_states(count=500, valid=valid, start_ns=made.start_ns + 10**10)]
    motion = gather_motion(some)
    assert "hip_flexion_right" not in motion.told
    assert len(motion.told) == 14
    assert not motion.angles.value[~motion.angles.valid].any()


@pytest.mark.parametrize(
    ("messages", "field"),
    [
        (lambda made: [], "joint_state"),
        (lambda made: made.joint_states(valid=[False] * 15), "joint_state.valid"),
        (lambda made: [*made.joint_states(count=10), *made.joint_states("whole_body", 10)], "joint_state.model"),
        (
            lambda made: [s.model_copy(update={"model": "hand"}) for s in made.joint_states(count=10)],
            "joint_state.model",
        ),
    ],
)
def test_what_cannot_be_gathered_names_the_field_and_a_next_step(made, messages, field):
    with pytest.raises(ExportError) as caught:
        gather_motion(messages(made))
    assert caught.value.field == field
    assert caught.value.next_step


def test_a_session_that_is_too_long_is_refused_before_it_is_held(made, monkeypatch):
    monkeypatch.setattr(under_test, "MOST_SAMPLES", 100)
    with pytest.raises(ExportError, match=r"more than 100 samples; export joint_angles.csv"):
        gather_motion(made.joint_states(count=200))


def test_even_times_keep_even_samples_to_the_bit(made):
    angles = gather_motion(made.joint_states(rate_hz=59.5)).angles
    rate = even_rate_hz(angles.times_ns)
    assert rate == pytest.approx(59.5, abs=1e-3)
    times = even_times(angles.times_ns, rate)
    again = resampled(angles, times, rate)
    assert again.valid.all()
    np.testing.assert_allclose(again.value, angles.value, atol=2e-6)


def test_jittering_times_take_the_nominal_rate():
    jitter = np.random.default_rng(1).uniform(-0.004, 0.004, 300)
    times = np.sort(np.arange(300) / 29.9 + jitter)
    assert even_rate_hz(track(times, times).times_ns, [30.0]) == 30.0
    even = np.arange(300) / 29.9
    assert even_rate_hz(track(even, even).times_ns, [30.0]) == pytest.approx(29.9)


def test_between_uneven_samples_the_error_is_that_of_a_cubic():
    times = np.sort(np.arange(300) / 30 + np.random.default_rng(2).uniform(-0.004, 0.004, 300))
    uneven = track(times, np.sin(6.0 * times))
    even = even_times(uneven.times_ns, 30.0)
    again = resampled(uneven, even, 30.0)
    inner = again.valid[:, 0]
    inner[[0, -1]] = False
    error = np.abs(again.value[:, 0, 0] - np.sin(6.0 * even * 1e-9))[inner]
    linear = np.abs(np.interp(even * 1e-9, times, np.sin(6.0 * times)) - np.sin(6.0 * even * 1e-9))[inner]
    assert error.max() < 1e-3 < linear.max()


def test_in_parts_it_is_the_same_as_at_once():
    times = np.sort(np.random.default_rng(3).uniform(0, 10, 400))
    uneven = track(times, np.cos(times))
    even = even_times(uneven.times_ns, 40.0)
    whole = resampled(uneven, even, 40.0)
    parts = [resampled(uneven, even[first : first + 37], 40.0) for first in range(0, even.size, 37)]
    np.testing.assert_array_equal(whole.value, np.concatenate([part.value for part in parts]))
    np.testing.assert_array_equal(whole.valid, np.concatenate([part.valid for part in parts]))


def test_gaps_and_invalid_samples_stay_empty_and_bend_nothing():
    times = np.concatenate([np.arange(0, 1, 0.01), np.arange(2, 3, 0.01)])
    valid = np.ones((times.size, 1), dtype=bool)
    valid[20] = False
    values = np.where(valid[:, 0], 5.0, 0.0)
    shifted = np.arange(0, 3, 0.01) + 0.005
    again = resampled(track(times, values, valid), np.round(shifted * 1e9).astype(np.int64), 100.0)
    told = again.valid[:, 0]
    assert not told[(shifted > 1.0) & (shifted < 2.0)].any()
    assert not told[(shifted > 0.19) & (shifted < 0.21)].any()
    assert told[shifted < 0.19].all()
    np.testing.assert_array_equal(again.value[told], 5.0)
    np.testing.assert_array_equal(again.value[~told], 0.0)


def test_a_lone_sample_is_told_at_its_time_alone():
    one = resampled(track([1.0], [7.0]), np.array([10**9, 2 * 10**9]), 100.0)
    assert one.valid[:, 0].tolist() == [True, False]
    assert one.value[:, 0, 0].tolist() == [7.0, 0.0]
