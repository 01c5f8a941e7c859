"""Noise of a camera from recordings, with and without a reference."""

import numpy as np
import pytest
from scipy.signal import lfilter

from services.biomech.whole_body.camera_statistics import along_bones, measurement_variance, still_variance
from services.biomech.whole_body.model import CENTRE_NAMES, previous_centres

RATE = 30.0


def all_tracked(frames: int) -> np.ndarray:
    return np.full((frames, 15), 2)


def test_variance_is_that_of_the_camera(person) -> None:
    q = person.squats(200)
    mean, variance = measurement_variance(person.seen(q, 0.02), person.seen(q, 0.0), all_tracked(200))
    assert mean == pytest.approx([0, 0, 0], abs=2e-3)
    assert variance == pytest.approx([4e-4] * 3, rel=0.1)


def test_inferred_centres_do_not_count(person) -> None:
    q = person.squats(200)
    seen, state = person.seen(q, 0.01), all_tracked(200)
    seen[50:90, 3] += 0.5
    state[50:90, 3] = 1
    assert measurement_variance(seen, person.seen(q, 0.0), state)[1] == pytest.approx([1e-4] * 3, rel=0.1)


def test_white_noise_of_a_still_part_needs_no_reference(person) -> None:
    still = np.repeat(person.standing()[None], 300, axis=0)
    found = still_variance(person.seen(still, 0.01), all_tracked(300))
    assert found.shape == (15, 3)
    assert np.median(found) == pytest.approx(1e-4, rel=0.1)


def test_sway_and_outliers_are_not_noise(person) -> None:
    still = np.repeat(person.standing()[None], 300, axis=0)
    seen = person.seen(still, 0.01) + 0.02 * np.sin(2 * np.pi * 0.3 * np.arange(300) / RATE)[:, None, None]
    seen[::50, 4] += 0.3
    assert np.median(still_variance(seen, all_tracked(300))) == pytest.approx(1e-4, rel=0.15)


def test_noise_of_one_axis_and_one_centre_is_told_apart(person) -> None:
    still = np.repeat(person.standing()[None], 300, axis=0)
    seen = person.seen(still, 0.005)
    seen[:, 6, 0] += np.random.default_rng(9).normal(0.0, 0.03, 300)
    found = still_variance(seen, all_tracked(300))
    assert found[6, 0] > 20 * np.median(found)
    assert found[6, 1] < 2 * np.median(found)


def test_an_unseen_centre_has_no_variance(person) -> None:
    still = np.repeat(person.standing()[None], 40, axis=0)
    state = all_tracked(40)
    state[:, 8] = 0
    found = still_variance(person.seen(still, 0.01), state)
    assert np.isnan(found[8]).all()
    assert np.isfinite(np.delete(found, 8, axis=0)).all()


def sliding(person, share: float, frames: int = 900) -> np.ndarray:
    """Squats in which every centre slides along its bone, correlated over 2 s."""
    true = person.seen(person.squats(frames), 0.0)
    seen, keep = true.copy(), np.exp(-1.0 / (RATE * 2.0))
    generator = np.random.default_rng(5)
    for centre, before in previous_centres().items():
        m, p = CENTRE_NAMES.index(centre), CENTRE_NAMES.index(before)
        track = lfilter([np.sqrt(1 - keep**2)], [1.0, -keep], generator.normal(size=frames))
        seen[:, m] += share * track[:, None] * (true[:, m] - true[:, p])
    return seen


def test_lengths_of_bones_say_how_centres_slide_also_in_movement(person) -> None:
    """It grows with the square; what is left without it is nothing, though the person squats."""
    small, large = (along_bones(sliding(person, share), all_tracked(900), RATE) for share in (0.03, 0.06))
    assert large == pytest.approx(4.0 * small, rel=0.05)
    assert along_bones(sliding(person, 0.0), all_tracked(900), RATE) < 1e-12


def test_it_is_what_white_noise_of_that_size_would_show(person) -> None:
    """White noise of variance a in squared bones has a flat spectrum, so it is found again as about a."""
    true = person.seen(person.squats(900), 0.0)
    seen, generator = true.copy(), np.random.default_rng(6)
    m, p = CENTRE_NAMES.index("knee_right"), CENTRE_NAMES.index("hip_right")
    seen[:, m] += 0.05 * generator.normal(size=(900, 1)) * (true[:, m] - true[:, p])
    state = np.zeros((900, 15), dtype=int)
    state[:, [m, p]] = 2
    found = along_bones(seen, state, RATE, below_hz=1.0)
    assert 0.05**2 < found < 2.0 * 0.05**2  # a running median leaves more of white noise there than a mean would


def test_without_a_bone_in_view_there_is_nothing_to_tell(person) -> None:
    with pytest.raises(ValueError, match="no bone"):
        along_bones(person.seen(person.squats(90), 0.0), np.ones((90, 15), dtype=int), RATE)
    with pytest.raises(ValueError, match="2 s"):
        along_bones(person.seen(person.squats(30), 0.0), all_tracked(30), RATE)
