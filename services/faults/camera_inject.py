"""Puts faults into a camera's stream of frames. Pure and seeded: the same input gives the same damage."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from schemas.signals import SKELETON
from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import SkeletonJoint
from services.faults.camera_changes import Frame, frame_change
from services.faults.camera_faults import CameraFault
from services.flow.message import Message


def inject_camera(
    messages: Iterable[Message], camera: str, joints: Sequence[SkeletonJoint], faults: Sequence[CameraFault]
) -> Iterator[Message]:
    """Damage the frames of one camera; `CameraInjection` also tells what was lost."""
    return CameraInjection(camera, joints, faults).apply(messages)


class CameraInjection:
    """Faults at work on one camera, one after another in the order given, and the frames they took away.

    Every frame is judged by its own time, so it makes no difference how frames are batched into messages.
    """

    def __init__(self, camera: str, joints: Sequence[SkeletonJoint], faults: Sequence[CameraFault]) -> None:
        self.sent = 0
        """Frames that the camera had."""
        self.lost: set[int] = set()
        """Times of the frames that were taken away, ns. All others were delivered."""
        self._camera = camera
        self._changes = [frame_change(fault, list(joints)) for fault in faults]

    def apply(self, messages: Iterable[Message]) -> Iterator[Message]:
        """The damaged stream; what is no frame of this camera passes unchanged.

        A message without a frame left is not sent and the numbering goes on without a hole; its marks, which are the
        operator's and not the camera's, go with the next.
        """
        swallowed, waiting = 0, []
        for message in messages:
            if message.stream.signal is not SKELETON or message.stream.source != self._camera:
                yield message
                continue
            payload = message.payload
            if isinstance(payload, SkeletonBatch):
                damaged = self._damage(payload)
                if damaged is None:
                    waiting += payload.marks
                    swallowed += 1
                    continue
                payload, waiting = damaged.model_copy(update={"marks": waiting + payload.marks}), []
            envelope = replace(message.envelope, sequence=message.envelope.sequence - swallowed)
            yield Message(message.stream, envelope, payload)

    def _damage(self, batch: SkeletonBatch) -> SkeletonBatch | None:
        columns = (batch.captured_ns, batch.body, batch.people, batch.position, batch.state)
        left: list[Frame] = []
        for frame in (Frame(*parts) for parts in zip(*columns, strict=True)):
            self.sent += 1
            changed = self._changed(frame)
            if changed is None:
                self.lost.add(frame.captured_ns)
            else:
                left.append(changed)
        if not left:
            return None
        fields = dict(zip(Frame._fields, (list(column) for column in zip(*left, strict=True)), strict=True))
        return SkeletonBatch(**fields, marks=[])

    def _changed(self, frame: Frame) -> Frame | None:
        so_far: Frame | None = frame
        for change in self._changes:
            if so_far is None:
                return None
            so_far = change(so_far)
        return so_far
