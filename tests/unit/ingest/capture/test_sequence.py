"""Order, duplicates and losses of datagrams."""

import random

import pytest

from services.ingest.capture.sequence import SEQUENCE, Sequence

MS = 1_000_000
WAIT = SEQUENCE.wait_ns


def fed(numbers, step_ns=33 * MS):
    """A sequence after items arrived at a steady pace, and what it delivered."""
    sequence, out = Sequence(), []
    for k, number in enumerate(numbers):
        out += sequence.due(k * step_ns)
        out += sequence.add(number, k * step_ns, number)
    out += sequence.due(len(numbers) * step_ns + WAIT)
    return sequence, out


def counts(sequence):
    return sequence.delivered, sequence.lost, sequence.late, sequence.duplicates


def test_in_order_goes_straight_through():
    sequence = Sequence()
    assert [sequence.add(k, 0, k) for k in range(5, 9)] == [[5], [6], [7], [8]]
    assert counts(sequence) == (4, 0, 0, 0)


def test_two_that_changed_places_are_put_right():
    sequence, out = fed([0, 2, 1, 3], step_ns=5 * MS)
    assert out == [0, 1, 2, 3]
    assert counts(sequence) == (4, 0, 0, 0)


def test_a_hole_is_waited_for_and_then_given_up():
    sequence = Sequence()
    sequence.add(0, 0, 0)
    assert sequence.add(2, 10 * MS, 2) == []
    assert sequence.add(3, 43 * MS, 3) == []
    assert sequence.due(10 * MS + WAIT - 1) == []
    assert sequence.due(10 * MS + WAIT) == [2, 3]
    assert counts(sequence) == (3, 1, 0, 0)


def test_who_comes_after_all_is_late_and_no_more_lost():
    sequence, out = fed([0, 2, 3, 4, 5, 1, 6])
    assert out == [0, 2, 3, 4, 5, 6]
    assert counts(sequence) == (6, 0, 1, 0)


def test_duplicates_are_dropped_once_held_and_once_delivered():
    sequence, out = fed([0, 0, 2, 2, 1, 2, 3], step_ns=MS)
    assert out == [0, 1, 2, 3]
    assert counts(sequence) == (4, 0, 0, 3)


def test_what_was_sent_before_the_first_is_late():
    sequence, out = fed([10, 9, 11])
    assert out == [10, 11]
    assert counts(sequence) == (2, 0, 1, 0)


def test_a_sender_that_counts_anew_is_followed():
    _, out = fed([*range(500, 520), *range(30)])
    assert out[:20] == list(range(500, 520))
    assert out[20:] == list(range(SEQUENCE.restart_after - 1, 30))
    far, out = fed([0, 1, 2, 50_000, 50_001])
    assert out == [0, 1, 2, 50_000, 50_001]
    assert far.lost == 0


def test_a_delayed_copy_of_every_datagram_is_no_new_count():
    numbers = [each for k in range(3, 200) for each in (k, k - 3)]
    sequence, out = fed(numbers, step_ns=16 * MS)
    assert out == list(range(3, 200))
    assert sequence.duplicates == 197 - 3


def test_another_sender_starts_where_it_is():
    sequence = Sequence()
    sequence.add(100, 0, "a")
    sequence.add(102, 0, "c")
    assert sequence.restart() == ["c"]
    assert sequence.add(4, MS, "x") == ["x"]
    assert counts(sequence) == (3, 1, 0, 0)


@pytest.mark.parametrize("seed", range(6))
def test_the_books_balance(seed):
    """Loss of 10 %, delays up to 200 ms, 5 % twice: sent = received + lost + late, and the order holds."""
    rng = random.Random(seed)
    sent = 600
    arrivals = []
    for number in range(sent):
        if rng.random() < 0.1 and 0 < number < sent - 1:
            continue
        for _ in range(1 + (rng.random() < 0.05)):
            delay_ms = rng.uniform(0, 200) if rng.random() < 0.1 and 0 < number < sent - 1 else rng.uniform(0, 5)
            arrivals.append((number * 33 * MS + round(delay_ms * MS), number))
    sequence, out = Sequence(), []
    for now, number in sorted(arrivals):
        out += sequence.due(now)
        out += sequence.add(number, now, number)
    out += sequence.due(sent * 33 * MS + 10 * WAIT)
    assert out == sorted(set(out))
    assert sequence.delivered == len(out)
    assert sequence.delivered + sequence.lost + sequence.late == sent
    assert len(arrivals) == sequence.delivered + sequence.late + sequence.duplicates
    assert sequence.late > 0
