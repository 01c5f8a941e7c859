"""Mean stride in angles: right coefficients and spread, only whole good strides, and the same after a resume."""

import json

import numpy as np
import pytest

from services.biomech.rhythm.learned import LearnedStrides, velocity_waveform
from services.biomech.rhythm.reading import RhythmReading

DT_S = 0.01
COSINE = np.array([[0.30, -0.10, 0.05], [0.0, 0.20, 0.0]])
SINE = np.array([[0.10, 0.25, 0.0], [-0.40, 0.0, 0.03]])


def take_strides(
    learned: LearnedStrides, count: float, frequency: float = 6.0, scale: float = 1.0, start: float = 0.0
) -> None:
    """Velocities of the angles COSINE, SINE times `scale`, with the phase as a perfect rhythm would give it."""
    a, b = velocity_waveform(scale * COSINE, scale * SINE, frequency)
    for phase in np.arange(start, start + 2.0 * np.pi * count, frequency * DT_S):
        order = phase * np.arange(1, 4)
        take(learned, a @ np.cos(order) + b @ np.sin(order), float(phase))


def take(learned: LearnedStrides, velocity, phase: float, *, locked: bool = True, quality: float = 0.9) -> None:
    learned.take(velocity.tolist(), RhythmReading(phase, 6.0, quality, locked, np.zeros(2)), DT_S)


def test_the_velocity_of_known_angles_is_their_derivative():
    phase, frequency, step = 0.7, 5.0, 1e-6
    order = np.arange(1, 4)

    def angle(at):
        return COSINE @ np.cos(order * at) + SINE @ np.sin(order * at)

    a, b = velocity_waveform(COSINE, SINE, frequency)
    expected = (angle(phase + step) - angle(phase - step)) / (2 * step) * frequency
    assert a @ np.cos(order * phase) + b @ np.sin(order * phase) == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("frequency", [3.0, 6.0, 9.0])
def test_angles_come_out_of_velocities_at_any_speed(frequency):
    learned = LearnedStrides(2, harmonics=5)
    take_strides(learned, 10.5, frequency, start=0.5)
    result = learned.result()
    assert result.frequency == pytest.approx(frequency, rel=1e-3)
    assert result.cosine[:, :3] == pytest.approx(COSINE, abs=2e-3)
    assert result.sine[:, :3] == pytest.approx(SINE, abs=2e-3)
    assert np.abs(result.cosine[:, 3:]).max() < 2e-3
    assert result.spread.max() < 2e-3


def test_only_whole_strides_with_a_successor_count():
    learned = LearnedStrides(2)
    take_strides(learned, 5.5, start=1.0)
    # The start and the end are no whole strides, and the last whole one has none after it: 5 boundaries, 4 whole.
    assert learned.strides == 3


def test_spread_is_that_of_the_strides():
    learned = LearnedStrides(2, harmonics=3)
    scales = [0.9, 1.1, 0.9, 1.1, 0.9, 1.1, 1.0]
    frequency = 2.0 * np.pi / 1.0
    take(learned, np.zeros(2), -0.01)
    for stride, scale in enumerate(scales):
        take_strides(learned, 1.0, frequency, scale, start=2.0 * np.pi * stride)
    take(learned, np.zeros(2), 2.0 * np.pi * len(scales) + 0.01)
    result = learned.result()
    assert result.strides == 6
    expected = np.std(scales[:6], ddof=1) * np.sqrt((COSINE**2 + SINE**2) / 2.0)
    assert result.spread == pytest.approx(expected, abs=5e-3)


@pytest.mark.parametrize("fault", ["unlocked", "poor", "jump"])
def test_a_stride_that_does_not_hold_together_does_not_count(fault):
    learned = LearnedStrides(2)
    take_strides(learned, 4.01)
    before = learned.strides
    phase = 2.0 * np.pi * 4.5
    take(learned, np.zeros(2), phase, locked=fault != "unlocked", quality=0.3 if fault == "poor" else 0.9)
    if fault == "jump":
        take(learned, np.zeros(2), phase + 2.0)
    take_strides(learned, 0.7, start=phase + 0.06)
    assert learned.strides == before


def test_split_and_resume_is_bit_identical():
    whole, first, second = LearnedStrides(2), LearnedStrides(2), LearnedStrides(2)
    take_strides(whole, 6.3)
    take_strides(whole, 3.0, start=2.0 * np.pi * 6.3)
    take_strides(first, 6.3)
    second.restore(json.loads(json.dumps(first.snapshot())))
    take_strides(second, 3.0, start=2.0 * np.pi * 6.3)
    for one, other in zip(whole.result(), second.result(), strict=True):
        assert np.array_equal(one, other)


def test_nothing_learned_is_zero_strides():
    result = LearnedStrides(2).result()
    assert (result.strides, result.frequency, result.quality) == (0, 0.0, 0.0)
    assert not result.cosine.any()
