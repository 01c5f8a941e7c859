"""Simulated people, motions and camera."""

import numpy as np
import pytest

from services.bench.kinect import methods
from services.bench.kinect.camera import see
from services.bench.kinect.cells import score
from services.bench.kinect.methods import Watched
from services.bench.kinect.motions import trial
from services.ingest.synthetic.whole_body.people import person


@pytest.fixture(scope="module")
def watched() -> Watched:
    """Tilt forward, which needs no recorded squats."""
    who = person(0)
    truth = trial(who, 3)
    return Watched(who, truth, see(truth, 0), "clinic")


def test_a_person_and_a_trial_are_always_the_same(watched: Watched) -> None:
    again = trial(person(0), 3)
    assert (again.q == watched.trial.q).all()
    centres, state = see(again, 0)
    assert np.array_equal(centres, watched.seen.centres, equal_nan=True)
    assert (state == watched.seen.state).all()


def test_the_camera_is_off_by_some_centimetres_and_guesses_at_times(watched: Watched) -> None:
    error = (watched.seen.centres - watched.trial.centres)[watched.seen.state == 2]
    assert 0.02 < error.std() < 0.06
    assert 0.005 < (watched.seen.state == 1).mean() < 0.06
    assert 0.005 < np.isnan(watched.seen.centres[:, 0, 0]).mean() < 0.05


def test_ours_is_nearer_than_each_frame_alone(watched: Watched) -> None:
    ours, alone = (
        np.mean([cell.rmsd_deg for cell in score(3, method(watched), watched.angles)])
        for method in (methods.ours, methods.multibody)
    )
    assert ours < 7.0
    assert ours < 0.7 * alone
