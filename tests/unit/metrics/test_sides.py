import numpy as np
import pytest

from schemas.vocabulary import Side
from services.metrics.moments import Moments
from services.metrics.sides import compare_sides

PHASE = 2 * np.pi * np.arange(101) / 100


def moments(curve, scatter: float = 0.0, strides: int = 8) -> Moments:
    found = Moments.empty(101)
    for sign in np.where(np.arange(strides) % 2, 1.0, -1.0):
        found.add(curve + sign * scatter)
    return found


def both(left, right, joint: str = "knee_flexion", **kwargs) -> dict:
    return {f"{joint}_left": moments(left, **kwargs), f"{joint}_right": moments(right, **kwargs)}


def test_equal_legs_do_not_differ():
    [found] = compare_sides(both(0.4 * np.sin(PHASE), 0.4 * np.sin(PHASE)), Side.RIGHT, 3)
    assert (found.joint, found.reference_side, found.strides) == ("knee_flexion", Side.RIGHT, 8)
    assert (found.rmse, found.rmse_std, found.shift) == (0.0, 0.0, 0.0)


def test_a_stiff_knee_differs_by_what_it_lacks():
    """0.6 rad of amplitude against 0.2: the difference 0.4 sin has the rms 0.4 / sqrt 2."""
    [found] = compare_sides(both(0.2 * np.sin(PHASE), 0.6 * np.sin(PHASE)), Side.RIGHT, 3)
    assert found.rmse == pytest.approx(0.4 / np.sqrt(2), abs=1e-6)
    assert found.rmse_about_mean == pytest.approx(found.rmse, abs=1e-6)


def test_a_late_leg_is_moved_back_and_its_level_kept():
    """The left leg does the same 7 % later and 0.1 rad more flexed."""
    late = 0.5 * np.sin(PHASE - 2 * np.pi * 0.07) + 0.1
    [found] = compare_sides(both(late, 0.5 * np.sin(PHASE)), Side.RIGHT, 3)
    assert found.shift == pytest.approx(-0.07)
    assert found.rmse == pytest.approx(0.1, abs=1e-6)
    assert found.rmse_about_mean == pytest.approx(0.0, abs=1e-6)


def test_all_joints_are_moved_by_the_shift_of_flexion():
    late = {name: np.sin(PHASE - 2 * np.pi * 0.1) for name in ("hip_flexion", "hip_adduction")}
    curves = both(late["hip_flexion"], np.sin(PHASE), "hip_flexion")
    curves |= both(0.1 * np.cos(2 * PHASE), 0.1 * np.cos(2 * PHASE), "hip_adduction")
    found = {each.joint: each for each in compare_sides(curves, Side.RIGHT, 3)}
    assert found["hip_adduction"].shift == found["hip_flexion"].shift == pytest.approx(-0.1)
    assert found["hip_flexion"].rmse == pytest.approx(0.0, abs=1e-6)
    assert found["hip_adduction"].rmse > 0.05


def test_the_scatter_alone_gives_what_is_told():
    rng = np.random.default_rng(3)
    distances, expected = [], []
    for _ in range(200):
        legs = {}
        for side in Side:
            legs[f"hip_adduction_{side}"] = Moments.empty(101)
            for _ in range(12):
                legs[f"hip_adduction_{side}"].add(np.append(curve := rng.normal(0.0, 0.05, 100), curve[0]))
        [found] = compare_sides(legs, Side.LEFT, 3)
        distances.append(found.rmse)
        expected.append(found.rmse_std)
    assert np.mean(distances) == pytest.approx(np.mean(expected), rel=0.02)


def test_a_leg_seen_in_too_few_strides_is_not_compared():
    curves = both(PHASE * 0, PHASE * 0)
    curves["knee_flexion_left"] = moments(PHASE * 0, strides=2)
    assert compare_sides(curves, Side.RIGHT, 3) == []
    assert compare_sides({}, Side.RIGHT, 3) == []


def test_the_reference_is_the_leg_that_is_not_paretic():
    [found] = compare_sides(both(0.2 * np.sin(PHASE), 0.6 * np.sin(PHASE)), Side.LEFT, 3)
    assert found.reference_side is Side.LEFT
