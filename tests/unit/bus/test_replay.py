"""Questions on the wire, and the one server per signal that answers them."""

import pytest

from schemas.imu import ImuBatch
from schemas.signals import IMU, replay_key
from services.bus.connection import RemoteError
from services.bus.publisher import StreamPublisher
from services.bus.replay import PAGE, parse_question, question_parameters
from services.flow.message import Envelope, Stream
from services.flow.ring import Place, Question, RingExtent

HUB = Stream(IMU, "hub")


@pytest.mark.parametrize("question", [Question(None, 0, None), Question(3, 17, 20), Question(0, 0, -1)])
def test_a_question_survives_the_wire(question):
    assert parse_question(question_parameters(question, 9)) == (question, 9)


def test_a_person_may_leave_the_parameters_out():
    assert parse_question({}) == (Question(None, 0, None), PAGE)


def test_a_publisher_numbers_keeps_and_answers(connect, wait_until):
    bus, asker = connect(), connect()
    publisher = StreamPublisher(bus, "s", HUB)
    for number in range(3):
        assert publisher.send(number, ImuBatch(sensors=[], marks=[])) == Envelope(0, number, number)
    publisher.end(3)
    key = replay_key("test", "s", IMU, "hub")
    # A server that was declared just now may not be known yet.
    wait_until(lambda: asker.ask(key))
    answers = asker.ask(key, {"from": "1"})
    envelopes = [Envelope.decode(answer.attachment) for answer in answers[:-1]]
    assert [(one.sequence, one.final) for one in envelopes] == [(1, False), (2, False), (3, True)]
    assert answers[-1].attachment == b""
    assert RingExtent.decode(answers[-1].payload) == RingExtent(Place(0, 0), Place(0, 3))
    publisher.close()
    assert asker.ask(key) == []


def test_epochs_number_from_zero(connect):
    publisher = StreamPublisher(connect(), "s", HUB)
    numbers = [publisher.send(0, ImuBatch(sensors=[], marks=[]), epoch).sequence for epoch in (0, 0, 4, 4, 4)]
    assert numbers == [0, 1, 0, 1, 2]
    publisher.end(0)
    assert publisher.newest == Envelope(4, 3, 0, final=True)


def test_an_empty_ring_and_an_unknown_session_say_nothing(connect):
    bus, asker = connect(), connect()
    StreamPublisher(bus, "s", HUB)
    assert asker.ask(replay_key("test", "s", IMU, "hub")) == []
    assert asker.ask(replay_key("test", "other", IMU, "hub")) == []


def test_a_question_with_words_for_numbers_is_refused(connect, wait_until):
    bus, asker = connect(), connect()
    publisher = StreamPublisher(bus, "s", HUB)
    publisher.end(0)
    wait_until(lambda: asker.ask(replay_key("test", "s", IMU, "hub")))
    with pytest.raises(RemoteError, match="ValueError"):
        asker.ask(replay_key("test", "s", IMU, "hub"), {"from": "soon"})
