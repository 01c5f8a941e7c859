"""The printed filter, and why it is a baseline only."""

import numpy as np
import pytest

from services.biomech.whole_body.colombel import ColombelCekf
from services.biomech.whole_body.constrained_ekf import WholeBodyEkf
from services.biomech.whole_body.model import DOF
from services.biomech.whole_body.parameters import LIMITS_DEG, StartNoise
from services.biomech.whole_body.presets import CORRECTED, FLAT_PROCESS
from services.biomech.whole_body.start import Start

KNEE = DOF["knee_flexion_right"]


def published(start: Start) -> Start:
    """P0 = I, no biases."""
    ones = StartNoise(1.0, 1.0, 1.0, 1.0, 1.0)
    return start._replace(q_std=np.ones(25), length_covariance=np.eye(12), bias_std=None, noise=ones)


def test_where_no_bound_is_met_it_is_our_filter_without_additions(person) -> None:
    start = published(person.start())
    q = np.repeat(person.standing()[None], 4, axis=0)
    printed, ours = ColombelCekf(start, FLAT_PROCESS), WholeBodyEkf(start, CORRECTED)
    for k, frame in enumerate(person.seen(q, 0.0005)):
        for ekf in (printed, ours):
            ekf.advance(person.dt if k else 0.0, frame, person.tracked)
        assert ours.active == 0
        assert printed.angles == pytest.approx(ours.angles, abs=1e-7)
        assert printed.lengths == pytest.approx(ours.lengths, abs=1e-7)


def test_its_covariance_loses_symmetry_and_it_leaves_its_bounds(person) -> None:
    """A knee seen bent the wrong way by 30 deg for two seconds."""
    q = np.repeat(person.standing()[None], 60, axis=0)
    q[:, 3 + KNEE] = -0.5
    ekf = ColombelCekf(published(person.start()), FLAT_PROCESS)
    lowest, asymmetry = 0.0, 0.0
    with np.errstate(all="ignore"):
        for k, frame in enumerate(person.seen(q, 0.01)):
            ekf.advance(person.dt if k else 0.0, frame, person.tracked)
            lowest = min(lowest, ekf.angles[KNEE])
            asymmetry = max(asymmetry, np.abs(ekf.P - ekf.P.T).max())
    assert asymmetry > 1e-3 or not np.isfinite(ekf.x).all()
    assert not lowest >= np.radians(LIMITS_DEG["knee_flexion"][0])


def test_an_incomplete_frame_is_only_predicted(person) -> None:
    ekf = ColombelCekf(published(person.start()), FLAT_PROCESS)
    before = ekf.x.copy()
    frame = person.centres(person.standing())
    frame[3] = np.nan
    ekf.advance(person.dt, frame, person.tracked)
    assert ekf.x == pytest.approx(before)
    assert ekf.lengths == pytest.approx(person.lengths)
