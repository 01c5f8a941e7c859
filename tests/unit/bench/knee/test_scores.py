"""Scores of known estimates: shifts, clocks, swapped markers, axes."""

import numpy as np
import pytest

from services.bench.knee.grover_scores import largest_difference, motions, planar, synthetic
from services.bench.knee.legs import record, walking
from services.bench.knee.recordings import KneeRecording, clock_lag, swapped_markers
from services.bench.knee.scores import axis_errors, axis_history, score
from services.bench.knee.seel_axis import seel_axis
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

TIME_S = np.arange(2000) / 50.0
TRUTH = 1.5 * np.sin(3.0 * TIME_S)
EVERY = np.ones(2000, dtype=np.bool_)


def test_a_late_estimate_is_found_out_by_the_shift():
    late = 1.5 * np.sin(3.0 * (TIME_S - 0.01)) + 0.1
    result = score(late, TRUTH, EVERY, EVERY)
    assert result.shift == 0.5
    assert result.shifted.zero_mean_rmse < 2e-3
    assert result.shifted.absolute_rmse == pytest.approx(0.1, abs=1e-3)
    assert result.unshifted.zero_mean_rmse > 0.02


def test_whole_turns_are_no_error():
    result = score(TRUTH + 2.0 * np.pi, TRUTH, EVERY, EVERY, absolute=True)
    assert result.unshifted.absolute_rmse == pytest.approx(0.0, abs=1e-12)


def test_coverage_is_the_share_that_was_valid():
    valid = EVERY.copy()
    valid[:500] = False
    result = score(TRUTH, TRUTH, EVERY, valid, np.full(2000, 0.01))
    assert result.coverage == 0.75
    assert result.within_two_std == 1.0
    with pytest.raises(ValueError, match="no valid estimate"):
        score(TRUTH, TRUTH, EVERY, ~EVERY)


def test_markers_that_jump_are_found_with_their_neighbours():
    positions = np.zeros((100, 6))
    positions[:, 0] = 0.01 * np.arange(100)
    positions[50, 3:] = 0.2
    assert np.flatnonzero(swapped_markers(positions, 50.0)).tolist() == [48, 49, 50, 51, 52]


def leg_recording(delay: float = 0.0) -> KneeRecording:
    leg = record(walking(start_s=1.0), 20.0, 50.0)
    flexion = np.interp(np.arange(len(leg.flexion)) + delay, np.arange(len(leg.flexion)), leg.flexion)
    return KneeRecording("leg", 50.0, leg.rate, leg.force, flexion, np.ones(len(flexion), dtype=np.bool_), leg.axes)


@pytest.mark.parametrize("delay", [0.0, 0.5])
def test_the_clocks_are_compared_by_the_rates(delay):
    # A rate that is the mean over its interval lies half a sample before its stamp, where a difference is made.
    assert clock_lag(leg_recording(delay), 2) == pytest.approx([delay, delay], abs=0.1)


def test_the_axis_comes_near_with_time():
    times, worst = axis_history(leg_recording(), KneeAxisParameters())
    assert times[-1] == pytest.approx(20.0)
    assert np.isnan(worst[0])
    assert np.degrees(worst[-1]) < 5.0


def test_axes_are_lines_of_a_common_sense():
    axes = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    assert axis_errors(-axes, axes) == pytest.approx([0.0, 0.0])
    assert np.degrees(axis_errors(np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]), axes)).max() == pytest.approx(180.0)


def test_seels_axis_of_a_clean_leg():
    recording = leg_recording()
    found = seel_axis(recording.rate[100:])
    for axis, true in zip(found, recording.axes, strict=True):
        assert abs(axis @ true) > np.cos(np.radians(3.0))


def test_both_published_filters_stay_near_each_other():
    assert np.degrees(largest_difference(synthetic(motions()["cycling"], 1))) < 1.8


def test_too_short_a_recording_is_refused():
    with pytest.raises(ValueError, match="not more than"):
        largest_difference(synthetic(motions()["cycling"], 1)[:900])


def test_a_plane_needs_a_direction_across_its_axis():
    leg = record(walking(), 1.0, 20.0)
    with pytest.raises(ValueError, match="parallel"):
        planar(leg.rate, leg.force, leg.axes, leg.axes)
