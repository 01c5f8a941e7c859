"""Fourier shapes: projection, rotation, alignment and derivative against the definition."""

import numpy as np
import pytest

from services.biomech.rhythm.waveform import (
    best_alignment,
    fill_harmonics,
    project,
    rotate,
    second_derivative,
    usable_harmonics,
)

CELL_S, SAMPLE_S = 0.04, 0.01


def value(waveform, phase):
    order = np.arange(1, waveform.shape[2] + 1)
    return waveform[0] @ np.cos(order * phase) + waveform[1] @ np.sin(order * phase)


@pytest.fixture
def waveform():
    return np.random.default_rng(4).standard_normal((2, 3, 7))


def test_harmonics_equal_their_definition():
    harmonic = np.empty((2, 10))
    fill_harmonics(123.4, harmonic)
    order = np.arange(1, 11)
    assert harmonic == pytest.approx(np.stack([np.cos(order * 123.4), np.sin(order * 123.4)]), abs=1e-12)


def test_rotation_moves_the_origin(waveform):
    turned = waveform.copy()
    rotate(turned, 0.7)
    assert value(turned, 0.7 + 0.2) == pytest.approx(value(waveform, 0.2))


def test_alignment_finds_the_phase_of_a_rotated_copy(waveform):
    for phase in (0.0, 1.234, 3.1, 6.0):
        turned = waveform.copy()
        rotate(turned, -phase)
        found = best_alignment(waveform, turned)
        assert np.angle(np.exp(1j * (found - phase))) == pytest.approx(0.0, abs=np.radians(0.5))


def test_second_derivative_equals_finite_differences(waveform):
    harmonic, result, frequency, step = np.empty((2, 7)), np.empty(3), 5.3, 1e-4
    fill_harmonics(2.0, harmonic)
    second_derivative(waveform, harmonic, frequency, result)
    around = [value(waveform, 2.0 + frequency * shift) for shift in (-step, 0.0, step)]
    assert result == pytest.approx((around[0] - 2 * around[1] + around[2]) / step**2, rel=1e-4)


def test_projection_undoes_the_cell_mean(waveform):
    frequency = 2.0 * np.pi / 1.2  # 1.2 s: 30 cells
    samples = np.array([value(waveform, -frequency * SAMPLE_S * past) for past in range(60 * 4)])
    cells = samples.reshape(60, 4, 3).mean(axis=1)
    history = np.zeros((3, 200))
    history[:, 40:100] = cells[::-1].T
    found = np.empty_like(waveform)
    project(history, 99, 60, CELL_S, SAMPLE_S, frequency, 7, found)
    assert found == pytest.approx(waveform, abs=1e-9)


@pytest.mark.parametrize(("frequency_hz", "expected"), [(0.5, 7), (1.0, 7), (1.5, 6), (2.0, 4), (20.0, 1), (0.0, 7)])
def test_harmonics_stay_below_the_limit(frequency_hz, expected):
    assert usable_harmonics(2.0 * np.pi * frequency_hz, 7, 9.0) == expected
