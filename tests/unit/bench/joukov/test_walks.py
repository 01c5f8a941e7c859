"""The synthetic walks of the whole filter's scoreboard, and what is made of the errors on them."""

from functools import cache

import numpy as np
import pytest

from services.bench.joukov.disturbed_walks import DisturbedWalk
from services.bench.joukov.varied_walks import VariedWalk
from services.bench.joukov.walk_bands import CASES, Band, band_rows, told, within
from services.bench.joukov.walk_curves import FILTERS, GRID, OURS, PLAIN, WalkCurves, curve_rows, pair_rmse
from services.bench.joukov.walk_falls import KINDS, TUNINGS, Fall, disturbed_walk, fall_rows, parts_of
from services.bench.joukov.walk_recordings import INSTANTANEOUS, WalkRecording, with_noise
from services.bench.joukov.walks import SEED, WalkStudies, run, walk_charts, walk_rows
from services.bench.rhythm.stride_shapes import HARMONICS, StrideShapes
from services.biomech.lower_body_ekf import NoiseModel
from services.ingest.synthetic import SyntheticWalk, WalkParameters

DRAWN = np.random.default_rng(0).standard_normal((4, HARMONICS + 1, 2)) @ np.array([1.0, 1.0j])
STRIDE = DRAWN * 0.3 / np.arange(1, HARMONICS + 2) ** 2
SHAPES = StrideShapes(np.stack([STRIDE, 1.05 * STRIDE]))


@cache
def noisy() -> WalkRecording:
    options = "seed=5&duration=45&rate=50&gyro_noise=0.05&accel_noise=0.2&soft_tissue=0.035"
    return WalkRecording(SyntheticWalk(WalkParameters.parse(options)))


@cache
def stumbling() -> tuple[DisturbedWalk, WalkRecording]:
    walk = disturbed_walk("stumbles", "quiet sensors", 3)
    return walk, WalkRecording(walk)


def makers():
    for kind in KINDS:
        yield disturbed_walk(kind, "quiet sensors", 7)
    yield VariedWalk(WalkParameters.parse("seed=7&duration=40"), SHAPES)


@pytest.mark.parametrize("walk", list(makers()), ids=[*KINDS, "varied"])
def test_truth_is_consistent(walk) -> None:
    """Velocity is the slope of the angle and acceleration that of the velocity, disturbed or not."""
    time_s = np.arange(0.0, walk.parameters.duration, 0.002)
    angles = walk.gait.angles(walk.strides(time_s))
    for name in ("hip_flexion_right", "knee_flexion_left"):
        jet = angles[name]
        for of, slope in ((jet.value, jet.rate), (jet.rate, jet.acceleration)):
            error = (np.gradient(of, 0.002) - slope)[2:-2]
            assert np.std(error) < 0.02 * np.std(slope)
    still = time_s < 3.9
    assert not angles["hip_flexion_right"].rate[still].any()


@pytest.mark.parametrize("kind", KINDS)
def test_disturbed_and_walking_parts_are_apart(kind: str) -> None:
    walk = disturbed_walk(kind, "quiet sensors", 7)
    time_s = np.arange(0.0, walk.parameters.duration, 0.01)
    disturbed, walking = parts_of(walk, kind, time_s)
    assert not (disturbed & walking).any()
    assert disturbed.mean() > 0.05
    assert walking.mean() > 0.05


def test_stumbles_disturb_and_pass() -> None:
    walk, _ = stumbling()
    plain = SyntheticWalk(walk.parameters)
    time_s = np.arange(0.0, walk.parameters.duration, 0.01)
    knee, undisturbed = (w.gait.angles(w.strides(time_s))["knee_flexion_right"].value for w in (walk, plain))
    calm = time_s < min(jolt.start_s for jolt in walk.jolts)
    np.testing.assert_allclose(knee[calm], undisturbed[calm], atol=1e-12)
    assert np.abs(knee - undisturbed).max() > 0.15
    np.testing.assert_allclose(knee[-100:], undisturbed[-100:], atol=1e-9)


def test_rhythm_halves_the_acceleration_error_and_leaves_the_position() -> None:
    recording = noisy()
    late = (recording.time_s > 25.0) & (recording.time_s < 39.0)
    plain, ours = (pair_rmse(recording, recording.estimate(name).state, late) for name in ("ekf", "rhythmic_ekf"))
    assert (ours[2] < 0.5 * plain[2]).all()
    np.testing.assert_allclose(ours[0], plain[0], rtol=0.02)


def test_where_the_stride_breaks_off_nothing_is_lost() -> None:
    walk, recording = stumbling()
    disturbed, _ = parts_of(walk, "stumbles", recording.time_s)
    plain, ours = (pair_rmse(recording, recording.estimate(name).state, disturbed) for name in ("ekf", "rhythmic_ekf"))
    assert (ours < 1.02 * plain).all()


def test_deviations_hold_the_truth() -> None:
    recording = noisy()
    estimates = recording.estimate("rhythmic_ekf", told(0.035))
    when = (recording.time_s > 10.0) & (recording.time_s < 39.0)
    held = within((estimates.state - recording.truth)[0, when], estimates.std[0, when])
    untold = recording.estimate("rhythmic_ekf", told(0.0)).std[0, when]
    assert (held > 90.0).all()
    assert (untold < estimates.std[0, when]).all()


def test_scores_compare_the_same_instant() -> None:
    """Half an interval of shift would be seen at once: velocity errors are far below what it makes."""
    recording = noisy()
    late = (recording.time_s > 25.0) & (recording.time_s < 39.0)
    estimate = recording.estimate("rhythmic_ekf", with_noise(INSTANTANEOUS, 1e5)).state
    errors = [pair_rmse(recording, np.roll(estimate, k, axis=1), late)[1].mean() for k in (-1, 0, 1)]
    assert errors[1] < 0.6 * min(errors[0], errors[2])


def test_default_tuning_is_on_the_curve() -> None:
    assert GRID[7] * 0.01 == pytest.approx(NoiseModel().jerk_density, rel=0.1)
    assert TUNINGS["S by default"] == pytest.approx(GRID[7])


def made_up() -> WalkStudies:
    walks, flat = 2, np.ones((2, GRID.size, 3, 2))
    errors = {name: flat * (1.0 if name == PLAIN else 0.8) for name in FILTERS}
    errors[OURS] = flat * np.linspace(0.5, 1.5, GRID.size)[:, None, None]
    falls = [
        Fall(kind, "quiet sensors", tuning, np.full((3, 2), 1.01), np.full((3, 2), 0.5))
        for kind in KINDS
        for tuning in TUNINGS
    ]
    bands = [
        Band(case, np.array([95.0, 85.0]), np.array([95.0, 95.0]), np.array([99.0, 99.0]), np.array([0.02, 0.03]))
        for case in CASES
        for _ in range(walks)
    ]
    return WalkStudies([WalkCurves("steady", errors)], falls, bands, [])


def test_rows_say_what_was_missed() -> None:
    studies = made_up()
    curves = studies.curves[0]
    np.testing.assert_allclose(curves.best(OURS), 0.5)
    np.testing.assert_allclose(curves.same_S(OURS)[-1], 1.5)
    first = curve_rows(curves, 0.4)[0]
    assert (first.value, first.met, first.baseline) == (pytest.approx(0.5), False, pytest.approx(0.8))
    assert all(row.met is not False for row in fall_rows(studies.falls))
    assert [row.name for row in band_rows(studies.bands) if row.met is False] == [
        "truth within 2 std, knee, absolute: lowest case"
    ]
    rows = walk_rows(studies)
    assert len({row.name for row in rows}) == len(rows)
    charts = walk_charts(studies)
    assert all(svg.startswith("<svg") for svg in charts.values())
    assert len(charts) == 4


def test_at_least_one_walk() -> None:
    with pytest.raises(ValueError, match="at least 1"):
        run(None, 0)
    assert SEED >= 1000
