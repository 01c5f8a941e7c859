"""Every method on one recording: known errors come out, in the sense and at the shift that agree."""

import numpy as np
import pytest

from services.bench.knee import peers
from services.bench.knee.comparison import OURS, judge, judge_peers, pooled
from services.bench.knee.comparison_tables import agreement_table, cost_table, per_trial_table, trial_charts
from services.bench.knee.recordings import KneeRecording

FRAMES = 1000
TRUTH = np.radians(40.0) * (1.0 - np.cos(np.arange(FRAMES) / 20.0))
EVERY = np.ones(FRAMES, dtype=np.bool_)


def recording(name: str = "walk") -> KneeRecording:
    nothing = np.zeros((FRAMES, 2, 3))
    return KneeRecording(name, 50.0, nothing, nothing, TRUTH, EVERY, None)


def test_a_known_offset_and_delay_are_told_apart():
    late = np.interp(np.arange(FRAMES) - 0.5, np.arange(FRAMES), TRUTH) + np.radians(3.0)
    judged = judge(OURS, late, recording(), EVERY, EVERY)
    assert judged.score.shift == 0.5
    assert judged.errors.bias == pytest.approx(3.0, abs=0.02)
    assert judged.errors.zero_mean_rmse < 0.05
    assert judged.agreement.slope == pytest.approx(1.0, abs=1e-3)
    assert pooled([judged, judged]).samples == 2 * FRAMES


def test_an_angle_beyond_the_half_turn_is_compared_within_it():
    judged = judge(OURS, TRUTH + 2.0 * np.pi, recording(), EVERY, EVERY)
    assert judged.errors.absolute_rmse == pytest.approx(0.0, abs=1e-9)


def invented_methods():
    def scaled(factor: float):
        return lambda _: peers.PeerResult(factor * TRUTH, np.eye(3)[:2], 2e-6)

    return {"backward": ((), scaled(-1.0)), "short": ((), scaled(0.9)), "absent": (("no_such_library",), scaled(1.0))}


def test_peers_get_their_sense_and_absent_ones_their_reason(monkeypatch):
    monkeypatch.setattr(peers, "METHODS", invented_methods())
    found, absent = judge_peers(recording(), EVERY)
    assert [one.method for one in found] == ["backward", "short"]
    assert found[0].errors.zero_mean_rmse == pytest.approx(0.0, abs=1e-9)
    assert found[1].agreement.slope == pytest.approx(0.9)
    assert found[1].cost_us == pytest.approx(2.0)
    assert absent == ["absent: not installed: no_such_library"]


def test_the_published_method_needs_orientations_in_one_world(monkeypatch):
    monkeypatch.setattr(peers, "METHODS", {peers.LITERAL: ((), peers.mcgrath_as_measured)})
    found, absent = judge_peers(recording(), EVERY)
    assert (found, absent) == ([], ["McGrath: no orientations came with the recording"])
    with pytest.raises(ValueError, match="no orientations"):
        peers.mcgrath_as_measured(recording())


def test_tables_and_charts_of_the_error_analysis():
    trials = {
        name: [judge(OURS, TRUTH + 0.02 * np.sin(np.arange(FRAMES)), recording(name), EVERY, EVERY),
               judge("McGrath on VQF", 0.95 * TRUTH, recording(name), EVERY, EVERY, cost_us=1.5)]
        for name in ("walk 1", "walk 2")
    }  # fmt: skip
    table = per_trial_table(trials)
    assert [line[0] for line in table.rows] == ["walk 1", "walk 2", "total"]
    assert table.rows[0][1] == table.rows[2][1]
    assert len(agreement_table(trials).rows) == 4
    assert cost_table(trials).rows == [["McGrath on VQF", "1.50"]]
    charts = trial_charts(trials, dict.fromkeys(trials, 50.0))
    assert {f"{kind}_walk_1" for kind in ("regression", "bland_altman", "error")} <= charts.keys()
    assert "McGrath on VQF: lower limit" in charts["bland_altman_walk_2"]
    assert "time, s" in charts["error_walk_1"]
    assert "error, deg" in charts["error_walk_1"]
