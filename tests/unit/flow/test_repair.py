"""The questions to the ring, with the test as clock, network and producer."""

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.flow.inbox import OrderedInbox
from services.flow.message import Envelope
from services.flow.position import Position
from services.flow.repair import DEFAULT_TIMES, Repair
from services.flow.ring import Place, Question, ReplayRing, RingExtent

STEP_S = 0.1


class Producer:
    """Sends numbers and keeps them in a ring."""

    def __init__(self, keep_s: float = 1e9) -> None:
        self.ring = ReplayRing(keep_s=keep_s)
        self.sent = 0

    def send(self, count: int) -> list[Envelope]:
        envelopes = [Envelope(0, self.sent + offset, self.sent + offset) for offset in range(count)]
        for envelope in envelopes:
            self.ring.append(envelope, b"")
        self.sent += count
        return envelopes


class Consumer:
    """An inbox under repair; `clock` is its monotonic clock."""

    def __init__(self, position: Position | None = None) -> None:
        self.inbox: OrderedInbox[None] = OrderedInbox(position)
        self.repair = Repair(self.inbox, now=0.0)
        self.clock = 0.0
        self.out: list[int] = []
        self.asked: list[tuple[float, Question]] = []

    def hear(self, envelopes: list[Envelope]) -> None:
        for envelope in envelopes:
            self.repair.heard(self.clock)
            self._take(self.inbox.accept(envelope, None))

    def wait(self, seconds: float, answer=None) -> None:
        """Let time pass; `answer(question)` gives the envelopes and extents that come back, None: no answer."""
        for _ in range(round(seconds / STEP_S)):
            self.clock += STEP_S
            while (question := self.repair.question(self.clock)) is not None:
                self.asked.append((self.clock, question))
                if answer is None:
                    break
                envelopes, extents = answer(question)
                for envelope in envelopes:
                    self._take(self.inbox.accept(envelope, None, recovered=True))
                self._take(self.repair.answered(self.clock, extents))

    def _take(self, ready) -> None:
        self.out += [envelope.sequence for envelope, _ in ready]


def nobody(_question: Question):
    return [], []


def ring_of(producer: Producer, most: int | None = None, lost: float = 0.0, seed: int = 0):
    """An honest ring behind a network that loses answers."""
    dice = random.Random(seed)

    def answer(question: Question):
        envelopes = [envelope for envelope, _ in producer.ring.answer(question, most)]
        extent = producer.ring.extent()
        kept = [envelope for envelope in envelopes if dice.random() >= lost]
        return kept, [] if extent is None or dice.random() < lost else [extent]

    return answer


def test_the_first_question_is_for_everything_behind_the_position():
    consumer = Consumer()
    consumer.wait(STEP_S, nobody)
    assert consumer.asked[0][1] == Question(None, 0, None)
    resumed = Consumer(Position(3, 7, ended=False))
    resumed.wait(STEP_S, nobody)
    assert resumed.asked[0][1] == Question(3, 8, None)


def test_a_late_subscriber_gets_all_page_by_page():
    producer, consumer = Producer(), Consumer()
    producer.send(1000)
    consumer.wait(STEP_S, ring_of(producer, most=100))
    assert consumer.out == list(range(1000))


def test_a_hole_is_asked_for_only_when_it_is_old():
    producer, consumer = Producer(), Consumer()
    consumer.hear(producer.send(5))
    consumer.wait(0.4, ring_of(producer))
    consumer.asked.clear()
    producer.send(2)
    consumer.hear(producer.send(1))
    begun = consumer.clock
    consumer.wait(1.0, ring_of(producer))
    assert consumer.out == list(range(8))
    (asked_at, question), *rest = consumer.asked
    assert question == Question(0, 5, 6)
    assert asked_at - begun >= DEFAULT_TIMES.hole
    assert not rest


def test_what_the_ring_no_longer_has_is_given_up_at_once():
    producer, consumer = Producer(keep_s=50e-9), Consumer()
    producer.send(200)
    consumer.wait(2 * STEP_S, ring_of(producer))
    assert consumer.out == list(range(149, 200))
    assert consumer.inbox.counts.lost == 149


def test_what_a_speaking_producer_does_not_answer_for_is_given_up_after_a_while():
    consumer = Consumer()
    consumer.wait(0.4, nobody)
    for number in range(3, 8):
        consumer.hear([Envelope(0, number, number)])
        assert consumer.out == []
        consumer.wait(DEFAULT_TIMES.give_up / 5 - STEP_S, nobody)
    assert consumer.out == []
    consumer.hear([Envelope(0, 8, 8)])
    consumer.wait(1.5, nobody)
    assert consumer.out == [3, 4, 5, 6, 7, 8]
    assert consumer.inbox.counts.lost == 3


def test_what_an_absent_producer_left_open_is_given_up_much_later():
    consumer = Consumer()
    consumer.wait(0.4, nobody)
    consumer.hear([Envelope(0, 3, 3)])
    consumer.wait(DEFAULT_TIMES.absent - 0.5, nobody)
    assert consumer.out == []
    consumer.wait(1.5, nobody)
    assert consumer.out == [3]


def test_a_producer_that_starts_anew_for_long_fills_its_own_hole():
    producer, consumer = Producer(), Consumer()
    consumer.wait(0.4, nobody)
    early = producer.send(5)
    consumer.hear(early[:2] + early[3:])
    consumer.wait(3 * DEFAULT_TIMES.give_up, nobody)
    # Back, it computes again from before the hole; its first answers are lost.
    consumer.hear(producer.send(1))
    consumer.wait(DEFAULT_TIMES.give_up - 1.0, nobody)
    consumer.wait(1.0, ring_of(producer))
    assert consumer.out == list(range(6))
    assert consumer.inbox.counts.lost == 0


def test_a_process_that_was_frozen_asks_before_it_gives_up():
    producer, consumer = Producer(), Consumer()
    consumer.hear(producer.send(3))
    consumer.wait(0.4, ring_of(producer))
    producer.send(3)
    consumer.hear(producer.send(1))
    consumer.wait(STEP_S)
    consumer.clock += 60.0
    consumer.wait(STEP_S, ring_of(producer))
    consumer.wait(1.0, ring_of(producer))
    assert consumer.out == list(range(7))
    assert consumer.inbox.counts.lost == 0


def test_a_question_that_gets_no_word_is_asked_again():
    producer, consumer = Producer(), Consumer()
    producer.send(5)
    consumer.wait(STEP_S)
    consumer.wait(DEFAULT_TIMES.answer - 2 * STEP_S, ring_of(producer))
    assert consumer.out == []
    consumer.wait(1.0, ring_of(producer))
    assert consumer.out == list(range(5))


def test_a_lost_tail_is_found_after_silence_and_silence_is_questioned_ever_more_rarely():
    producer, consumer = Producer(), Consumer()
    consumer.hear(producer.send(3))
    consumer.wait(0.4, ring_of(producer))
    producer.send(2)
    consumer.wait(DEFAULT_TIMES.silence + 1.0, ring_of(producer))
    assert consumer.out == list(range(5))
    consumer.asked.clear()
    consumer.wait(300.0, ring_of(producer))
    assert 10 <= len(consumer.asked) <= 300.0 / DEFAULT_TIMES.longest_silence + 5


def test_nothing_is_asked_of_a_stream_that_has_ended():
    consumer = Consumer()
    consumer.wait(0.2, nobody)
    consumer.hear([Envelope(0, 0, 0, final=True)])
    consumer.asked.clear()
    consumer.wait(100.0, nobody)
    assert consumer.asked == []


def test_a_younger_ring_beside_an_older_one_does_not_make_messages_lost():
    producer, consumer = Producer(), Consumer()
    producer.send(10)
    young = RingExtent(Place(0, 8), Place(0, 9))

    def answer(question: Question):
        envelopes = [envelope for envelope, _ in producer.ring.answer(question)][5:]
        extent = producer.ring.extent()
        assert extent is not None
        return envelopes, [young, extent]

    consumer.wait(STEP_S, answer)
    consumer.wait(1.0, ring_of(producer))
    assert consumer.out == list(range(10))


@settings(max_examples=60)
@given(
    seed=st.integers(0, 2**32),
    loss=st.sampled_from([0.0, 0.1, 0.5]),
    answers_lost=st.sampled_from([0.0, 0.2]),
    late=st.integers(0, 50),
)
def test_any_network_any_loss_everything_arrives(seed, loss, answers_lost, late):
    dice = random.Random(seed)
    producer, consumer = Producer(), Consumer()
    producer.send(late)
    answer = ring_of(producer, most=20, lost=answers_lost, seed=seed)
    for _ in range(30):
        fresh = [envelope for envelope in producer.send(5) if dice.random() >= loss]
        fresh += dice.sample(fresh, len(fresh) // 2)
        dice.shuffle(fresh)
        consumer.hear(fresh)
        consumer.wait(STEP_S, answer)
    consumer.wait(40.0, answer)
    assert consumer.out == list(range(producer.sent))
    assert consumer.inbox.counts.lost == 0


@pytest.mark.parametrize("ended", [True, False])
def test_a_checkpoint_that_had_ended_is_complete(ended):
    consumer = Consumer(Position(0, 4, ended=ended))
    consumer.wait(10.0, nobody)
    assert (len(consumer.asked) == 1) is ended
