"""The knee from two sensors on recordings: what was reached must hold."""

import numpy as np
import pytest

from schemas.vocabulary import Side
from services.bench.knee.hinge_board import FIRST_S, HINGE
from services.bench.knee.recordings import KneeRecording, from_manifest, weygers
from services.bench.knee.scores import FLEXION, FROM_SENSORS, STD, VALID, Pass, axis_errors, run_knee, score
from services.bench.knee.worn_board import ALBORNO, FAN, NEURA, PARAMETERS, SCORED_ALBORNO, STRAIGHT, WITH_TURN
from services.ingest.errors import MissingFile

HINGES = {"01": 1.35, "02": 0.85, "05": 1.2}
"""deg, absolute, at zero shift where the truth is intact: 1.24, 0.78 and 1.11 were reached."""


def load(reader, *arguments) -> KneeRecording:
    try:
        return reader(*arguments)
    except MissingFile as missing:
        pytest.skip(str(missing))


@pytest.mark.parametrize("trial", list(HINGES))
def test_hinge(trial):
    recording = load(weygers, trial)
    out, estimator = run_knee(recording, HINGE)
    sense = np.sign(np.sum(estimator.axes * recording.axes))
    asked = recording.holds & (np.arange(len(out)) >= FIRST_S * recording.rate_hz)
    s = score(sense * out[:, FROM_SENSORS], recording.flexion, asked, out[:, VALID] > 0, out[:, STD], absolute=True)
    assert np.degrees(s.unshifted.absolute_rmse) < HINGES[trial]
    assert s.coverage > 0.95
    assert s.within_two_std > 0.95
    assert np.degrees(axis_errors(estimator.axes, recording.axes)).max() < 2.0
    assert estimator.slips == 0


def test_truth_of_one_hinge_is_broken_for_a_moment():
    assert np.flatnonzero(~load(weygers, "01").holds).tolist() == list(range(743, 751))
    assert load(weygers, "02").holds.all()


def test_drop_landings():
    recording = load(from_manifest, FAN, Side.LEFT)
    out, estimator = run_knee(recording, PARAMETERS)
    s = score(out[:, FLEXION], recording.flexion, recording.holds, out[:, VALID] > 0, out[:, STD])
    assert np.degrees(s.unshifted.zero_mean_rmse) < 0.9
    assert s.within_two_std > 0.95
    assert estimator.reading().is_sign_known
    assert estimator.slips == 0


def test_sit_to_stand():
    recording = load(from_manifest, ALBORNO, Side.LEFT)
    out, estimator = run_knee(recording, PARAMETERS)
    frames = np.arange(len(out))
    asked = recording.holds & (frames >= SCORED_ALBORNO[0]) & (frames < SCORED_ALBORNO[1])
    s = score(out[:, FLEXION], recording.flexion, asked, out[:, VALID] > 0, out[:, STD])
    assert np.degrees(s.unshifted.zero_mean_rmse) < 1.1
    assert s.coverage == 1.0
    assert estimator.slips == 0


@pytest.mark.parametrize(("seen", "straight", "with_turn"), [(Pass.COLD, 3.3, 3.4), (Pass.SECOND, 3.5, 3.7)])
def test_walk_with_a_turn(seen, straight, with_turn):
    """3.16 and 3.20 were reached cold, 3.32 and 3.52 in a second pass; no slip is seen in soft tissue."""
    errors = []
    for side in Side:
        recording = load(from_manifest, NEURA["neura"], side)
        out, estimator = run_knee(recording, PARAMETERS, seen)
        assert estimator.slips == 0
        for frames in (STRAIGHT, WITH_TURN):
            asked = np.zeros(len(out), dtype=np.bool_)
            asked[frames] = recording.holds[frames]
            s = score(out[:, FLEXION], recording.flexion, asked, out[:, VALID] > 0, out[:, STD])
            errors.append(np.degrees(s.shifted.zero_mean_rmse))
            assert s.within_two_std > 0.85
    assert np.mean(errors[::2]) < straight
    assert np.mean(errors[1::2]) < with_turn
