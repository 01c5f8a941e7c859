"""Walks before the simulated camera, made of recorded strides."""

import numpy as np
import pytest

from services.bench.kinect import walks
from services.bench.kinect.camera import see
from services.bench.kinect.walking_section import SCORED, SCORED_FROM, watch
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, LENGTH_NAMES
from services.ingest.errors import MissingFile
from services.ingest.synthetic.whole_body.people import person

RATE_HZ = 100.0


def invented():
    """Two and a half strides of 1.1 s with a drifting heading; the middle one closes best."""
    time_s = np.arange(0.0, 2.75, 1 / RATE_HZ)
    turn = 2 * np.pi * time_s / 1.1
    away = np.where(time_s < 0.6, 8.0 * (0.6 - time_s), 0.0)
    angles = {"pelvis_tilt": 12 + np.sin(2 * turn), "pelvis_obliquity": 3 * np.sin(turn),
              "pelvis_rotation": 40 + 5 * np.cos(turn) + away, "trunk_flexion": 0.0 * turn}  # fmt: skip
    for side, ahead in (("right", 0.0), ("left", np.pi)):
        angles[f"hip_flexion_{side}"] = 17 + 22 * np.cos(turn + ahead)
        angles[f"hip_adduction_{side}"] = 2 + 4 * np.sin(turn + ahead)
        angles[f"hip_internal_rotation_{side}"] = -9 + 3 * np.cos(turn + ahead)
        angles[f"knee_flexion_{side}"] = 30 + 28 * np.sin(turn + ahead - 0.9)
    return angles, RATE_HZ


@pytest.fixture
def invented_walk(monkeypatch):
    monkeypatch.setitem(walks.RECORDINGS, "invented", invented)
    yield "invented"
    walks.stride.cache_clear()


def test_one_stride_is_found_closed_and_freed_of_offsets(invented_walk):
    table, lasts_s = walks.stride(invented_walk)
    assert lasts_s == pytest.approx(1.1, abs=0.011)
    assert table[0] == pytest.approx(table[-1], abs=1e-9)
    for name, half in (("pelvis_rotation", 5.0), ("pelvis_tilt", 1.0), ("hip_adduction_left", 4.0)):
        column = table[:, DOF[name]]
        assert (column.min(), column.max()) == (pytest.approx(-half, abs=0.1), pytest.approx(half, abs=0.1))
    hip, knee = table[:, DOF["hip_flexion_right"]], table[:, DOF["knee_flexion_right"]]
    assert (hip.min(), hip.max()) == (pytest.approx(5 - 22, abs=0.2), pytest.approx(5 + 22, abs=0.2))
    assert (knee.min(), knee.max()) == (pytest.approx(2, abs=0.2), pytest.approx(58, abs=0.2))
    assert np.corrcoef(table[:, DOF["shoulder_flexion_left"]], hip)[0, 1] > 0.99


def test_a_walk_is_thirty_strides_on_one_spot(invented_walk):
    who = person(3)
    trial = walks.walk_trial(who, invented_walk)
    again = walks.walk_trial(who, invented_walk)
    assert np.array_equal(trial.q, again.q)
    assert np.ptp(trial.q[:, [0, 2]], axis=0) == pytest.approx(0.0)
    knee = np.degrees(trial.q[:, 3 + DOF["knee_flexion_right"]])
    high = (knee[1:-1] > 45) & (knee[1:-1] >= knee[:-2]) & (knee[1:-1] > knee[2:])
    assert walks.STRIDES - 2 <= high.sum() <= walks.STRIDES + 6
    assert set(trial.repetition) == set(range(walks.STRIDES + 1))
    assert np.ptp(knee[: int(2.5 * 30)]) < 8
    lower = trial.centres[:, [CENTRE_NAMES.index(f"ankle_{side}") for side in ("right", "left")], 1].min(axis=1)
    assert lower == pytest.approx(-0.8, abs=0.03)
    a, b = (trial.centres[:, CENTRE_NAMES.index(name)] for name in ("knee_left", "ankle_left"))
    assert np.linalg.norm(a - b, axis=1) == pytest.approx(who.lengths[LENGTH_NAMES.index("shank_left")], abs=1e-9)
    assert np.isfinite(see(trial, 3).centres).any()


def test_a_recording_shorter_than_a_stride_is_refused(monkeypatch):
    angles, rate_hz = invented()
    cut = {name: values[:60] for name, values in angles.items()}
    monkeypatch.setitem(walks.RECORDINGS, "short", lambda: (cut, rate_hz))
    with pytest.raises(ValueError, match="no whole stride"):
        walks.stride("short")


@pytest.mark.parametrize("recording", list(walks.RECORDINGS))
def test_recorded_strides_are_those_of_walking(recording):
    try:
        table, lasts_s = walks.stride(recording)
    except MissingFile as error:
        pytest.skip(str(error))
    assert 0.85 < lasts_s < 1.5
    for side in ("right", "left"):
        knee, hip = table[:, DOF[f"knee_flexion_{side}"]], table[:, DOF[f"hip_flexion_{side}"]]
        assert 45 < np.ptp(knee) < 75
        assert 35 < np.ptp(hip) < 60
        assert hip.min() < -5
        # The knee bends most while the thigh comes forward; the hip is adducted in stance.
        assert -10 < hip[int(knee.argmax())] < 30
        adduction = table[:, DOF[f"hip_adduction_{side}"]]
        assert adduction[hip < 0].mean() > adduction[knee > 40].mean()
    right, left = (table[:, DOF[f"knee_flexion_{side}"]] for side in ("right", "left"))
    apart = abs(int(right.argmax()) - int(left.argmax())) / len(table)
    assert 0.35 < apart < 0.65
    watched = watch(2, recording)
    assert len(watched.angles) > SCORED_FROM + 600
    assert {DOF["knee_flexion_left"] + 1, DOF["hip_flexion_right"] + 1} <= set(SCORED)
