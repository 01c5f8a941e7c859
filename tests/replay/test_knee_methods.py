"""The published methods on recordings: what they reach, so that nobody's comparison changes unseen."""

import numpy as np
import pytest

from schemas.vocabulary import Side
from services.bench.knee import peers
from services.bench.knee.comparison import judge_peers
from services.bench.knee.grover_recorded import played_walk, recorded_difference
from services.bench.knee.kam_board import kam_section
from services.bench.knee.recordings import KneeRecording, from_manifest
from services.ingest.errors import MissingFile


def load(reader, *arguments):
    try:
        return reader(*arguments)
    except MissingFile as missing:
        pytest.skip(str(missing))


def test_orientations_of_the_sensors_maker_have_gravity_upward():
    recording: KneeRecording = load(from_manifest, "alborno_sub03_sts1", Side.LEFT)
    assert recording.orientations is not None
    for s, R_world_from_sensor in enumerate(recording.orientations):
        assert len(R_world_from_sensor) == len(recording.rate)
        mean = np.einsum("nij,nj->ni", R_world_from_sensor, recording.force[:, s]).mean(axis=0)
        assert mean == pytest.approx([0.0, 0.0, 9.81], abs=0.6)


def test_the_published_method_on_drop_landings(monkeypatch):
    monkeypatch.setattr(peers, "METHODS", {peers.LITERAL: peers.METHODS[peers.LITERAL]})
    recording = load(from_manifest, "fan_knee_drop_landing_left", Side.LEFT)
    asked = np.arange(len(recording.flexion)) >= 100
    (literal,), _ = judge_peers(recording, asked & recording.holds)
    assert literal.errors.zero_mean_rmse < 0.65
    assert literal.agreement.r_squared > 0.999
    assert literal.agreement.slope == pytest.approx(1.0, abs=0.01)


def test_both_filters_of_the_published_band_on_a_recorded_walk():
    assert np.degrees(recorded_difference(load(played_walk, Side.LEFT))) < 3.7


def test_single_steps_by_both_methods():
    class Quiet:
        def track(self, items, description=""):
            return items

    figures = {row.name: row.value for row in load(kam_section, Quiet()).rows}
    assert figures["kam: steps with a valid angle"] == 10
    assert figures["kam, ours: flexion, offset-removed, mean of steps"] < 4.5
    assert figures["kam, McGrath: flexion, offset-removed, mean of steps"] < 5.0
    assert figures["kam: axis of the thigh against the epicondyles"] < 12.0
