"""Biases from pauses: what they tell is taken, what they cannot tell is not."""

import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest

from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.lower_body.resting_bias import RestingBias
from services.estimation.parameters import BiasParameters, EstimationParameters, StandingParameters
from services.estimation.samples import Tick

sys.path.insert(0, str(Path(__file__).parent))
from tests.unit.estimation import estimation_walks as walks

TICK_NS = 10_000_000
GRAVITY = np.array([0.0, 9.81, 0.0])
BOTH = np.ones(2, dtype=np.bool_)


def moving(seconds: float) -> list[np.ndarray]:
    rates = [3.0 * math.sin(0.06 * k) for k in range(round(seconds * 100))]
    return [np.tile([rate, 0.0, 0.0, *GRAVITY], (2, 1)) for rate in rates]


def resting(seconds: float, bias: float = 0.0) -> list[np.ndarray]:
    return [np.tile([0.0, 0.0, bias, *GRAVITY], (2, 1)) for _ in range(round(seconds * 100))]


def ticks(*parts: list[np.ndarray]) -> list[Tick]:
    rows = [row for part in parts for row in part]
    return [Tick(k * TICK_NS, row, BOTH) for k, row in enumerate(rows)]


def after(*parts: list[np.ndarray], subject: RestingBias | None = None) -> RestingBias:
    subject = subject or RestingBias(np.zeros((2, 3)))
    for tick in ticks(*parts):
        subject.add(tick)
    return subject


def test_a_pause_tells_the_bias_as_far_as_sway_allows() -> None:
    subject = after(moving(120.0), resting(5.0, 0.008), moving(1.0))
    p, sway = BiasParameters(), StandingParameters().sway
    # Of 500 samples the block that movement reaches into and one at each end do not count.
    grown, noise = p.start_std**2 + 125.0 * p.drift**2, (sway / 4.25) ** 2
    np.testing.assert_allclose(subject.bias[:, 2], 0.008 * grown / (grown + noise), rtol=0.05)
    np.testing.assert_allclose(subject.bias[:, :2], 0.0, atol=1e-4)


def test_pause_after_pause_comes_closer() -> None:
    errors = [abs(after(*[moving(60.0), resting(4.0, 0.006)] * n).bias[0, 2] - 0.006) for n in (1, 2, 4)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.0005


def test_the_standing_that_calibrated_does_not_count_again() -> None:
    np.testing.assert_array_equal(after(resting(30.0, 0.01)).bias, 0.0)


@pytest.mark.parametrize("seconds", [0.5, 1.2])
def test_a_moment_tells_nothing(seconds: float) -> None:
    np.testing.assert_array_equal(after(moving(10.0), resting(seconds, 0.01), moving(2.0)).bias, 0.0)


def test_a_slow_turn_is_no_bias() -> None:
    """A body on a turning chair rests for the accelerometers: 4 deg/s are not believed."""
    np.testing.assert_array_equal(after(moving(60.0), resting(8.0, 0.07)).bias, 0.0)


def test_a_silent_sensor_keeps_its_bias() -> None:
    subject = RestingBias(np.full((2, 3), 0.001))
    for tick in ticks(moving(60.0), resting(6.0, 0.006)):
        subject.add(Tick(tick.captured_ns, tick.samples, np.array([True, False])))
    assert subject.bias[0, 2] > 0.004
    np.testing.assert_array_equal(subject.bias[1], 0.001)


@pytest.mark.parametrize("cut", [100, 6130, 6260, 6420, 6611, 6900])
def test_goes_on_to_the_bit_after_a_restart(cut: int) -> None:
    whole = ticks(moving(61.0), resting(5.0, 0.004), moving(2.0), resting(3.0, 0.005), moving(1.0))
    through, before = RestingBias(np.zeros((2, 3))), RestingBias(np.zeros((2, 3)))
    for tick in whole[:cut]:
        through.add(tick)
        before.add(tick)
    resumed = RestingBias(np.zeros((2, 3)))
    resumed.restore(json.loads(json.dumps(before.snapshot())))
    for tick in whole[cut:]:
        assert through.add(tick) == resumed.add(tick)
        np.testing.assert_array_equal(through.bias, resumed.bias)


def test_the_filter_goes_on_with_the_new_bias_also_after_a_restart() -> None:
    """9 s of walking, then 8 s of standing in which every gyroscope is off by another 0.01 rad/s about each axis."""
    description, walked = walks.describe(), walks.walk()[1]
    pause = np.concatenate([walked[:200]] * 4)
    pause[:, :, :3] += 0.01
    stream = walks.messages(description, np.concatenate([walked, pause]))
    followed, kept = (
        walks.run(LowerBodyNode(description, EstimationParameters(follow_bias=follow)), stream)
        for follow in (True, False)
    )

    def fastest(outputs) -> float:
        """rad/s, mean rate of the joints of the last second: nobody moves."""
        rates = np.array([row for state in walks.joint_states(outputs) for row in state.velocity])
        return float(np.abs(rates[-100:].mean(axis=0)).max())

    assert fastest(followed) < 0.6 * fastest(kept)
    first, second = LowerBodyNode(description), LowerBodyNode(description)
    half = len(stream) - 150
    begun = [output for message in stream[:half] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot())))
    rest = [output for message in stream[half:] for output in second.step(message)] + second.finish()
    assert walks.text([*begun, *rest]) == walks.text(followed)
