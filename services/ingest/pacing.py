"""How far a session may be sent: by the clock, or as far as its readers follow. Pure: times come as arguments."""

from bisect import bisect_right
from dataclasses import dataclass, field
from typing import Protocol

from services.ingest.parameters import PARAMETERS, IngestParameters

MOST_REMEMBERED = 20_000
"""Messages of a stream whose times are kept while nobody says that it has them; a minute of the fastest hub."""

FAR_NS = 2**62
"""Later than any sample."""


class Pace(Protocol):
    """Says up to which session time messages may go."""

    def limit_ns(self, now_s: float) -> int:
        """ns of session time at the monotonic time `now_s`."""

    @property
    def paced(self) -> bool:
        """True when being late means lagging behind a clock."""


@dataclass(frozen=True)
class RealTime:
    """`speed` seconds of the session per second."""

    started_s: float
    speed: float
    paced: bool = True

    def limit_ns(self, now_s: float) -> int:
        """Session time that has come."""
        return round((now_s - self.started_s) * self.speed * 1e9)


@dataclass(frozen=True)
class AsItComes:
    """A device: whatever is there is due."""

    paced: bool = False

    def limit_ns(self, _now_s: float) -> int:
        """No limit."""
        return FAR_NS


@dataclass
class _Reader:
    """How far one service has come, ns, and when it last made a step."""

    done_ns: int
    stepped_s: float


@dataclass
class Readers:
    """Who reads this session's own streams, and how far each is; learnt from Progress messages.

    Services further down the chain are not counted: they may have nothing to read for minutes (a standing patient
    makes no strides), and who reads the samples waits for nobody. `streams` are the session's own, signal/source.
    """

    streams: list[str]
    parameters: IngestParameters = PARAMETERS
    _sent: dict[str, tuple[list[int], list[int]]] = field(init=False)
    _readers: dict[str, _Reader] = field(default_factory=dict)
    _positions: dict[str, dict[str, int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._sent = {stream: ([], []) for stream in self.streams}

    def sent(self, stream: str, sequence: int, captured_ns: int) -> None:
        """A message went out."""
        sequences, times = self._sent[stream]
        sequences.append(sequence)
        times.append(captured_ns)
        if len(sequences) > 2 * MOST_REMEMBERED:
            del sequences[:MOST_REMEMBERED], times[:MOST_REMEMBERED]

    def expect(self, service: str, now_s: float) -> None:
        """A running service will read the samples, though it has not said how far it is."""
        self._readers.setdefault(service, _Reader(0, now_s))

    def report(self, service: str, positions: dict[str, int], now_s: float) -> None:
        """A service's Progress. Ignored when it reads none of this session's own streams."""
        own = {name: position for name, position in positions.items() if name in self._sent}
        if not own:
            return
        self._positions[service] = own
        done_ns = min(self._captured_ns(name, position) for name, position in own.items())
        reader = self._readers.get(service)
        if reader is None or done_ns > reader.done_ns:
            self._readers[service] = _Reader(done_ns, now_s)

    def slowest_ns(self, now_s: float) -> int | None:
        """Session time that every reader has done; None without readers. The silent ones are left behind."""
        silent_s = self.parameters.silent_after_s
        followed = [reader.done_ns for reader in self._readers.values() if now_s - reader.stepped_s < silent_s]
        return min(followed, default=None)

    def _captured_ns(self, name: str, position: int) -> int:
        """Session time of a stream's message; what was sent before it is forgotten once all have it."""
        sequences, times = self._sent[name]
        return times[max(bisect_right(sequences, position) - 1, 0)] if times else 0

    def forget(self) -> None:
        """Drop the record of messages that every reader has."""
        for name, (sequences, times) in self._sent.items():
            done = min((own[name] for own in self._positions.values() if name in own), default=-1)
            keep = max(bisect_right(sequences, done) - 1, 0)
            del sequences[:keep], times[:keep]


@dataclass
class AsFastAsFollowed:
    """Without a clock: at most `most_ahead_s` of session time ahead of the slowest reader."""

    readers: Readers
    started_s: float
    parameters: IngestParameters = PARAMETERS
    paced: bool = False

    def limit_ns(self, now_s: float) -> int:
        """Without readers it waits a while at the beginning for some to come, then goes on alone."""
        slowest_ns = self.readers.slowest_ns(now_s)
        if slowest_ns is None:
            if now_s - self.started_s >= self.parameters.free_after_s:
                return FAR_NS
            slowest_ns = 0
        return slowest_ns + round(self.parameters.most_ahead_s * 1e9)
