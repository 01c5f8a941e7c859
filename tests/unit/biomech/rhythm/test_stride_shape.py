import json

import numpy as np
import pytest

from services.biomech.rhythm.stride_shape import StrideShape

HEARD = np.ones(2, dtype=np.bool_)
STEP = 2.0 * np.pi / 97.0  # a stride of 97 samples meets grid points in another place each time


def motion(phase: float, stride: float = 0.0) -> np.ndarray:
    """(2, 2): two channels and their slopes; the second channel differs from stride to stride."""
    angle = np.array([np.cos(phase) + 0.3 * np.sin(3.0 * phase), 2.0 + np.sin(phase) + stride])
    slope = np.array([-np.sin(phase) + 0.9 * np.cos(3.0 * phase), np.cos(phase)])
    return np.array([angle, slope])


def walk(shape: StrideShape, strides: float, spread: float = 0.0, seed: int = 0, heard=HEARD) -> float:
    """Let it learn; the phase after the last sample."""
    random = np.random.default_rng(seed)
    offsets = spread * random.standard_normal(round(strides) + 1)
    phase = 0.0
    for _ in range(round(strides * 97)):
        phase += STEP
        shape.learn(phase, STEP / (2.0 * np.pi), motion(phase, offsets[int(phase / (2.0 * np.pi))]), heard)
    return phase


def new(strides: float = 4.0) -> StrideShape:
    return StrideShape(np.full((2, 2), 0.1), strides)


def test_two_strides_tell_the_next_one():
    shape = new()
    phase = walk(shape, 2.1)
    for ahead in np.linspace(0.0, 7.0, 50):
        expected = shape.expect(phase + ahead)
        assert expected.known.all()
        # Half a grid step beside the place at which a sample was taken.
        assert np.abs(expected.value - motion(phase + ahead)).max() < 0.06


@pytest.mark.parametrize("strides", [0.0, 0.5, 1.0])
def test_one_stride_tells_nothing(strides):
    shape = new()
    phase = walk(shape, strides)
    assert not shape.expect(phase).known.any()


def test_a_channel_that_was_not_heard_is_not_known():
    shape = new()
    phase = walk(shape, 3.0, heard=np.array([True, False]))
    assert shape.expect(phase).known.tolist() == [True, False]


def test_the_deviation_is_that_of_strides():
    shape = new(strides=20.0)
    walk(shape, 60.0, spread=0.2, seed=1)
    std = shape.expect(1.0).std[0]
    assert std[0] < 0.02
    # A stride against the mean of those before it: a little more than the strides' own 0.2.
    assert std[1] == pytest.approx(0.2, rel=0.3)


def test_what_is_out_of_the_ordinary_is_a_surprise():
    shape = new()
    phase = walk(shape, 3.0)
    assert shape.surprise.max() < 0.1
    shape.learn(phase, STEP / (2.0 * np.pi), motion(phase) + 1.0, HEARD)
    assert shape.surprise.min() > 50.0


def test_it_goes_on_as_if_it_had_not_been_frozen():
    whole, half = new(), new()
    walk(whole, 2.5)
    walk(half, 2.5)
    resumed = new()
    resumed.restore(json.loads(json.dumps(half.snapshot())))
    for shape in (whole, resumed):
        walk(shape, 1.3, spread=0.1, seed=3)
    assert (whole.expect(0.7).value == resumed.expect(0.7).value).all()
    assert (whole.expect(0.7).std == resumed.expect(0.7).std).all()
