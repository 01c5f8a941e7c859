"""A stroke survivor on a treadmill: cadence from two shank gyroscopes, never wrong."""

import pytest

from services.bench.rhythm.treadmill import load_shank_rates, score_cadence, swing_peaks
from services.biomech.rhythm.trusted import TrustedRhythm
from services.ingest.errors import MissingFile


def test_cadence_of_a_stroke_survivor():
    try:
        rates = load_shank_rates()
    except MissingFile as missing:
        pytest.skip(str(missing))
    assert [swing_peaks(rate).size for rate in rates.T] == pytest.approx([112, 112], abs=2)
    score = score_cadence(TrustedRhythm(2).run(rates, 0.01), rates)
    assert score.right_percent >= 93.0
    assert score.wrong_percent == 0.0
    assert score.locked_percent >= 95.0
    assert score.phase_spread_deg < 7.0
