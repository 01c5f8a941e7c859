import json

import numpy as np
import pytest

from services.segmentation.batch import DOFS, Batch
from services.segmentation.gait.history import HEADING, History

TICK = 10_000_000


def append_all(history: History, batch: Batch) -> None:
    for row in range(len(batch.captured_ns)):
        history.append(batch, row)


def filled(batches: int = 20, size: int = 5) -> History:
    history = History()
    for number in range(batches):
        steps = np.arange(number * size, (number + 1) * size)
        position = np.tile(0.01 * steps[:, None], (1, DOFS))
        valid = np.ones(DOFS, dtype=bool)
        valid[4] = number != 3
        phase = np.where(steps < 10, np.nan, 0.1 * steps)
        append_all(
            history,
            Batch(
                steps * TICK,
                position,
                np.zeros_like(position),
                phase,
                np.full((size, DOFS), 0.01 * number),
                valid,
                frozenset(),
            ),
        )
    return history


@pytest.mark.parametrize("at", [0, 7 * TICK, 12 * TICK + 3_333_333, 99 * TICK])
def test_an_instant_is_interpolated(at):
    instant = filled().at(at)
    np.testing.assert_allclose(instant.position, 0.01 * at / TICK, atol=1e-12)


def test_beyond_the_history_there_is_nothing():
    history = filled()
    assert history.at(-1) is None
    assert history.at(99 * TICK + 1) is None
    assert History().at(0) is None
    history.forget_before(50 * TICK)
    assert history.between(20 * TICK, 80 * TICK) is None
    assert history.between(50 * TICK, 80 * TICK) is not None


def test_a_curve_runs_from_contact_to_contact():
    span = filled().between(15 * TICK + 5_000_000, 65 * TICK + 5_000_000)
    curve = span.curve(0)
    assert curve.shape == (101,)
    np.testing.assert_allclose([curve[0], curve[50], curve[-1]], [0.155, 0.405, 0.655], atol=1e-12)
    assert span.phase_advance() == pytest.approx(5.0)


def test_a_span_is_locked_or_valid_only_all_the_time():
    history = filled()
    assert history.between(8 * TICK, 40 * TICK).phase_advance() is None
    assert not history.between(10 * TICK, 30 * TICK).valid[4]
    assert history.between(30 * TICK, 60 * TICK).valid[4]


def test_heading_is_unwrapped():
    history = History()
    steps = np.arange(100)
    position = np.zeros((100, DOFS))
    position[:, HEADING] = np.angle(np.exp(1j * (3.0 + 0.01 * steps)))
    still = np.zeros((100, DOFS))
    append_all(
        history, Batch(steps * TICK, position, still, np.zeros(100), still, np.ones(DOFS, dtype=bool), frozenset())
    )
    curve = history.between(0, 99 * TICK).curve(HEADING)
    assert curve[-1] - curve[0] == pytest.approx(0.99)


def test_snapshot_and_restore_to_the_bit():
    history, resumed = filled(), History()
    resumed.restore(json.loads(json.dumps(history.snapshot())))
    assert resumed.snapshot() == history.snapshot()
    np.testing.assert_array_equal(resumed.at(33_333_333).position, history.at(33_333_333).position)
    resumed.restore(json.loads(json.dumps(History().snapshot())))
    assert resumed.at(0) is None
