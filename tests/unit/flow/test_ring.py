"""The producer's memory: what it keeps, what it forgets, what it answers."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from services.flow.message import DecodeError, Envelope
from services.flow.ring import Place, Question, ReplayRing, RingExtent

SECOND = 1_000_000_000


def filled(count: int, **limits) -> ReplayRing:
    ring = ReplayRing(**limits)
    for number in range(count):
        ring.append(Envelope(0, number, number * SECOND), b"x" * 100)
    return ring


def numbers(ring: ReplayRing, question: Question, most: int | None = None) -> list[int]:
    return [envelope.sequence for envelope, _ in ring.answer(question, most)]


def test_an_empty_ring_answers_nothing():
    assert ReplayRing().answer(Question(None, 0, None)) == []
    assert ReplayRing().extent() is None


def test_old_messages_are_forgotten_by_captured_time():
    ring = filled(100, keep_s=10.0)
    assert ring.extent() == RingExtent(Place(0, 89), Place(0, 99))
    assert numbers(ring, Question(None, 0, None)) == list(range(89, 100))


def test_bytes_are_bounded_but_the_newest_stays():
    ring = filled(100, most_bytes=1000)
    assert numbers(ring, Question(None, 0, None)) == list(range(90, 100))
    ring.append(Envelope(0, 100, 0), b"x" * 5000)
    assert numbers(ring, Question(None, 0, None)) == [100]


@given(st.integers(0, 60), st.integers(0, 60), st.integers(0, 60) | st.none(), st.integers(1, 70) | st.none())
def test_answers_are_the_part_asked_for(count, first, last, most):
    expected = [n for n in range(count) if n >= first and (last is None or n <= last)]
    assert numbers(filled(count), Question(0, first, last), most) == expected[:most]


def test_what_came_after_includes_newer_epochs():
    ring = filled(5)
    for number in range(3):
        ring.append(Envelope(7, number, number), b"")
    assert numbers(ring, Question(0, 3, None)) == [3, 4, 0, 1, 2]
    assert numbers(ring, Question(0, 3, 9)) == [3, 4]
    assert numbers(ring, Question(7, 1, None)) == [1, 2]
    assert numbers(ring, Question(None, 0, None)) == [0, 1, 2, 3, 4, 0, 1, 2]
    assert numbers(ring, Question(None, 2, 3)) == [2, 3, 2]
    assert ring.extent() == RingExtent(Place(0, 0), Place(7, 2))


def test_a_question_for_nothing_is_answered_with_nothing():
    assert numbers(filled(5), Question(None, 0, -1)) == []


@given(st.tuples(*[st.integers(0, 2**63)] * 4))
def test_an_extent_survives_the_wire(words):
    extent = RingExtent(Place(*words[:2]), Place(*words[2:]))
    assert RingExtent.decode(extent.encode()) == extent


@given(st.binary(max_size=40))
def test_other_bytes_are_no_extent(data):
    try:
        RingExtent.decode(data)
    except DecodeError:
        return
    assert len(data.split(b" ")) == 4


def test_text_is_no_extent():
    with pytest.raises(DecodeError, match="extent"):
        RingExtent.decode(b"1 2 3 four")
