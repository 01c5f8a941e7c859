"""Knee angle of single treadmill steps against markers, estimated offline."""

import numpy as np
import pytest

from services.bench.accuracy.kam_steps import read_steps
from services.bench.accuracy.offline_steps import quietest
from services.bench.accuracy.steps import step_scores
from services.ingest.errors import MissingFile


@pytest.fixture(scope="module")
def steps():
    try:
        return read_steps()
    except MissingFile as missing:
        pytest.skip(str(missing))


def test_knee_errors_stay_below_the_floors(steps) -> None:
    best = [score.best for score in step_scores(steps)]
    assert np.mean([score.offset_removed_deg for score in best]) < 2.4
    assert np.mean([score.absolute_deg for score in best]) < 3.0
    assert max(score.offset_removed_deg for score in best) < 3.5
    assert min(score.correlation for score in best) > 0.98


def test_the_quietest_instant_lies_in_stance(steps) -> None:
    """Heel strike is 0.2 s after the start, toe-off 0.2 s before the end."""
    for step in steps:
        assert 25 < quietest(step.samples[:, 1:]) < len(step.samples) - 25
