"""A hosted node numbers what it puts out, closes its streams, and goes on after a freeze as if nothing had been."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from schemas.checkpoint import Checkpoint
from schemas.gait import GaitEvent
from schemas.health import Rejection
from schemas.imu import ImuBatch, SensorSamples
from schemas.signals import GAIT_EVENT, IMU, METRICS, Signal
from schemas.vocabulary import GaitEventKind, Side
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.flow.message import Envelope, Message, Output, Stream
from services.flow.node import State
from services.flow.position import Position

LEFT, RIGHT = Stream(IMU, "left"), Stream(IMU, "right")


class Adder:
    """Sums sample times; puts an event out for each even sum, and one at the end."""

    outputs: tuple[Signal, ...] = (GAIT_EVENT, METRICS)
    streams: tuple[Stream, ...] = (LEFT, RIGHT)

    def __init__(self) -> None:
        self.total = 0

    def step(self, message: Message) -> list[Output]:
        assert isinstance(message.payload, ImuBatch)
        self.total += message.payload.sensors[0].captured_ns[0]
        return [self._event()] if self.total % 2 == 0 else []

    def finish(self) -> list[Output]:
        return [self._event()]

    def snapshot(self) -> State:
        return {"total": self.total}

    def restore(self, state: State) -> None:
        self.total = state["total"]

    def rejections(self) -> list[Rejection]:
        return []

    def _event(self) -> Output:
        event = GaitEvent(
            kind=GaitEventKind.TOE_OFF, side=Side.LEFT, captured_ns=self.total, time_std_s=float(self.total)
        )
        return Output(GAIT_EVENT, self.total, event)


def message(stream: Stream, sequence: int, value: int = 0, epoch: int = 0, *, final: bool = False) -> Message:
    samples = SensorSamples(captured_ns=[value], angular_velocity=[[0.0] * 3], specific_force=[[0.0] * 3])
    batch = ImuBatch(sensors=[samples], marks=[])
    return Message(stream, Envelope(epoch, sequence, value, final), None if final else batch)


def stream_of(values: list[int]) -> list[Message]:
    messages = [message(LEFT, number, value) for number, value in enumerate(values)]
    return [*messages, message(LEFT, len(values), final=True), message(RIGHT, 0, final=True)]


def host(epoch: int = 0) -> HostedNode:
    return HostedNode("segmentation", "s", Adder(), epoch)


@given(st.lists(st.integers(0, 9), max_size=20), st.data())
def test_split_and_resume_puts_out_the_same(values, data):
    messages = stream_of(values)
    whole = host()
    expected = [out for one in messages for out in whole.accept(one)]
    cut = data.draw(st.integers(0, len(messages)))
    first, second = host(), host()
    out = [out for one in messages[:cut] for out in first.accept(one)]
    second.resume(Checkpoint.model_validate_json(first.checkpoint().model_dump_json()))
    out += [out for one in messages[cut:] for out in second.accept(one)]
    assert out == expected
    assert second.checkpoint() == whole.checkpoint()
    assert second.ended


def test_outputs_are_numbered_without_holes_and_closed_after_the_last_input():
    one = host()
    out = [out for given_message in stream_of([2, 2, 1, 1]) for out in one.accept(given_message)]
    events = [o for o in out if o.stream.signal is GAIT_EVENT]
    assert [e.envelope.sequence for e in events] == list(range(5))
    assert [e.envelope.final for e in events] == [False] * 4 + [True]
    assert [o.envelope.sequence for o in out if o.stream.signal is METRICS] == [0]
    assert out[-1].payload is None


def test_nothing_is_closed_while_an_input_is_open():
    one = host()
    assert one.accept(message(LEFT, 0, final=True)) == []
    assert not one.ended
    assert one.accept(message(RIGHT, 0, final=True))
    assert one.ended


def test_a_newer_input_epoch_starts_the_numbers_again():
    one = host()
    one.accept(message(LEFT, 0, 2))
    (out,) = one.accept(message(LEFT, 0, 2, epoch=5))
    assert (out.envelope.epoch, out.envelope.sequence) == (5, 0)


def test_a_host_that_starts_in_the_middle_uses_its_own_epoch():
    (out,) = host(epoch=1234).accept(message(LEFT, 70, 2))
    assert (out.envelope.epoch, out.envelope.sequence) == (1234, 0)
    resumed = host()
    one = host(epoch=1234)
    one.accept(message(LEFT, 70, 2))
    resumed.resume(one.checkpoint())
    (out,) = resumed.accept(message(LEFT, 71, 2))
    assert (out.envelope.epoch, out.envelope.sequence) == (1234, 1)


def test_a_skipped_message_moves_the_position_only():
    one = host()
    one.skip(LEFT, Envelope(0, 7, 99))
    assert one.inputs[LEFT] == Position(0, 7, ended=False)
    assert one.captured_ns == 99
    assert one.node.snapshot() == {"total": 0}


def test_a_foreign_checkpoint_is_refused():
    other = HostedNode("metrics", "s", Adder())
    with pytest.raises(ValueError, match="checkpoint of metrics/s"):
        host().resume(other.checkpoint())


def test_a_chain_feeds_each_node_what_it_reads():
    chain = Chain([host()])
    produced = [out for one in stream_of([2, 2]) for out in chain.push(one)]
    assert [out.envelope.sequence for out in produced if out.stream.signal is GAIT_EVENT] == [0, 1, 2, 3]
    assert chain.push(Message(Stream(IMU, "elsewhere"), Envelope(0, 0, 0), None)) == []
