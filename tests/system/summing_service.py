"""A node service for tests, run as a script: sums what its hub sends, so that a wrong resume shows in the output."""

import sys

from schemas.gait import GaitEvent
from schemas.health import Rejection
from schemas.imu import ImuBatch
from schemas.kinematics import LivePose
from schemas.session import SessionDescription
from schemas.signals import GAIT_EVENT, IMU, LIVE_POSE, Signal
from schemas.vocabulary import GaitEventKind, Side
from services.flow.message import Message, Output, Stream
from services.flow.node import Node, State

SERVICE = "estimation"
HUB = Stream(IMU, "hub")
TROUBLE_NS = -1
"""A sample with this time makes the node raise."""


class SummingNode:
    """Puts out the running sum of the samples' times, and a pose for each tenth message."""

    outputs: tuple[Signal, ...] = (GAIT_EVENT, LIVE_POSE)
    streams: tuple[Stream, ...] = (HUB,)

    def __init__(self) -> None:
        self._sum = 0.0
        self._count = 0

    def step(self, message: Message) -> list[Output]:
        assert isinstance(message.payload, ImuBatch)
        times = [time for sensor in message.payload.sensors for time in sensor.captured_ns]
        if TROUBLE_NS in times:
            raise ArithmeticError("a bug met on purpose")
        self._sum += sum(times)
        self._count += 1
        outputs = [self._event(message.envelope.captured_ns)]
        if self._count % 10 == 0:
            outputs.append(Output(LIVE_POSE, message.envelope.captured_ns, _pose(message.envelope.captured_ns)))
        return outputs

    def finish(self) -> list[Output]:
        return [self._event(-1)]

    def snapshot(self) -> State:
        return {"sum": self._sum, "count": self._count}

    def restore(self, state: State) -> None:
        self._sum, self._count = state["sum"], state["count"]

    def rejections(self) -> list[Rejection]:
        return []

    def _event(self, captured_ns: int) -> Output:
        event = GaitEvent(
            kind=GaitEventKind.INITIAL_CONTACT, side=Side.LEFT, captured_ns=captured_ns, time_std_s=self._sum
        )
        return Output(GAIT_EVENT, captured_ns, event)


def _pose(captured_ns: int) -> LivePose:
    return LivePose(
        captured_ns=captured_ns, phase="estimating", message="", notice="", segments=[], angles={}, angles_std={},
        centres={},
        cameras=[],
        sensors=[], cadence_per_min=None, stood=None,
    )  # fmt: skip


def build(_description: SessionDescription) -> Node:
    """A node for any session."""
    return SummingNode()


if __name__ == "__main__":
    from services.bus.runner import run_node_service

    sys.exit(run_node_service(SERVICE, build))
