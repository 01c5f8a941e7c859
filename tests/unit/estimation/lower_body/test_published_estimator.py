"""The published filter by name: it runs through the whole chain, and is never lost for good."""

import json

import numpy as np
import pytest

from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.parameters import PUBLISHED, EstimationParameters
from tests.unit.estimation import estimation_walks as walks

DESCRIPTION = walks.describe(estimator="joukov_published")


def test_every_choice_of_the_published_model_is_the_name_s() -> None:
    chosen = EstimationParameters().filter_of(DESCRIPTION)
    assert chosen == PUBLISHED
    measurement = chosen.measurement
    assert (measurement.gyro_sees_position, measurement.accel_sees_motion) == (True, True)
    assert (chosen.soft_knees, chosen.sample_delay, chosen.noise.yaw_std) == (False, 0.0, 0.1)


@pytest.mark.parametrize(("walk_path", "yaw"), [("turning", "relative"), ("straight", "world")])
@pytest.mark.parametrize("estimator", ["rhythmic_ekf", "joukov_published"])
def test_the_path_of_the_walk_chooses_the_yaw_measurement(estimator: str, walk_path: str, yaw: str) -> None:
    description = walks.describe(estimator=estimator, walk_path=walk_path)
    assert EstimationParameters().filter_of(description).measurement.yaw == yaw


def test_a_clean_walk_is_followed() -> None:
    """With perfect rigid bodies the published model is right; it fails on real ones."""
    truth, samples = walks.walk()
    outputs = walks.run(LowerBodyNode(DESCRIPTION), walks.messages(DESCRIPTION, samples))
    knee = walks.angles(outputs, "knee_flexion_left")
    times = sorted(knee)[400:]
    error = [knee[t] - truth[round(t / 10_000_000), walks.NAMES.index("knee_flexion_left")] for t in times]
    assert np.std(error) < np.radians(4.0)


def test_wild_samples_give_finite_rows_and_doubt() -> None:
    """At the end of the sensors' range, in random directions, for two seconds: it may be wrong, never broken."""
    samples = walks.walk()[1].copy()
    random = np.random.default_rng(5)
    samples[600:800, :, :3] = random.uniform(-35.0, 35.0, (200, 5, 3))
    samples[600:800, :, 3:] = random.uniform(-300.0, 300.0, (200, 5, 3))
    outputs = walks.run(LowerBodyNode(DESCRIPTION), walks.messages(DESCRIPTION, samples))
    states = walks.joint_states(outputs)
    assert all(np.isfinite(state.position).all() and np.isfinite(state.velocity_std).all() for state in states)
    assert all(states[-1].valid[i] for i in range(3))


def test_a_lost_estimate_starts_over_and_says_so() -> None:
    node = LowerBodyNode(DESCRIPTION)
    stream = walks.messages(DESCRIPTION, walks.walk()[1])
    for message in stream[:700]:
        node.step(message)
    state = json.loads(json.dumps(node.snapshot()))
    node.restore(state)
    assert node._filter is not None
    node._filter.ekf.x[1, 5] = np.nan
    outputs = [output for message in stream[700:] for output in node.step(message)]
    states = walks.joint_states(outputs)
    assert not any(states[0].valid)
    assert np.isfinite(states[0].position).all()
    assert all(states[-1].valid[i] for i in range(3))
