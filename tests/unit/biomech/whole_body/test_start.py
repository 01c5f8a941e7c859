"""Where the filter starts, and when it may presume a standing person."""

import numpy as np
import pytest

from services.biomech.whole_body.model import DOF
from services.biomech.whole_body.multibody_kinematics import fit_frame
from services.biomech.whole_body.start import fitted_start, is_standing, measured_lengths, standing_start


def second(person, q: np.ndarray, std: float = 0.01) -> tuple[np.ndarray, np.ndarray]:
    return person.seen(np.repeat(q[None], 30, axis=0), std), np.full((30, 15), 2)


def test_standing_still_is_standing(person) -> None:
    assert is_standing(*second(person, person.standing()))


def test_sitting_is_not(person) -> None:
    q = person.standing()
    for side in ("right", "left"):
        q[3 + DOF[f"hip_flexion_{side}"]] = q[3 + DOF[f"knee_flexion_{side}"]] = 1.5
    assert not is_standing(*second(person, q))


def test_moving_is_not(person) -> None:
    q = person.squats(60)[20:50]
    assert not is_standing(person.seen(q, 0.01), np.full((30, 15), 2))


def test_a_missing_knee_is_not(person) -> None:
    centres, state = second(person, person.standing())
    state[:, 10] = 0
    assert not is_standing(centres, state)


def test_a_standing_start_has_the_posture_of_people_and_biases(person) -> None:
    start = standing_start(*second(person, person.standing()), 1.7)
    assert start.standing
    assert start.q[3:] == pytest.approx(person.standing()[3:])
    assert start.lengths == pytest.approx(person.lengths)
    assert start.q[:3] == pytest.approx([0.0, 0.0, 0.0], abs=0.02)


def test_stature_may_be_told_by_the_camera(person) -> None:
    start = standing_start(*second(person, person.standing()), None)
    assert start.lengths == pytest.approx(person.lengths, rel=0.05)
    assert (np.diag(start.length_covariance) > np.diag(person.start().length_covariance)).all()


def test_a_turned_person_starts_turned(person) -> None:
    q = person.standing()
    q[3] = 0.9
    assert standing_start(*second(person, q), 1.7).q[3] == pytest.approx(0.9, abs=0.1)


def test_a_fitted_start_has_no_biases(person) -> None:
    q = person.squats(46)[45]
    fit = fit_frame(person.centres(q), person.tracked)
    start = fitted_start(fit.q, fit.lengths)
    assert not start.standing
    knee = 3 + DOF["knee_flexion_right"]
    assert np.degrees(abs(start.q[knee] - q[knee])) < 5.0


def test_lengths_are_measured_where_both_ends_are_there(person) -> None:
    centres = person.centres(person.standing())
    centres[14] = np.nan
    lengths = measured_lengths(person.body, centres)
    assert np.isnan(lengths[4])
    assert np.delete(lengths, 4) == pytest.approx(np.delete(person.lengths, 4))
