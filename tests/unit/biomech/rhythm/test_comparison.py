"""The distance of two legs does what its definition says."""

import numpy as np
import pytest

from services.biomech.rhythm.comparison import Leg, best_shift, compare_legs

ORDER = np.arange(1, 8)


def leg(seed: int, spread: float = 0.01, strides: int = 10) -> Leg:
    rng = np.random.default_rng(seed)
    cosine, sine = 0.4 * rng.standard_normal((2, 2, 7)) / ORDER
    return Leg(cosine, sine, np.full((2, 7), spread), strides)


def changed(leg: Leg, shift: float = 0.0, scale: float = 1.0) -> Leg:
    """The leg with b(W + shift) = scale a(W)."""
    z = scale * (leg.cosine - 1j * leg.sine) * np.exp(-1j * ORDER * shift)
    return leg._replace(cosine=z.real, sine=-z.imag)


@pytest.mark.parametrize("shift", [-3.0, -0.004, 0.0, 1.7, np.pi])
def test_a_shifted_leg_is_no_distance_away_and_the_shift_is_found(shift):
    result = compare_legs(leg(1), changed(leg(1), shift))
    assert result.distance < 1e-9
    assert result.shape < 1e-7
    assert np.exp(1j * result.shift) == pytest.approx(np.exp(1j * shift), abs=1e-9)


def test_distance_is_the_rms_difference_of_the_angles_over_the_stride():
    a, b = leg(1), leg(2)
    result = compare_legs(a, b)
    phase = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)

    def angles(of, at):
        return of.cosine @ np.cos(np.outer(ORDER, at)) + of.sine @ np.sin(np.outer(ORDER, at))

    def rms(shift):
        return np.sqrt(np.mean((angles(a, phase) - angles(b, phase + shift)) ** 2))

    assert result.distance == pytest.approx(rms(result.shift), rel=1e-9)
    assert result.distance <= min(rms(shift) for shift in np.linspace(0.0, 2.0 * np.pi, 720)) + 1e-12


def test_distance_is_symmetric_and_the_shift_turns_round():
    there, back = compare_legs(leg(1), leg(2)), compare_legs(leg(2), leg(1))
    assert there.distance == pytest.approx(back.distance)
    assert there.shape == pytest.approx(back.shape)
    assert np.exp(1j * there.shift) == pytest.approx(np.exp(-1j * back.shift))


def test_amplitude_alone_is_distance_but_not_shape():
    result = compare_legs(leg(1), changed(leg(1), 0.8, scale=0.7))
    rms = np.sqrt((leg(1).cosine ** 2 + leg(1).sine ** 2).sum() / 4.0)
    assert result.distance == pytest.approx(0.3 * rms)
    assert result.shape < 1e-7
    assert 0.3 < compare_legs(leg(1), changed(leg(2), 0.0, 5.0)).shape <= 1.0


def test_chance_is_the_distance_that_scatter_alone_makes():
    rng = np.random.default_rng(0)
    truth, strides, spread = leg(1), 10, 0.05

    def learned():
        drawn = rng.standard_normal((2, strides, 2, 7)) * spread
        mean = drawn.mean(axis=1)
        return Leg(truth.cosine + mean[0], truth.sine + mean[1], np.full((2, 7), spread), strides)

    results = [compare_legs(learned(), learned()) for _ in range(300)]
    observed = np.sqrt(np.mean([result.distance**2 for result in results]))
    # One of 28 numbers goes into the shift.
    assert observed == pytest.approx(results[0].chance, rel=0.06)
    assert np.sqrt(np.mean([result.shape**2 for result in results])) == pytest.approx(results[0].shape_chance, rel=0.1)
    assert np.std([result.shift for result in results]) == pytest.approx(results[0].shift_std, rel=0.15)


def test_a_leg_that_does_not_move_is_compared_without_an_exception():
    still = Leg(np.zeros((2, 7)), np.zeros((2, 7)), np.zeros((2, 7)), 5)
    assert compare_legs(still, still).distance == 0.0
    result = compare_legs(still, leg(1))
    assert result.shape == 1.0
    assert np.isfinite(result).all()


def test_other_joints_are_refused():
    other = Leg(np.zeros((1, 7)), np.zeros((1, 7)), np.zeros((1, 7)), 5)
    with pytest.raises(ValueError, match="same joints"):
        compare_legs(leg(1), other)


def test_no_motion_has_a_shift_too():
    assert np.isfinite(best_shift(np.zeros(5, np.complex128)))
