"""How far a repetition has come, frame by frame."""

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Progress(NamedTuple):
    """One repetition of n frames, as shares of it that are done, (n,) each."""

    whole: Array
    first: Array  # of its first half
    second: Array  # of its second half

    @classmethod
    def plain(cls, frames: int) -> Self:
        """Without a stop on the way."""
        half = frames // 2
        way = np.linspace(0.0, 1.0, half)
        rest = np.ones(frames - 2 * half)
        first = np.concatenate([way, np.ones(half), rest])
        return cls(np.linspace(0.0, 1.0, frames), first, np.concatenate([np.zeros(half), way, rest]))

    def held(self, frames: int, *, twice: bool) -> Self:
        """Stopping for so many frames in the middle, or in the middle of both halves."""
        n = len(self.whole)
        half = n // 2
        places = np.repeat([half // 2, half + half // 2] if twice else [half], frames)
        stopped = [np.insert(share, places, share[places]) for share in self]
        return type(self)(*stopped)

    def without_beginning(self, share: float) -> Self:
        """What is left of it when so much is done."""
        left = self.whole >= share
        return type(self)(*(each[left] for each in self))


def bump(share: Array, power: float) -> Array:
    """0, 1 half-way, 0: sin(pi u)^power."""
    return np.asarray(np.maximum(np.sin(np.pi * share), 0.0) ** power)
