"""What each sensor and camera was like at a time of a recording, as a live page calls it."""

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TypedDict

from schemas.kinematics import Calibration, CameraStatus, SensorStatus
from schemas.session import SessionDescription
from schemas.signals import CALIBRATION, IMU, SKELETON
from schemas.vocabulary import SensorState
from services.flow.message import decode_payload
from services.gateway.replay.losses import SILENT_NS, Loss, losses
from services.recordings.ranges import RecordedRanges
from services.recordings.record import Record

SECOND_NS = 1_000_000_000
STATES = {"missing": SensorState.MISSING, "stuck": SensorState.STUCK}


class Statuses:
    """What each sensor and camera is like at a time."""

    def __init__(self, description: SessionDescription, lost: Sequence[Loss], unused: Collection[str]) -> None:
        self._unused = unused
        self._sensors = [sensor.name for hub in description.hubs for sensor in hub.sensors]
        self._cameras = [camera.name for camera in description.cameras]
        self._lost = [loss for loss in lost if loss.kind != "nobody"]
        self._nobody = [loss for loss in lost if loss.kind == "nobody"]

    def at(self, now_ns: int) -> tuple[list[SensorStatus], list[CameraStatus]]:
        """Of every source; `since_ns` is the newest sample that was new."""
        gone = {loss.source: loss for loss in self._lost if _goes_on(loss, now_ns)}
        away = {loss.source for loss in self._nobody if _goes_on(loss, now_ns)}
        sensors = [SensorStatus(sensor=name, **self._status(name, gone, now_ns)) for name in self._sensors]
        cameras = [
            CameraStatus(camera=name, people=int(name not in away), **self._status(name, gone, now_ns))
            for name in self._cameras
        ]
        return sensors, cameras

    def _status(self, name: str, gone: dict[str, Loss], now_ns: int) -> "_Status":
        if name in self._unused:
            return {"state": SensorState.UNUSED, "since_ns": 0}
        if name in gone:
            return {"state": STATES[gone[name].kind], "since_ns": gone[name].start_ns}
        return {"state": SensorState.OK, "since_ns": now_ns}


class _Status(TypedDict):
    state: SensorState
    since_ns: int


def _goes_on(loss: Loss, now_ns: int) -> bool:
    return loss.start_ns + SILENT_NS < now_ns and (loss.end_ns is None or now_ns < loss.end_ns)


def statuses_between(ranges: RecordedRanges, from_ns: int, to_ns: int) -> Statuses:
    """For times from <= time < to, ns. Raises DamagedRecording, DecodeError, OSError."""
    return Statuses(ranges.description, losses_between(ranges, from_ns, to_ns), _unused(ranges, to_ns))


def losses_between(
    ranges: RecordedRanges, from_ns: int, to_ns: int, seen: Callable[[Iterator[Record]], Iterator[Record]] = iter
) -> list[Loss]:
    """Losses that go on within from <= time < to, ns. `seen` may look at the raw messages, too, as they go by.

    Raises DamagedRecording, OSError, and what `seen` raises.
    """
    begin_ns = max(0, from_ns - SECOND_NS)
    found = [each for signal in (IMU, SKELETON) for each in ranges.find(signal, begin_ns, to_ns)]
    every = losses(ranges.description, seen(ranges.read(found)), begin_ns, min(to_ns, ranges.end_ns))
    return [loss for loss in every if loss.end_ns is None or loss.end_ns > from_ns]


def _unused(ranges: RecordedRanges, to_ns: int) -> frozenset[str]:
    """Sensors that the newest calibration does not use."""
    found = ranges.find(CALIBRATION, 0, to_ns)
    for stream, envelope, payload, _ in ranges.read(found[-1:]):
        calibration = decode_payload(stream.signal, envelope, payload)
        if isinstance(calibration, Calibration):
            return frozenset(calibration.unused)
    return frozenset()
