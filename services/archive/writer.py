"""Writes one session: every message once, in order, holes named; tells what is safely on the disk."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from schemas.archive_layout import SegmentName
from schemas.health import Gap, Reason
from schemas.session import SessionDescription
from schemas.signals import GAP
from services.archive.disk import Disk
from services.archive.journal import Journal
from services.archive.parameters import PARAMETERS, ArchiveParameters
from services.flow.message import Envelope
from services.recordings.ledger import Ledger
from services.recordings.record import Record


@dataclass(frozen=True)
class Durable:
    """What a power cut cannot take any more: last sequence number of each stream, and the newest session time."""

    positions: dict[str, int] = field(default_factory=dict)
    captured_ns: int = 0
    ended: frozenset[str] = frozenset()


@dataclass
class WriterCounts:
    """What became of the messages."""

    written: int = 0
    duplicated: int = 0
    lost: int = 0
    refused: dict[tuple[str, Reason], int] = field(default_factory=dict)


@dataclass(frozen=True)
class PendingSync:
    """A sync that may run in another thread while the writer goes on taking messages."""

    journals: list[Journal]
    reached: Durable

    def run(self) -> None:
        """Wait for the disk. Raises OSError."""
        for journal in self.journals:
            journal.sync()


class SessionWriter:
    """Appends to the raw and the derived file of a session, which are begun when the first message needs them.

    Not thread-safe: one thread owns it. After an OSError only `close` may be called; `recover` then says where the
    recording stands, and a new writer goes on from there in new files.
    """

    def __init__(
        self,
        folder: Path,
        description: SessionDescription,
        version: str,
        *,
        ledger: Ledger | None = None,
        first_number: int = 0,
        parameters: ArchiveParameters = PARAMETERS,
        disk: Disk | None = None,
        monotonic_s: Callable[[], float] = time.monotonic,
    ) -> None:
        self.folder = folder
        self.description = description
        self.counts = WriterCounts()
        self._version = version
        self._ledger = ledger.copy() if ledger else Ledger()
        self._number = first_number
        self._parameters = parameters
        self._disk = disk or Disk()
        self._monotonic_s = monotonic_s
        self._begun_s = monotonic_s()
        self._journals: dict[str, Journal] = {}
        self._gaps = 0
        self.durable = durable_of(self._ledger)

    def write(self, record: Record) -> None:
        """Take a message: dropped when it is known; what it shows to be missing is written as a gap before it."""
        name, envelope = record.stream.name, record.envelope
        expected = self._ledger.expected(name, envelope.epoch)
        if expected == -1 or (expected is not None and envelope.sequence < expected):
            self.counts.duplicated += 1
            return
        journal = self._journal(record)
        if not journal.fits(record):
            self._refuse(name)
            return
        if envelope.sequence > (first := expected or 0):
            self._gap(journal, record, first)
        journal.add(record)
        self._ledger.count(name, envelope.epoch, envelope.sequence, envelope.captured_ns, final=envelope.final)
        self.counts.written += 1

    @property
    def full(self) -> bool:
        """The open files have reached their age; `flush` and `close` begin new ones."""
        return bool(self._journals) and self._monotonic_s() - self._begun_s >= self._parameters.rotation_s

    def push(self) -> None:
        """Hand everything to the operating system; a kill of this process cannot take it any more."""
        for journal in self._journals.values():
            journal.push()

    def pending(self) -> "PendingSync":
        """What has been pushed and would be durable after a sync."""
        journals = [journal for journal in self._journals.values() if journal.unsynced]
        return PendingSync(journals, durable_of(self._ledger))

    def settle(self, done: "PendingSync") -> None:
        """A sync has run without an error."""
        self.durable = done.reached

    def flush(self) -> None:
        """Push and sync: everything written so far is on the disk."""
        self.push()
        pending = self.pending()
        pending.run()
        self.settle(pending)

    def close(self) -> list[Path]:
        """Close the open files, to be sealed; what was not flushed is not in them. Further messages begin new ones."""
        parts = [journal.path for journal in self._journals.values()]
        for journal in self._journals.values():
            journal.close()
        self._number += bool(parts)
        self._journals.clear()
        return parts

    def _journal(self, record: Record) -> Journal:
        kind = record.stream.signal.archived
        if kind is None:
            raise ValueError(f"{record.stream.name} is not a signal that is archived")
        if not self._journals:
            self._begun_s = self._monotonic_s()
        if kind not in self._journals:
            version = self._version if kind == "derived" else None
            path = self.folder / SegmentName(kind, version, self._number, part=True).file_name
            self._journals[kind] = Journal(
                self._disk, path, self.description, f"ambula {self._version}", self._parameters.chunk_bytes
            )
        return self._journals[kind]

    def _refuse(self, stream: str) -> None:
        """A message that no MCAP file can hold; the next one of its stream shows the gap."""
        key = (stream, Reason.OUT_OF_RANGE)
        self.counts.refused[key] = self.counts.refused.get(key, 0) + 1

    def _gap(self, journal: Journal, record: Record, first: int) -> None:
        envelope = record.envelope
        gap = Gap(
            stream=record.stream.name,
            epoch=envelope.epoch,
            first_sequence=first,
            last_sequence=envelope.sequence - 1,
        )
        journal.add_own(GAP, Envelope(0, self._gaps, envelope.captured_ns), gap, record.received_unix_ns)
        self._gaps += 1
        self.counts.lost += envelope.sequence - first
        self._ledger.advance(gap.stream, gap.epoch, first, gap.last_sequence)


def durable_of(ledger: Ledger) -> Durable:
    """What is safe when all that the ledger holds is."""
    positions = ledger.positions()
    return Durable(
        positions={name: place.sequence for name, place in positions.items()},
        captured_ns=ledger.captured_ns(),
        ended=frozenset(name for name, place in positions.items() if place.ended),
    )
