import json

import numpy as np
import pytest

from services.estimation.lower_body.stride_buffer import StrideBuffer

HEARD = np.array([True, False, True])


def filled(count: int, every_s: float = 0.02, dt_s: float = 0.01) -> StrideBuffer:
    """Values count up, one every dt_s; kept for 1 s."""
    buffer = StrideBuffer(3, 1.0, every_s)
    for i in range(count):
        buffer.add(dt_s, np.full((2, 3), float(i)), HEARD)
    return buffer


def test_it_gives_the_last_seconds_oldest_first_with_their_age():
    taken = filled(100).take(0.1)
    ages, values = [age for age, *_ in taken], [rows[0, 0] for _, _, rows, _ in taken]
    assert ages == sorted(ages, reverse=True)
    assert ages[0] <= 0.1
    # The newest sample was number 99: how old a value is tells which it was.
    assert [99 - round(age / 0.01) for age in ages] == values
    assert all(since == pytest.approx(0.02) for _, since, _, _ in taken)


def test_it_keeps_no_more_than_it_was_asked_to():
    assert len(filled(1000).take(60.0)) == 50


def test_what_was_taken_is_gone():
    buffer = filled(100)
    buffer.take(0.5)
    assert buffer.take(0.5) == []


def test_slow_samples_are_all_kept():
    assert len(filled(10, dt_s=0.04).take(60.0)) == 10


def test_it_goes_on_as_if_it_had_not_been_frozen():
    whole, resumed = filled(101), StrideBuffer(3, 1.0, 0.02)
    resumed.restore(json.loads(json.dumps(filled(101).snapshot())))
    for buffer in (whole, resumed):
        buffer.add(0.01, np.ones((2, 3)), HEARD)
    for (age, since, rows, heard), other in zip(whole.take(1.0), resumed.take(1.0), strict=True):
        assert (age, since) == other[:2]
        assert (rows == other[2]).all()
        assert (heard == other[3]).all()
