"""The bounded fit of frames and recordings."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from services.biomech.whole_body.model import DOF
from services.biomech.whole_body.multibody_kinematics import FitParameters, fit_frame, fit_recording, smoothed
from services.biomech.whole_body.parameters import LIMITS_DEG, REST_DEG, lengths_of, per_angle

KNEE = 3 + DOF["knee_flexion_right"]


def test_a_frame_is_fitted_as_by_a_general_solver(person) -> None:
    """Knees seen bent the wrong way, so that bounds hold."""
    q = person.squats(20)[19]
    q[KNEE] = -0.3
    centres = person.centres(q) + np.random.default_rng(1).normal(0.0, 0.02, (15, 3))
    parameters = FitParameters(most_steps=100)
    found = fit_frame(centres, person.tracked, person.stature, parameters)
    rest, spread = per_angle(REST_DEG).T
    low, high = per_angle(LIMITS_DEG).T
    mean = lengths_of(person.stature)
    turned = found.q[3]

    def residuals(u: np.ndarray) -> np.ndarray:
        posture = (u[4:25] - rest[1:]) / (parameters.rest_spread * spread[1:])
        lengths = (u[25:] / mean - 1.0) / parameters.length_spread
        return np.concatenate([(centres - person.body.centres(u[:25], u[25:])).ravel() / 0.03, posture, lengths])

    lower = np.concatenate([np.full(3, -9.0), low - 1e-9, 0.8 * mean])
    upper = np.concatenate([np.full(3, 9.0), high + 1e-9, 1.2 * mean])
    inside = np.clip(np.concatenate([found.q, found.lengths]), lower + 1e-6, upper - 1e-6)
    oracle = least_squares(residuals, inside, bounds=(lower, upper), xtol=1e-12, ftol=1e-14)
    ours = np.concatenate([found.q, found.lengths])
    assert found.q[KNEE] == pytest.approx(0.0, abs=1e-12)
    # The oracle leaves the heading free; ours draws it to what hips and shoulders show.
    assert oracle.x[4:] == pytest.approx(ours[4:], abs=0.02)
    assert abs(oracle.x[3] - turned) < 0.02


def test_a_noiseless_recording_gives_its_angles_back(person) -> None:
    q = person.squats(120)
    centres = person.seen(q, 0.0)
    found, lengths = fit_recording(centres, np.full((120, 15), 2), 30.0, parameters=FitParameters(cutoff_hz=0.0))
    assert lengths == pytest.approx(person.lengths, abs=1e-9)
    flexions = [3 + i for name, i in DOF.items() if "flexion" in name and "shoulder" not in name]
    assert np.degrees(np.abs(found - q)[:, flexions]).max() < 0.5


def test_limits_hold_and_missing_centres_are_bridged(person) -> None:
    q = person.squats(60)
    q[:, KNEE] = -0.4
    centres = person.seen(q, 0.01)
    state = np.full((60, 15), 2)
    centres[20:25], state[20:25] = np.nan, 0
    found, _ = fit_recording(centres, state, 30.0)
    assert np.isfinite(found).all()
    assert (found[:, KNEE] >= 0.0).all()


def test_a_centre_never_seen_takes_its_bone_from_the_stature(person) -> None:
    centres = person.seen(person.squats(40), 0.01)
    state = np.full((40, 15), 2)
    state[:, 14] = 0
    centres[:, 14] = np.nan
    found, lengths = fit_recording(centres, state, 30.0, person.stature)
    assert np.isfinite(found).all()
    assert lengths[4] == pytest.approx(person.lengths[4], rel=0.1)


def test_the_low_pass_has_no_delay(person) -> None:
    centres = person.seen(person.squats(90), 0.0)
    assert np.abs(smoothed(centres, np.full((90, 15), 2), 30.0, 4.0) - centres).max() < 0.01


def test_nothing_in_view_says_what_to_do(person) -> None:
    with pytest.raises(ValueError, match="body in view"):
        fit_frame(np.full((15, 3), np.nan), person.tracked)
