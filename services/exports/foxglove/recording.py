"""The recording: MCAP with JSON messages, each channel with its schema; written as the messages are read."""

import json
import math
from collections.abc import Iterable, Iterator
from typing import Any, BinaryIO

from mcap.writer import CompressionType, Writer

from schemas.gait import GaitEvent, Stride
from schemas.kinematics import JointCentres, JointState
from schemas.payload import Payload
from schemas.tasks import TaskPhase
from services.exports.facts import Facts, freedoms_of
from services.exports.foxglove import schemas
from services.exports.foxglove.scene import scene, stamp, transforms
from services.exports.foxglove.skeletons import Skeleton, Skeletons
from services.flow.software import SOFTWARE

ANGLES_TOPIC, SCENE_TOPIC, FRAMES_TOPIC = "/joint_angles", "/skeleton", "/tf"
STRIDES_TOPIC, EVENTS_TOPIC = "/strides", "/events"
FACTS = "ambula.facts"
"""Metadata record with the lines that every file starts with."""
_INFO = 2
_DECIMALS = 5


class FoxgloveRecording:
    """Takes derived messages in order of time. Times of the file are wall time: the session's start plus its own."""

    def __init__(self, file: BinaryIO, facts: Facts) -> None:
        self._facts = facts
        self._writer = Writer(file, compression=CompressionType.ZSTD)
        self._writer.start(profile="", library=SOFTWARE)
        self._channels: dict[str, int] = {}
        self._counts: dict[int, int] = {}
        self._skeletons = Skeletons(facts.description.anthropometry)

    def take(self, payload: Payload) -> None:
        """One message; kinds that are not shown are left out."""
        match payload:
            case JointState():
                self._angles(payload)
                self._draw(self._skeletons.take(payload))
            case JointCentres():
                self._draw(self._skeletons.take(payload))
            case GaitEvent(kind=kind, side=side, captured_ns=captured_ns):
                self._log(captured_ns, f"{kind.replace('_', ' ')}, {side}", "gait")
            case TaskPhase(start_ns=start_ns, end_ns=None):
                self._log(start_ns, f"{payload.phase.replace('_', ' ')} begins", str(payload.task))
            case TaskPhase(end_ns=int(end_ns)):
                self._log(end_ns, f"{payload.phase.replace('_', ' ')} ends", str(payload.task))
            case Stride():
                self._stride(payload)

    def close(self) -> None:
        """Write what was held back, the facts, and the index. The file itself stays open."""
        self._draw(self._skeletons.rest())
        lines = (line.partition(": ") for line in self._facts.lines())
        self._writer.add_metadata(FACTS, {word: says for word, _, says in lines})
        self._writer.finish()

    def _angles(self, state: JointState) -> None:
        names = [freedom.name for freedom in freedoms_of(state.model)]
        for i, captured_ns in enumerate(state.captured_ns):
            message: dict[str, float] = {"time_s": captured_ns * 1e-9}
            for name, angle, std, valid in zip(
                names, state.position[i], state.position_std[i], state.valid, strict=True
            ):
                if valid:
                    message[f"{name}_deg"] = round(math.degrees(angle), _DECIMALS)
                    message[f"{name}_std_deg"] = round(math.degrees(std), _DECIMALS)
            self._write(ANGLES_TOPIC, captured_ns, message, lambda: schemas.joint_angles(state.model))

    def _draw(self, skeletons: Iterable[Skeleton]) -> None:
        for one in skeletons:
            unix_ns = self._unix(one.captured_ns)
            drawing = scene(unix_ns, one.names, one.points, one.told)
            self._write(SCENE_TOPIC, one.captured_ns, drawing, lambda: schemas.SCENE_UPDATE)
            self._write(FRAMES_TOPIC, one.captured_ns, transforms(unix_ns, one.segments), _frame_transforms)

    def _log(self, captured_ns: int, message: str, name: str) -> None:
        entry = {
            "timestamp": stamp(self._unix(captured_ns)),
            "level": _INFO,
            "message": message,
            "name": name,
            "file": "",
            "line": 0,
        }
        self._write(EVENTS_TOPIC, captured_ns, entry, lambda: schemas.LOG)

    def _stride(self, stride: Stride) -> None:
        numbers = {name: getattr(stride, name) for name in schemas.STRIDE_NUMBERS}
        message = {
            "time_s": stride.end_ns * 1e-9,
            "side": stride.side,
            "valid": stride.valid,
            **{name: value for name, value in numbers.items() if value is not None},
        }
        self._write(STRIDES_TOPIC, stride.end_ns, message, lambda: schemas.STRIDE)

    def _write(self, topic: str, captured_ns: int, message: Any, schema: Any) -> None:
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._channels[topic] = self._register(topic, schema())
            self._counts[channel] = 0
        at = self._unix(captured_ns)
        data = json.dumps(message, separators=(",", ":"), allow_nan=False).encode()
        self._writer.add_message(channel, at, data, at, self._counts[channel])
        self._counts[channel] += 1

    def _register(self, topic: str, schema: schemas.Schema) -> int:
        number = self._writer.register_schema(schema["title"], "jsonschema", json.dumps(schema).encode())
        return int(self._writer.register_channel(topic, "json", number, {"session": self._facts.description.session}))

    def _unix(self, captured_ns: int) -> int:
        return max(self._facts.description.started_unix_ns + captured_ns, 0)


def foxglove_recording(facts: Facts, payloads: Iterable[Payload]) -> Iterator[bytes]:
    """The file in parts, as the messages come."""
    sink = _Sink()
    recording = FoxgloveRecording(sink, facts)  # type: ignore[arg-type]
    for payload in payloads:
        recording.take(payload)
        if sink.waiting:
            yield sink.taken()
    recording.close()
    yield sink.taken()


class _Sink:
    """What the MCAP writer takes for a file: it appends and asks where it is."""

    def __init__(self) -> None:
        self.waiting: list[bytes] = []
        self._written = 0

    def write(self, data: bytes) -> int:
        """Append."""
        self.waiting.append(bytes(data))
        self._written += len(data)
        return len(data)

    def tell(self) -> int:
        """Bytes so far."""
        return self._written

    def flush(self) -> None:
        """Nothing is held back."""

    def taken(self) -> bytes:
        """What has come since the last time."""
        data = b"".join(self.waiting)
        self.waiting.clear()
        return data


def _frame_transforms() -> schemas.Schema:
    return schemas.FRAME_TRANSFORMS
