"""Sensors whose every value is within range and none of which can be true."""

import numpy as np
import pytest

from schemas.vocabulary import LOWER_BODY_ESTIMATORS
from services.biomech.lower_body_ekf import FASTEST_JOINT
from services.estimation.lower_body.node import LowerBodyNode
from tests.unit.estimation import estimation_walks as walks

FROM, TO = 500, 600


def babbling(seed: int) -> np.ndarray:
    """A walk in which every sensor says anything at all for a second, up to the end of its range."""
    samples, random = walks.walk()[1].copy(), np.random.default_rng(seed)
    samples[FROM:TO, :, :3] = random.choice([-22.0, 22.0], (TO - FROM, 5, 3)) + random.normal(0, 0.5, (TO - FROM, 5, 3))
    samples[FROM:TO, :, 3:] = random.choice([-180.0, 180.0], (TO - FROM, 5, 3))
    return samples


@pytest.mark.parametrize("estimator", LOWER_BODY_ESTIMATORS)
def test_an_estimate_that_is_lost_begins_again_and_no_joint_is_ever_infinite(estimator: str) -> None:
    description = walks.describe(estimator=estimator)
    outputs = walks.run(LowerBodyNode(description), walks.messages(description, babbling(seed=1)))
    states = walks.joint_states(outputs)
    fastest = max(np.abs(np.array(state.velocity)[:, 3:]).max() for state in states)
    # Rows are carried on by the samples' delay, which adds some of the acceleration.
    assert fastest < 3 * FASTEST_JOINT
    if estimator != "joukov_published":  # loses itself in this walk without nonsense, too
        assert all(states[-1].valid), "by the end the body is believed again"
    # The payload refuses what is not finite, so that every sample has its row shows that none was.
    assert sum(len(state.captured_ns) for state in states) > len(babbling(1)) - walks.STANDING_S * walks.RATE_HZ
