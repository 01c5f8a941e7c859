"""When a sensor or a camera told nothing, out of raw messages that are looked at and not decoded."""

from collections.abc import Iterable, Sequence
from typing import Literal, NamedTuple

from schemas.session import SessionDescription
from schemas.signals import IMU
from services.recordings.record import Record

SILENT_NS = 250_000_000
"""Without a new sample for so long a live page calls a sensor missing, or stuck when it repeats itself."""

Kind = Literal["missing", "stuck", "nobody"]

_SENSOR = b'{"captured_ns":['
_VALUES = b',"angular_velocity":'
_BODY = b'"body":['


class Loss(NamedTuple):
    """A source told nothing from its last new sample to its next one. `end_ns` None: until after what was looked at."""

    source: str
    kind: Kind
    """`nobody`: the camera speaks and sees no person."""
    start_ns: int
    end_ns: int | None


class _Heard:
    """One sensor, or one camera, as its messages go by."""

    def __init__(self, name: str, from_ns: int) -> None:
        self.name = name
        self.new_ns = self.any_ns = from_ns
        self._values = b""

    def take(self, now_ns: int, values: bytes) -> Loss | None:
        """Its part of a message; empty when it said nothing. The loss that has just ended, if there was one."""
        ended = None
        if values and values != self._values:
            if now_ns - self.new_ns > SILENT_NS:
                ended = Loss(self.name, self.kind, self.new_ns, now_ns)
            self.new_ns, self._values = now_ns, values
        if values:
            self.any_ns = now_ns
        return ended

    @property
    def kind(self) -> Kind:
        """Of the loss that goes on."""
        return "stuck" if self.any_ns - self.new_ns > SILENT_NS else "missing"

    def rest(self, until_ns: int) -> Loss | None:
        """What had not ended."""
        return Loss(self.name, self.kind, self.new_ns, None) if until_ns - self.new_ns > SILENT_NS else None


def losses(description: SessionDescription, records: Iterable[Record], from_ns: int, until_ns: int) -> list[Loss]:
    """Losses in raw messages of a stretch of time, ns of session time, by their start.

    Each source is taken to have been heard at `from_ns`, so the stretch is to begin a little before what is asked for.
    """
    hubs = {hub.name: [_Heard(sensor.name, from_ns) for sensor in hub.sensors] for hub in description.hubs}
    cameras = {camera.name: (_Heard(camera.name, from_ns), _Person(camera.name)) for camera in description.cameras}
    found: list[Loss | None] = []
    for record in records:
        now_ns, source = record.envelope.captured_ns, record.stream.source
        if record.stream.signal is IMU:
            sensors = hubs.get(source, [])
            parts = sensor_parts(record.payload, len(sensors))
            ended = (heard.take(now_ns, part) for heard, part in zip(sensors, parts, strict=True))
            found += filter(None, ended)
        elif source in cameras:
            heard, person = cameras[source]
            found += filter(None, (heard.take(now_ns, record.payload), person.take(now_ns, record.payload)))
    found += [heard.rest(until_ns) for sensors in hubs.values() for heard in sensors]
    found += [each.rest(until_ns) for pair in cameras.values() for each in pair]
    return sorted((loss for loss in found if loss is not None), key=lambda loss: (loss.start_ns, loss.source))


class _Person:
    """Whether a camera sees somebody."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._away_ns: int | None = None

    def take(self, now_ns: int, payload: bytes) -> Loss | None:
        start = payload.find(_BODY) + len(_BODY)
        is_away = b"null" in payload[start : payload.find(b"]", start)]
        if is_away:
            self._away_ns = now_ns if self._away_ns is None else self._away_ns
            return None
        away_ns, self._away_ns = self._away_ns, None
        is_long = away_ns is not None and now_ns - away_ns > SILENT_NS
        return Loss(self._name, "nobody", away_ns, now_ns) if away_ns is not None and is_long else None

    def rest(self, until_ns: int) -> Loss | None:
        is_long = self._away_ns is not None and until_ns - self._away_ns > SILENT_NS
        return Loss(self._name, "nobody", self._away_ns, None) if self._away_ns is not None and is_long else None


def sensor_parts(payload: bytes, count: int) -> Sequence[bytes]:
    """The values of each sensor of a hub's message as they stand in it, without their times; empty where it was silent.

    A hundred messages a second are looked at for an hour: decoding them would take a minute.
    """
    parts = payload.split(_SENSOR)[1:]
    if len(parts) != count:
        return [b""] * count
    return [b"" if part[:1] == b"]" else part[part.find(_VALUES) : part.find(b"}")] for part in parts]


def is_marked(record: Record) -> bool:
    """Whether a raw message carries a mark of the operator."""
    return b'"marks":[{' in record.payload
