"""When a checkpoint may be put away: once those who read the outputs have what was sent before it.

A node that resumes has an empty replay ring. What a slow reader still lacks from before the checkpoint could then
not be sent again; from an older checkpoint the node computes it again, to the bit, under the same numbers.
"""

from collections import deque
from collections.abc import Mapping

from schemas.checkpoint import Checkpoint
from services.flow.message import Stream

LONGEST_WAIT_S = 10.0
"""A reader that is silent for longer has gone; the replay pacing lets nobody be further behind."""
ARCHIVE = "archive"
"""Reads every archived stream. Of others, only the streams they have reported on are known to be read."""


class HeldCheckpoints:
    """The checkpoints of one node that still wait, oldest first. Times are monotonic seconds given by the caller."""

    def __init__(self) -> None:
        self._held: deque[tuple[float, Checkpoint]] = deque()
        self._readers: dict[str, dict[str, int]] = {}

    @property
    def empty(self) -> bool:
        """Nothing waits."""
        return not self._held

    def add(self, now: float, checkpoint: Checkpoint) -> None:
        """Hold a checkpoint that was taken now."""
        self._held.append((now, checkpoint))

    def progress(self, reader: str, positions: Mapping[str, int]) -> bool:
        """A reader said how far it is; whether that is news."""
        before = self._readers.get(reader)
        self._readers[reader] = dict(positions)
        return self._readers[reader] != before

    def release(self, now: float) -> Checkpoint | None:
        """The newest checkpoint that may be put away; the older ones are forgotten."""
        newest = None
        while self._held and self._may_go(now, *self._held[0]):
            newest = self._held.popleft()[1]
        return newest

    def _has(self, reader: str, checkpoint: Checkpoint) -> bool:
        """The reader has everything that was sent before the checkpoint."""
        positions = self._readers[reader]
        return all(
            positions.get(name, -1) >= position.sequence
            for name, position in checkpoint.outputs.items()
            if name in positions or _is_archived(reader, name)
        )

    def _may_go(self, now: float, taken_at: float, checkpoint: Checkpoint) -> bool:
        waited = now - taken_at >= LONGEST_WAIT_S
        return waited or all(self._has(reader, checkpoint) for reader in self._readers)


def _is_archived(reader: str, stream: str) -> bool:
    return reader == ARCHIVE and Stream.parse(stream).signal.archived is not None
