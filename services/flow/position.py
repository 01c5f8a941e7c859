"""How far a stream was dealt with, as plain numbers: it changes with every message."""

from typing import NamedTuple

from schemas.checkpoint import StreamPosition


class Position(NamedTuple):
    """The last message of a stream that has been dealt with; as `StreamPosition` it is written and sent."""

    epoch: int
    sequence: int
    ended: bool

    @classmethod
    def of(cls, written: StreamPosition) -> "Position":
        """Inverse of `written`."""
        return cls(written.epoch, written.sequence, written.ended)

    def written(self) -> StreamPosition:
        """As in checkpoints."""
        return StreamPosition(epoch=self.epoch, sequence=self.sequence, ended=self.ended)
