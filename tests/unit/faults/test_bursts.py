import math

import numpy as np
import pytest

from services.faults.bursts import BurstChannel, BurstModel


def pattern(model: BurstModel, seed: int, count: int) -> np.ndarray:
    channel = BurstChannel(model, seed)
    return np.array([channel.loses() for _ in range(count)])


def runs(lost: np.ndarray) -> np.ndarray:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], lost.astype(int), [0]])))
    return edges[1::2] - edges[::2]


@pytest.mark.parametrize("share", [0.0, 0.05, 0.2, 0.5])
def test_the_share_asked_for_is_lost(share):
    model = BurstModel().losing(share)
    assert model.share == pytest.approx(share)
    # A lost run is 2 packets with a standard deviation of 5.5; that leaves 2 % of the share over 200 000 packets.
    assert pattern(model, 3, 200_000).mean() == pytest.approx(share, rel=0.08)


def test_runs_are_as_long_as_those_of_the_recordings():
    lengths = runs(pattern(BurstModel().losing(0.1), 5, 300_000))
    shares = [np.mean(lengths == n) for n in (1, 2, 3, 4)]
    assert np.allclose(shares, [0.64, 0.22, 0.08, 0.03], atol=0.03)
    assert lengths.max() == 64
    assert np.mean(lengths >= 10) == pytest.approx(0.01, abs=0.005)


def test_the_seed_decides():
    model = BurstModel().losing(0.2)
    assert (pattern(model, 1, 1000) == pattern(model, 1, 1000)).all()
    assert (pattern(model, 1, 1000) != pattern(model, 2, 1000)).any()


@pytest.mark.parametrize("share", [-0.1, 1.0, math.nan])
def test_a_share_that_is_none(share):
    with pytest.raises(ValueError, match="share"):
        BurstModel().losing(share)
