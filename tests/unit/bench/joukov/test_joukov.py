"""Motions, tuning and ratios of the Rhythmic EKF's scoreboard, and a small run of it."""

import math
from xml.etree import ElementTree

import numpy as np
import pytest

from services.bench.joukov.curve import curve_rows, median_ratio, worse_percent, worst_ratio
from services.bench.joukov.motions import knee, motion_kinds, perfect_samples, random_periodic, stumbling_knee, sweep
from services.bench.joukov.simulation import add_bins, lag_ms, simulation_rows, study_sweep
from services.bench.joukov.study import (
    DECADE,
    GRID,
    Study,
    best_index,
    locks_on_fundamental,
    study_motion,
    track_errors,
)
from services.bench.line_chart import HEIGHT, WIDTH, line_chart
from services.bench.registry import joukov
from services.bench.rhythm.motions import INTERVAL_S
from services.bench.rhythm.stride_shapes import HARMONICS, StrideShapes
from services.biomech.single_joint.rhythmic import Track

DRAWN = np.random.default_rng(0).standard_normal((4, HARMONICS + 1, 2)) @ np.array([1.0, 1.0j])
STRIDE = DRAWN * 0.3 / np.arange(1, HARMONICS + 2) ** 2
SHAPES = StrideShapes(np.stack([STRIDE, 1.05 * STRIDE]))
KINDS = {"sweep": sweep, **motion_kinds(SHAPES)}


@pytest.mark.parametrize("kind", KINDS)
def test_a_seed_is_a_motion_of_consistent_truth(kind):
    one, two, other = KINDS[kind](7), KINDS[kind](7), KINDS[kind](8)
    assert np.array_equal(one.samples, two.samples)
    assert not np.array_equal(one.samples, other.samples)
    for of, derivative in ((0, 1), (1, 2)):
        slope, truth = np.gradient(one.state[:, of], INTERVAL_S)[1:-1], one.state[1:-1, derivative]
        assert np.std(slope - truth) < 0.08 * np.std(truth)
    noise = one.samples - perfect_samples(one.state)
    assert np.std(noise, axis=0) == pytest.approx([0.5, 2.0, 2.0], rel=0.05)
    assert abs(np.mean(one.state[:, 0])) < 1e-9
    assert one.guess / one.frequency in (pytest.approx(0.85), pytest.approx(1.15))


def test_sweep_goes_from_one_to_five():
    motion = sweep(3, hold_s=40.0)
    frequency = np.gradient(motion.phase, INTERVAL_S)
    assert frequency[:3999] == pytest.approx(np.ones(3999))
    assert frequency[-1] == pytest.approx(5.0, rel=1e-3)


def test_random_motions_keep_their_strength():
    rms = [np.sqrt(np.mean(random_periodic(seed).state[:, 1] ** 2)) for seed in range(20)]
    assert min(rms) >= 0.5
    assert max(rms) <= 4.0


def test_a_stumble_breaks_the_stride():
    walk, stumble = knee(3, SHAPES).state[:, 1], stumbling_knee(3, SHAPES).state[:, 1]
    assert walk[:1400] == pytest.approx(stumble[:1400])
    assert np.max(np.abs(walk[1500:] - stumble[1500:])) > 1.0


def study(*ratios: tuple[float, float, float]) -> Study:
    """S* at the middle of the grid; the trusted filter has these ratios at S*/10 and S*."""
    base = np.ones((GRID.size, 3))
    base[: GRID.size // 2, 0] = 2.0
    trusted, published = base.copy(), base * 1.1
    best = GRID.size // 2
    trusted[best - DECADE] *= ratios[0]
    trusted[best] *= ratios[1]
    curves = {"plain": base, "published": published, "trusted": trusted, "7 harmonics": published}
    return Study(curves, {"gate": np.full((2, 3), 1.03)})


def test_best_is_the_smallest_within_one_percent():
    curve = np.ones((GRID.size, 3))
    curve[:, 0] = [0.1, 0.1, 3.0, 2.0, 1.5, 1.009, 1.0, 1.0, 1.005, 1.01, 1.2]
    assert best_index(curve) == 5


def test_ratios_at_both_tunings():
    good, bad = study((0.9, 0.8, 0.3), (1.0, 1.0, 0.9)), study((1.0, 1.0, 0.5), (1.0, 1.03, 1.0))
    assert median_ratio([good, bad], "trusted", True) == pytest.approx([0.95, 0.9, 0.4])
    assert median_ratio([good, bad], "trusted", False) == pytest.approx([1.0, 1.015, 0.95])
    assert worst_ratio([good, bad], "trusted") == pytest.approx(1.03)
    assert worse_percent([good, bad], "trusted", False) == 50.0
    assert good.ratio("gate", False) == pytest.approx([1.03] * 3)
    assert good.ratio("gate", True) == pytest.approx([0.515, 1.03, 1.03])


def test_rows_hold_the_limits():
    good, bad = study((0.9, 0.8, 0.3), (1.0, 1.0, 0.9)), study((1.0, 1.0, 0.5), (1.0, 1.03, 1.0))
    rows = {row.name: row for row in curve_rows("random", [good])}
    assert rows["random at S*/10: acceleration"].met
    assert rows["random at S*: acceleration"].met
    assert rows["random at S*/10: acceleration"].baseline == pytest.approx(1.1)
    rows = {row.name: row for row in curve_rows("smooth", [good, bad])}
    assert rows["smooth: worst run"].met is False


def test_angles_are_compared_modulo_a_turn():
    motion = sweep(1)
    track = Track(motion.state + np.array([2.0 * np.pi + 0.1, 0.0, 0.0]), np.zeros((motion.jerk.size, 4)))
    assert track_errors(motion, track)[:, 0] == pytest.approx(np.full(motion.jerk.size - 100, 0.1))


def test_lock_is_judged_by_turns():
    motion = sweep(1)
    for factor, right in ((1.0, True), (1.04, True), (2.0, False), (0.0, False)):
        rhythm = np.ones((motion.jerk.size, 4))
        rhythm[:, 0] = factor * motion.phase
        assert locks_on_fundamental(motion, Track(motion.state, rhythm)) is right


def test_simulation_of_two_motions_beats_the_plain_filter():
    studies = [study_sweep(seed) for seed in (150, 151)]
    rows = {row.name: row for row in simulation_rows("simulation", studies)}
    late = rows["simulation, trusted at S*/10: acceleration"]
    assert late.value < 0.6 * late.baseline
    assert late.baseline == pytest.approx(rows["simulation, published at S*/10: acceleration"].baseline)
    lags = [lag_ms(add_bins([item.bins[name][1] for item in studies])) for name in ("trusted", "plain")]
    assert abs(lags[0]) < 0.6 * lags[1]
    assert 5.0 < lags[1] < 40.0


def test_regression_on_one_motion_of_three_kinds():
    walking, periodic, aimless = (study_motion(KINDS[kind](150)) for kind in ("knee", "random", "smooth"))
    assert np.all(periodic.ratio("trusted", True) < [0.97, 0.92, 0.45])
    assert np.all(walking.ratio("trusted", True) < [0.97, 0.92, 0.85])
    assert worst_ratio([aimless], "trusted") < 1.02


def test_charts_are_drawings():
    svg = line_chart("a < b", "x", "y", {"one": [(1e2, 0.5), (1e6, 1.0)], "two": [(1e3, -1.0)]}, log_x=True)
    root = ElementTree.fromstring(svg)
    assert sum(child.tag.endswith("polyline") for child in root) == 2
    for line in root.iter("{http://www.w3.org/2000/svg}polyline"):
        for point in line.get("points").split():
            x, y = map(float, point.split(","))
            assert 0 <= x <= WIDTH
            assert 0 <= y <= HEIGHT
    gap = line_chart("gap", "x", "y", {"one": [(0.0, 1.0), (1.0, math.nan), (2.0, 1.5), (3.0, 2.0)]}, from_zero=False)
    assert gap.count("<polyline") == 2
    assert "nan" not in gap
    assert line_chart("level", "x", "y", {"one": [(0.0, 1.0)]}, levels={"limit": 3.0}).count("<polyline") == 2
    with pytest.raises(ValueError, match="at least one point"):
        line_chart("empty", "x", "y", {"one": []})


def test_a_number_of_motions_is_asked_for():
    with pytest.raises(ValueError, match="number of motions"):
        joukov(None, "neura")


def test_dots_are_not_joined():
    svg = line_chart("dots", "x", "y", {"one": [(0.0, 1.0), (1.0, 2.0)], "fit": [(0.0, 1.0), (1.0, 2.0)]}, dots={"one"})
    assert svg.count("<polyline") == 1
    assert svg.count('r="1.8"') == 2
