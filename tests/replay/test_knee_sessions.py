"""Recordings of thigh and shank through the whole chain: as accurate as the estimator alone, and from the start."""

from functools import cache

import numpy as np
import pytest

from schemas.gait import Stride
from schemas.kinematics import Calibration, JointState
from schemas.metrics import SessionMetrics
from schemas.vocabulary import LOWER_BODY, Side
from services.bench.knee.recordings import KneeRecording, from_manifest, weygers
from services.bench.knee.scores import score
from services.bench.knee.worn_board import ALBORNO, FAN, SCORED_ALBORNO, STRAIGHT
from services.cli.assembly import build_chain
from services.ingest.errors import MissingFile
from services.ingest.source import iter_messages, open_source

NAMES = [dof.name for dof in LOWER_BODY]


@cache
def played(spec: str):
    """All payloads of the chain."""
    try:
        source = open_source(spec, session="knee", estimator="knee_axis")
    except MissingFile as missing:
        pytest.skip(str(missing))
    chain = build_chain(source.describe())
    published = [each for message in iter_messages(source) for each in chain.push(message)]
    return [each.payload for each in published if each.payload is not None]


def load(reader, *arguments) -> KneeRecording:
    try:
        return reader(*arguments)
    except MissingFile as missing:
        pytest.skip(str(missing))


def flexion(spec: str, side: Side, recording: KneeRecording):
    """Angle and validity at each sample of the recording."""
    angle, valid = np.full(len(recording.flexion), np.nan), np.zeros(len(recording.flexion), dtype=np.bool_)
    i = NAMES.index(f"knee_flexion_{side}")
    for state in played(spec):
        if isinstance(state, JointState):
            rows = np.round(np.array(state.captured_ns) / 1e9 * recording.rate_hz).astype(int)
            inside = rows < len(angle)
            angle[rows[inside]] = np.array(state.position)[inside, i]
            valid[rows[inside]] = state.valid[i]
    return angle, valid


def asked(recording: KneeRecording, frames) -> np.ndarray:
    mask = np.zeros(len(recording.flexion), dtype=np.bool_)
    mask[frames[frames < len(mask)]] = True
    return mask & recording.holds


def never_misplaced(spec: str) -> bool:
    return all(not each.misplaced for each in played(spec) if isinstance(each, Calibration))


def test_drop_landings():
    """Offset removed; the estimator alone reaches 0.87 deg where it is valid, which is not from the first second on."""
    recording = load(from_manifest, FAN, Side.LEFT)
    angle, valid = flexion(FAN, Side.LEFT, recording)
    scored = score(angle, recording.flexion, asked(recording, np.arange(150, 6600)), valid)
    assert np.degrees(scored.unshifted.zero_mean_rmse) < 1.05
    assert scored.coverage > 0.99
    assert never_misplaced(FAN)


def test_sit_to_stand_with_a_marked_standing_is_right_absolutely():
    recording = load(from_manifest, ALBORNO, Side.LEFT)
    angle, valid = flexion(ALBORNO, Side.LEFT, recording)
    scored = score(angle, recording.flexion, asked(recording, np.arange(*SCORED_ALBORNO)), valid)
    assert np.degrees(scored.unshifted.zero_mean_rmse) < 1.35
    assert np.degrees(scored.shifted.absolute_rmse) < 2.2
    assert scored.coverage > 0.99
    assert never_misplaced(ALBORNO)


@pytest.mark.parametrize(("side", "most_deg"), [(Side.RIGHT, 3.3), (Side.LEFT, 4.6)])
def test_a_walk_of_ten_seconds_is_valid_from_its_first_step(side, most_deg):
    """2.9 and 4.2 deg; the estimator alone is valid from half of the walk on."""
    recording = load(from_manifest, "neura_s02_walk", side)
    angle, valid = flexion("neura_s02_walk", side, recording)
    scored = score(angle, recording.flexion, asked(recording, STRAIGHT), valid)
    assert np.degrees(scored.shifted.zero_mean_rmse) < most_deg
    assert scored.coverage == 1.0
    assert never_misplaced("neura_s02_walk")


@pytest.mark.parametrize(("trial", "most_deg"), [("01", 2.6), ("02", 1.6)])
def test_hinge(trial, most_deg):
    """Which way a hinge bends is a convention, and so is its zero."""
    recording, spec = load(weygers, trial), f"weygers_hinge_{trial}"
    angle, valid = flexion(spec, Side.RIGHT, recording)
    assert valid.mean() > 0.8
    frames = np.arange(round(5 * recording.rate_hz), len(angle))
    errors = [score(sense * angle, recording.flexion, asked(recording, frames), valid) for sense in (1.0, -1.0)]
    assert min(np.degrees(each.unshifted.zero_mean_rmse) for each in errors) < most_deg
    assert never_misplaced(spec)


def test_other_sensors_beside_a_leg_keep_nobody_waiting():
    """Pelvis and feet are worn, and not used: events come from the knees' own shanks."""
    payloads = played("synthetic:walk?duration=20&seed=5&feet=1")
    strides = [each for each in payloads if isinstance(each, Stride) and each.valid]
    assert {stride.side for stride in strides} == set(Side)
    (calibration,) = [each for each in payloads if isinstance(each, Calibration)]
    assert set(calibration.unused) == {"pelvis", "foot_left", "foot_right"}


def test_a_synthetic_walk_of_one_leg_gives_strides_with_knee_curves_and_metrics():
    payloads = played("synthetic:walk?worn=1&duration=30&seed=5")
    strides = [each for each in payloads if isinstance(each, Stride) and each.valid]
    assert len(strides) >= 12
    assert all(list(stride.curves) == ["knee_flexion_left"] for stride in strides)
    assert strides[0].start_ns < 8e9, "nothing of the walk is lost"
    metrics = [each for each in payloads if isinstance(each, SessionMetrics)][-1]
    values = {(metric.name, metric.side): metric.value for metric in metrics.metrics}
    assert values["stance_fraction", Side.LEFT] == pytest.approx(0.62, abs=0.02)
    assert values["cadence", None] == pytest.approx(104.0, abs=4.0)
