"""Tuning with and without a reference."""

from dataclasses import replace

import numpy as np
import pytest

from services.biomech.whole_body.camera_statistics import measurement_variance
from services.biomech.whole_body.constrained_ekf import FilterSettings
from services.biomech.whole_body.model import DOF
from services.biomech.whole_body.parameters import NO_PRIORS, CameraNoise, ProcessNoise
from services.biomech.whole_body.tuning import (
    Recording,
    Search,
    frequency_tuned,
    replay,
    residuals,
    surprise,
    tuned_against_reference,
    tuned_by_innovations,
)

KNEES = [DOF["knee_flexion_right"], DOF["knee_flexion_left"]]
STIFF = FilterSettings(
    camera=CameraNoise(variance=1e-4, along=0.0), process=ProcessNoise.of_groups(np.full(11, 1e-2)), priors=NO_PRIORS
)


@pytest.fixture
def recording(person) -> Recording:
    q = person.squats(100)
    return Recording(person.seen(q, 0.01), np.full((100, 15), 2), person.start(), q[:, 3:])


def rms(recording: Recording, settings: FilterSettings) -> float:
    return float(np.degrees(np.sqrt(np.mean(residuals([recording], settings, KNEES) ** 2))))


def test_variance_is_that_of_the_camera(person) -> None:
    q = person.squats(200)
    mean, variance = measurement_variance(person.seen(q, 0.02), person.seen(q, 0.0), np.full((200, 15), 2))
    assert mean == pytest.approx([0, 0, 0], abs=2e-3)
    assert variance == pytest.approx([4e-4] * 3, rel=0.1)


def test_frequency_tells_fast_groups_from_slow_ones(person) -> None:
    process = frequency_tuned(person.squats(300), 30.0)
    assert process.held
    assert process.knee > 10.0 * process.trunk
    assert process.knee > process.base_rotation


def test_reference_makes_a_stiff_filter_follow(recording: Recording) -> None:
    tuned = tuned_against_reference([recording], STIFF, KNEES, Search(1e-3, 1e5, evaluations=4))
    assert rms(recording, tuned) < 0.7 * rms(recording, STIFF)


def test_innovations_alone_do_so_too(recording: Recording) -> None:
    tuned = tuned_by_innovations([recording], STIFF, sweeps=1, factor=10.0)
    assert surprise([recording], tuned) < surprise([recording], STIFF)
    assert rms(recording, tuned) < 0.7 * rms(recording, STIFF)


def test_without_a_reference_tuning_says_so(recording: Recording) -> None:
    with pytest.raises(ValueError, match="hide centres"):
        residuals([recording._replace(angles=None)], STIFF, KNEES)


def test_replay_is_the_filter(recording: Recording) -> None:
    angles, ekf = replay(recording)
    assert (angles[-1] == ekf.angles).all()
    other, _ = replay(recording, replace(FilterSettings(), constrained=False))
    assert angles.shape == other.shape == (100, 22)
