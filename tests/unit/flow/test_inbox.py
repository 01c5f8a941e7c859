"""Whatever the network does to a stream, each message comes out once, in order, or is counted lost."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from services.flow.inbox import Hole, OrderedInbox
from services.flow.message import Envelope
from services.flow.position import Position


def envelope(sequence: int, epoch: int = 0, *, final: bool = False) -> Envelope:
    return Envelope(epoch, sequence, sequence, final)


@st.composite
def arrivals(draw) -> tuple[int, list[int]]:
    """How many were sent, and in which order they arrive: some lost, some twice, any order."""
    sent = draw(st.integers(1, 40))
    lost = draw(st.sets(st.integers(0, sent - 1)))
    arriving = [number for number in range(sent) if number not in lost]
    arriving += draw(st.lists(st.sampled_from(arriving), max_size=20)) if arriving else []
    return sent, draw(st.permutations(arriving))


@given(arrivals())
def test_each_message_comes_once_in_order_or_is_lost(case):
    _, arriving = case
    inbox: OrderedInbox[int] = OrderedInbox()
    out = [item for number in arriving for _, item in inbox.accept(envelope(number), number)]
    while inbox.hole() is not None:
        out += [item for _, item in inbox.give_up()]
    assert out == sorted(set(arriving))
    assert inbox.counts.received == len(out)
    assert inbox.counts.duplicated == len(arriving) - len(out)
    assert inbox.counts.received + inbox.counts.lost == max(arriving, default=-1) + 1
    missing = {number for hole in inbox.given_up for number in range(hole.first, hole.last + 1)}
    assert missing == set(range(max(arriving, default=-1) + 1)) - set(arriving)


@given(arrivals(), st.integers(0, 40))
def test_a_resumed_inbox_takes_only_what_is_behind_its_position(case, done):
    _, arriving = case
    inbox: OrderedInbox[int] = OrderedInbox(Position(0, done, ended=False))
    out = [item for number in arriving for _, item in inbox.accept(envelope(number), number)]
    while inbox.hole() is not None:
        out += [item for _, item in inbox.give_up()]
    assert out == sorted(number for number in set(arriving) if number > done)


@given(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 6)), max_size=60))
def test_epochs_never_go_back_and_nothing_comes_twice(numbers):
    inbox: OrderedInbox[tuple[int, int]] = OrderedInbox()
    out = [item for epoch, number in numbers for _, item in inbox.accept(envelope(number, epoch), (epoch, number))]
    assert out == sorted(set(out))
    assert inbox.counts.received == len(out)


def test_a_new_epoch_delivers_what_waited_in_the_old_one_and_counts_its_holes():
    inbox: OrderedInbox[str] = OrderedInbox()
    inbox.accept(envelope(0), "a")
    inbox.accept(envelope(3), "d")
    out = [item for _, item in inbox.accept(envelope(0, epoch=1), "A")]
    assert out == ["d", "A"]
    assert inbox.given_up == [Hole(0, 1, 2)]
    assert (inbox.counts.received, inbox.counts.lost) == (3, 2)
    assert inbox.accept(envelope(1), "late") == []
    assert inbox.counts.duplicated == 1


def test_a_hole_is_named_until_it_is_filled():
    inbox: OrderedInbox[int] = OrderedInbox()
    assert inbox.hole() is None
    inbox.accept(envelope(2), 2)
    inbox.accept(envelope(5), 5)
    assert inbox.hole() == Hole(0, 0, 1)
    inbox.accept(envelope(1), 1, recovered=True)
    assert inbox.hole() == Hole(0, 0, 0)
    assert [item for _, item in inbox.accept(envelope(0), 0, recovered=True)] == [0, 1, 2]
    assert inbox.hole() == Hole(0, 3, 4)
    assert inbox.counts.recovered == 2


def test_part_of_a_hole_can_be_given_up():
    inbox: OrderedInbox[int] = OrderedInbox()
    inbox.accept(envelope(9), 9)
    assert inbox.give_up(through=4) == []
    assert inbox.hole() == Hole(0, 5, 8)
    assert inbox.give_up(through=2) == []
    assert inbox.counts.lost == 5
    assert [item for _, item in inbox.give_up(through=100)] == [9]
    assert inbox.counts.lost == 9
    assert inbox.give_up() == []


def test_memory_is_bounded():
    inbox: OrderedInbox[int] = OrderedInbox(most_waiting=10)
    out = [item for number in range(1, 40) for _, item in inbox.accept(envelope(number), number)]
    assert out == list(range(1, 40))
    assert inbox.counts.lost == 1


@pytest.mark.parametrize("last", [0, 3])
def test_the_final_message_ends_the_stream(last):
    inbox: OrderedInbox[int] = OrderedInbox()
    for number in range(last + 1):
        inbox.accept(envelope(number, final=number == last), number)
    assert inbox.position == Position(0, last, ended=True)
