"""One file of a session, checked from end to end: what it holds, where its chunks are, and whether it is whole."""

import hashlib
import io
import struct
from dataclasses import dataclass, field
from pathlib import Path

from mcap.data_stream import ReadDataStream
from mcap.records import Metadata

from schemas.archive_layout import (
    DESCRIPTION_FIELD,
    DESCRIPTION_SHA256_KEY,
    END_TOPIC,
    SESSION_METADATA,
    SESSION_TOPIC,
    StreamEnd,
    captured_ns,
)
from schemas.health import Gap
from schemas.session import SessionDescription
from schemas.signals import GAP
from services.recordings.chunks import (
    BROKEN,
    ChannelFacts,
    ChunkSpan,
    RawMessage,
    inner_records,
    open_chunk,
    parse_channel,
    parse_message,
)
from services.recordings.errors import Damage
from services.recordings.frames import Frame, Opcode, corrupt, read_frames
from services.recordings.ledger import Ledger
from services.recordings.limits import LIMITS, ReadLimits

GAP_TOPIC = f"{GAP.name}/{GAP.producer}"
_INDEX_HEAD = struct.Struct("<HI")


@dataclass
class SegmentScan:
    """What is known of a file after all of it has been looked at. `whole`: closed in order, nothing altered."""

    path: Path
    description: SessionDescription | None = None
    metadata: list[Metadata] = field(default_factory=list)
    channels: dict[int, ChannelFacts] = field(default_factory=dict)
    chunks: list[ChunkSpan] = field(default_factory=list)
    ledger: Ledger = field(default_factory=Ledger)
    messages: int = 0
    whole: bool = False
    damage: Damage | None = None


def scan(path: Path, clocks: dict[str, int] | None = None, limits: ReadLimits = LIMITS) -> SegmentScan:
    """Read a file as far as it can be trusted. Raises OSError only: damage is part of the result.

    `clocks` carries the newest log time of each topic from one file of a session to the next.
    """
    scanner = _Scanner(SegmentScan(path), {} if clocks is None else clocks, limits)
    with path.open("rb") as file:
        try:
            for frame in read_frames(file, limits):
                scanner.take(frame)
        except Damage as damage:
            scanner.result.damage = damage
    scanner.result.whole = scanner.ended and scanner.result.damage is None
    return scanner.result


def description_in(metadata: Metadata) -> SessionDescription | None:
    """The session that a metadata record describes; None for one of another kind. Raises one of BROKEN."""
    if metadata.name != SESSION_METADATA:
        return None
    text = metadata.metadata[DESCRIPTION_FIELD]
    if hashlib.sha256(text.encode()).hexdigest() != metadata.metadata[DESCRIPTION_SHA256_KEY]:
        raise ValueError("the session description has been altered")
    return SessionDescription.model_validate_json(text)


class _Scanner:
    """Takes the frames of one file; a chunk counts only when every message in it is in its place."""

    def __init__(self, result: SegmentScan, clocks: dict[str, int], limits: ReadLimits) -> None:
        self.result = result
        self.ended = False
        self._clocks = clocks
        self._limits = limits
        self._unindexed: set[int] = set()

    def take(self, frame: Frame) -> None:
        """One frame of the data section. Raises Damage."""
        try:
            if frame.opcode == Opcode.CHUNK:
                self._chunk(frame)
            elif frame.opcode == Opcode.MESSAGE_INDEX:
                self._index(frame)
            elif frame.opcode == Opcode.METADATA:
                self._metadata(frame)
            self.ended = frame.opcode == Opcode.DATA_END
        except BROKEN as error:
            raise corrupt(frame.offset, str(error) or type(error).__name__) from error

    def _metadata(self, frame: Frame) -> None:
        metadata = Metadata.read(ReadDataStream(io.BytesIO(frame.body)))
        self.result.description = description_in(metadata) or self.result.description
        self.result.metadata.append(metadata)

    def _index(self, frame: Frame) -> None:
        """A stray or repeated index means that the chunk before it is not what it was."""
        channel, length = _INDEX_HEAD.unpack_from(frame.body)
        if length != len(frame.body) - _INDEX_HEAD.size or channel not in self._unindexed:
            raise ValueError("an index does not belong to the chunk before it")
        self._unindexed.remove(channel)

    def _chunk(self, frame: Frame) -> None:
        if self.result.description is None:
            raise ValueError("a chunk before the session description")
        messages = self._read(open_chunk(frame.body, self._limits))
        ledger = self.result.ledger.copy()
        for message in messages:
            _place(ledger, self.result.description, message)
        self.result.ledger = ledger
        named = [(message.clock, message.log_time) for message in messages]
        clocks = {clock: self._clocks[clock] for clock, _ in named if clock in self._clocks}
        from_ns = min((max(log_time, clocks.get(clock, 0)) for clock, log_time in named), default=0)
        for clock, log_time in named:
            self._clocks[clock] = max(log_time, self._clocks.get(clock, 0))
        span = ChunkSpan(self.result.path, frame.offset, len(frame.body), from_ns, clocks, self.result.channels)
        self.result.chunks.append(span)
        self.result.messages += len(messages)

    def _read(self, data: bytes) -> list[RawMessage]:
        messages = []
        self._unindexed = set()
        for opcode, body in inner_records(data):
            if opcode == Opcode.CHANNEL:
                number, facts = parse_channel(body)
                if self.result.channels.setdefault(number, facts) != facts:
                    raise ValueError(f"channel {number} is announced twice, differently")
            elif opcode == Opcode.MESSAGE:
                messages.append(parse_message(body, self.result.channels))
                self._unindexed.add(struct.unpack_from("<H", body)[0])
        return messages


def _place(ledger: Ledger, description: SessionDescription, message: RawMessage) -> None:
    """Keep the books; a message out of its place is damage that no checksum has seen."""
    name, epoch, _ = message.channel
    if name == SESSION_TOPIC:
        return
    if name == GAP_TOPIC:
        gap = Gap.model_validate_json(message.data)
        _expect(ledger, gap.stream, gap.epoch, gap.first_sequence)
        ledger.advance(gap.stream, gap.epoch, gap.first_sequence, gap.last_sequence)
    elif name == END_TOPIC:
        end = StreamEnd.model_validate_json(message.data)
        _expect(ledger, end.stream, end.epoch, end.sequence)
        ledger.count(end.stream, end.epoch, end.sequence, end.captured_ns, final=True)
    else:
        _expect(ledger, name, epoch, message.sequence)
        time = captured_ns(description, message.log_time)
        ledger.count(name, epoch, message.sequence, time, final=False)


def _expect(ledger: Ledger, stream: str, epoch: int, sequence: int) -> None:
    expected = ledger.expected(stream, epoch)
    if expected not in (None, sequence):
        raise ValueError(f"{stream} epoch {epoch}: sequence {sequence} where {expected} belongs")
