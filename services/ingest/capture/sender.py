"""Any recorded or simulated skeleton as the datagrams of a capture PC. Pure."""

import json
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from schemas.session import CameraDescription, SessionDescription
from schemas.signals import SKELETON
from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import CameraKind, TrackingState
from services.ingest.driver import SourceMessage
from services.ingest.errors import SourceError
from services.ingest.skeleton import CameraView, view_of
from services.ingest.skeleton.vendors import VENDORS

NOT_TRACKED = [0.0, 0.0, 0.0, 0]


class NoCamera(SourceError):
    """A source without a skeleton to send."""


class TimedDatagram(NamedTuple):
    """What a capture PC sends at a time of the session, ns."""

    captured_ns: int
    datagram: bytes


def camera_to_send(description: SessionDescription) -> CameraDescription:
    """The first camera of a session. Raises NoCamera."""
    if not description.cameras:
        raise NoCamera(f"{description.title!r} has no camera; choose a recording with a skeleton, e.g. kimore_squat")
    return description.cameras[0]


def datagrams(camera: CameraDescription, messages: Iterable[SourceMessage]) -> Iterator[TimedDatagram]:
    """A camera's frames in the axes, unit and joint order of its SDK; of one without an SDK in those of a Kinect v2.

    The camera is taken to stand level: what it looked like when tilted is not in the stream any more.
    """
    kind = camera.kind if camera.kind in VENDORS else CameraKind.KINECT_V2
    view = view_of(kind)
    places = [camera.joints.index(joint) if joint in camera.joints else None for joint in view.joints]
    up = view.R_room_from_camera[1].tolist()
    floor = None if camera.floor_m is None else [*up, -camera.floor_m / view.metres]
    seq = 0
    for message in messages:
        batch = message.payload
        if message.stream.signal is not SKELETON or message.stream.source != camera.name:
            continue
        assert isinstance(batch, SkeletonBatch), "what a skeleton stream carries"
        for k, captured_ns in enumerate(batch.captured_ns):
            frame: dict[str, Any] = {"camera": kind.value, "t_ns": captured_ns, "seq": seq}
            frame |= {"up": up} if floor is None else {"floor": floor}
            frame["bodies"] = _bodies(batch, k, view, places)
            yield TimedDatagram(captured_ns, json.dumps(frame).encode())
            seq += 1


def _bodies(batch: SkeletonBatch, k: int, view: CameraView, places: list[int | None]) -> list[dict[str, Any]]:
    """The one person of a frame, or nobody."""
    if all(state is TrackingState.NOT_TRACKED for state in batch.state[k]):
        return []
    joints = [NOT_TRACKED if place is None else _joint(batch, k, place, view) for place in places]
    return [{"id": batch.body[k] or 0, "joints": joints}]


def _joint(batch: SkeletonBatch, k: int, place: int, view: CameraView) -> list[float]:
    position, state = batch.position[k][place], batch.state[k][place]
    if position is None:
        return NOT_TRACKED
    x, y, z = (np.array(position) @ view.R_room_from_camera / view.metres).tolist()
    return [x, y, z, view.states.index(state)]
