"""Tuning without a reference."""

from dataclasses import replace

import numpy as np
import pytest

from services.biomech.whole_body.constrained_ekf import OURS, FilterSettings
from services.biomech.whole_body.descent import descend, moves
from services.biomech.whole_body.hidden_centres import (
    LANES,
    from_still_part,
    hidden,
    log_misfit,
    misfit,
    tuned_by_hidden_centres,
)
from services.biomech.whole_body.model import CENTRE_NAMES, DOF
from services.biomech.whole_body.parameters import GROUPS, ProcessNoise
from services.biomech.whole_body.tuning import Recording, residuals, surprise

KNEES = [DOF["knee_flexion_right"], DOF["knee_flexion_left"]]


@pytest.fixture
def recording(person) -> Recording:
    """A second of standing, then squats."""
    q = np.concatenate([np.repeat(person.standing()[None], 30, axis=0), person.squats(90)])
    return Recording(person.seen(q, 0.01), np.full((120, 15), 2), person.start(), q[:, 3:])


def with_process(value: float) -> FilterSettings:
    return replace(OURS, process=ProcessNoise.of_groups(np.full(len(GROUPS), value)))


def test_one_of_each_lane_is_hidden_at_a_time_and_all_have_their_turn() -> None:
    mask = hidden(600, 30.0)
    assert not mask[:60].any()
    assert (mask[60:600].sum(axis=1) == len(LANES)).all()
    turns = {str(CENTRE_NAMES[m]) for m in np.flatnonzero(mask.any(axis=0))}
    assert turns == {name for lane in LANES for name in lane}


def test_what_is_hidden_follows_from_the_seed() -> None:
    assert (hidden(300, 30.0, 1) == hidden(300, 30.0, 1)).all()
    assert (hidden(300, 30.0, 1) != hidden(300, 30.0, 2)).any()


def test_a_filter_that_lags_foretells_worse(recording: Recording) -> None:
    assert misfit(recording, with_process(1e-3)) > 1.5 * misfit(recording, with_process(300.0))


def test_the_truth_is_not_looked_at(recording: Recording) -> None:
    assert misfit(recording._replace(angles=None), OURS) == misfit(recording, OURS)


def test_jumps_of_the_hidden_centre_count_no_more_than_far(recording: Recording) -> None:
    spoilt = recording.centres.copy()
    spoilt[100, 3] += 50.0
    assert misfit(recording._replace(centres=spoilt), OURS) < misfit(recording, OURS) + 0.15**2


def test_too_short_a_recording_is_told(recording: Recording) -> None:
    short = recording._replace(centres=recording.centres[:60], state=recording.state[:60])
    with pytest.raises(ValueError, match="hidden"):
        misfit(short, OURS)


def test_camera_noise_comes_from_the_still_part_and_the_process_is_neutral(recording: Recording) -> None:
    found = from_still_part(recording, 30)
    assert found.camera.variance == pytest.approx(1e-4, rel=0.3)
    assert found.camera.along < 0.01
    assert set(found.process.groups()) == {100.0}
    assert found.priors == OURS.priors


def test_a_stiff_filter_is_made_to_follow(recording: Recording) -> None:
    stiff = with_process(1e-2)
    told = [recording._replace(angles=None)]
    tuned = tuned_by_hidden_centres(
        told, stiff, sweeps=1, factor=30.0, judge=lambda batch: [log_misfit(told, one, (0,)) for one in batch]
    )
    before, after = (np.mean(np.square(residuals([recording], s, KNEES))) for s in (stiff, tuned))
    assert misfit(recording, tuned) < misfit(recording, stiff)
    assert after < 0.7 * before


def test_coloured_noise_misleads_the_likelihood_but_not_hidden_centres(person) -> None:
    """Centres that wander slowly: the likelier of two filters is the worse one, the better one foretells better."""
    q = np.concatenate([np.repeat(person.standing()[None], 30, axis=0), person.squats(270)])
    generator, keep = np.random.default_rng(1), np.exp(-1.0 / 30.0)
    wander = np.zeros((300, 15, 3))
    for k in range(1, 300):
        wander[k] = keep * wander[k - 1] + 0.03 * np.sqrt(1 - keep**2) * generator.normal(size=(15, 3))
    recording = Recording(person.seen(q, 0.003) + wander, np.full((300, 15), 2), person.start(), q[:, 3:])
    everything = list(range(22))
    trusting, doubting = (
        replace(with_process(100.0), camera=replace(OURS.camera, variance=variance, along=0.0))
        for variance in (1e-5, 3e-3)
    )
    error = [np.mean(np.square(residuals([recording], s, everything))) for s in (trusting, doubting)]
    assert error[1] < error[0]
    assert surprise([recording], trusting) < surprise([recording], doubting)
    assert misfit(recording, doubting) < misfit(recording, trusting)


def test_descent_finds_the_least_of_what_it_moves() -> None:
    """A bowl in the logarithm of the knee's noise and of the camera's variance."""

    def judge(batch) -> list[float]:
        return [
            np.log(one.process.knee / 640.0) ** 2 + np.log(one.camera.variance / 1e-3) ** 2
            for one in batch
        ]  # fmt: skip

    found = descend(judge, with_process(10.0), sweeps=4, factor=8.0, least_gain=1e-6)
    assert found.process.knee == pytest.approx(640.0, rel=0.3)
    assert found.camera.variance == pytest.approx(1e-3, rel=0.3)


def test_every_value_that_is_tuned_has_its_move() -> None:
    changed = [move(OURS, 2.0) for move in moves()]
    assert changed[0].camera.variance == 2.0 * OURS.camera.variance
    assert changed[1].camera.along == 2.0 * OURS.camera.along
    assert (changed[2].process.groups() == 2.0 * OURS.process.groups()).all()
    assert len(changed) == 3 + len(GROUPS)
