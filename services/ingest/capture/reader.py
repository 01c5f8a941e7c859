"""A camera's frames as messages of a session: in order, on its clock, in the room, one person. Pure."""

from collections.abc import Iterable

import numpy as np

from schemas.health import Reason, Rejection, StreamCount
from schemas.signals import SKELETON
from services.flow.message import Stream
from services.flow.rejections import RejectionCounter
from services.ingest.capture.datagram import CameraFrame
from services.ingest.capture.following import Followed, Follower
from services.ingest.capture.people import SeenBody
from services.ingest.capture.sequence import Sequence
from services.ingest.clock import ClockEvent, DeviceClock
from services.ingest.driver import SourceMessage
from services.ingest.skeleton import CameraView, RoomFrames, frames_in_room, skeleton_batch

Arrived = tuple[int, CameraFrame]
"""Session time of arrival, ns, and the frame."""

TRACKED = 2


class FrameReader:
    """One camera. Arrival times are session time, ns, and come as arguments.

    sent = received + lost + late, once no frame is held: `count` has the first two, `rejections` the late.
    """

    def __init__(self, name: str, view: CameraView) -> None:
        self._name = name
        self._stream = Stream(SKELETON, name)
        self._view = view
        self._order: Sequence[Arrived] = Sequence()
        self._clock = DeviceClock()
        self._follower = Follower(view.room_joints)
        self._rejections = RejectionCounter()

    def take(self, frame: CameraFrame, arrival_ns: int) -> list[SourceMessage]:
        """The messages that a frame leads to: none while an earlier one is waited for."""
        if frame.camera != self._view.kind:
            self._rejections.add(self._name, Reason.UNKNOWN_SENSOR)
            return []
        return self._messages(self._order.add(frame.seq, arrival_ns, (arrival_ns, frame)))

    def due(self, now_ns: int) -> list[SourceMessage]:
        """Messages of frames that have waited long enough for an earlier one."""
        return self._messages(self._order.due(now_ns))

    def new_sender(self) -> list[SourceMessage]:
        """Another computer sends from here on, and counts anew; what was held."""
        return self._messages(self._order.restart())

    def count(self) -> StreamCount:
        """Frames so far. None is ever asked for again."""
        order = self._order
        return StreamCount(
            stream=f"{SKELETON.name}/{self._name}",
            received=order.delivered,
            recovered=0,
            duplicated=order.duplicates,
            lost=order.lost,
        )

    def rejections(self) -> list[Rejection]:
        """What was not used, by reason."""
        late = RejectionCounter()
        late.add(self._name, Reason.LATE, self._order.late)
        return self._rejections.report() + late.report()

    def _messages(self, arrived: Iterable[Arrived]) -> list[SourceMessage]:
        return [message for arrival_ns, frame in arrived if (message := self._message(arrival_ns, frame)) is not None]

    def _message(self, arrival_ns: int, frame: CameraFrame) -> SourceMessage | None:
        reading = self._clock.read(frame.device_ns, arrival_ns)
        if reading.captured_ns is None:
            self._rejections.add(self._name, Reason.CLOCK_BACKWARDS)
            return None
        if reading.event is ClockEvent.JUMPED:
            self._rejections.add(f"{self._name} clock", Reason.CLOCK_BACKWARDS)
        everybody = self._in_room(frame)
        bodies = [
            SeenBody(body.id, everybody.position[k], everybody.state[k] == TRACKED)
            for k, body in enumerate(frame.bodies)
        ]
        followed = self._follower.take(reading.captured_ns, bodies)
        chosen = self._of(followed, everybody)
        batch = skeleton_batch([reading.captured_ns], [followed.number], [len(frame.bodies)], chosen)
        return SourceMessage(self._stream, reading.captured_ns, batch)

    def _in_room(self, frame: CameraFrame) -> RoomFrames:
        """Every body as if it were a frame of its own."""
        joints = len(self._view.joints)
        positions = np.array([body.positions for body in frame.bodies]).reshape(-1, joints, 3)
        codes = np.array([body.codes for body in frame.bodies], dtype=np.int64).reshape(-1, joints)
        room = frames_in_room(self._view, positions, codes)
        self._rejections.add(self._name, Reason.NOT_FINITE, room.not_finite)
        self._rejections.add(self._name, Reason.OUT_OF_RANGE, room.out_of_range)
        return room

    def _of(self, followed: Followed, everybody: RoomFrames) -> RoomFrames:
        if followed.place is None:
            joints = len(everybody.joints)
            nowhere, unknown = np.full((1, joints, 3), np.nan), np.zeros((1, joints), dtype=np.int64)
            return everybody._replace(position=nowhere, state=unknown)
        only = slice(followed.place, followed.place + 1)
        return everybody._replace(position=everybody.position[only], state=everybody.state[only])
