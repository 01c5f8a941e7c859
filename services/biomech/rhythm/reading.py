"""What every rhythm estimator says after each sample."""

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from services.flow.node import State


class RhythmReading(NamedTuple):
    """The rhythm at one sample.

    `jerk` is for the prediction of the sample that follows: d3q/dt3 of each channel's joint, 0 where the model does
    not deserve trust.
    """

    phase: float
    """rad, unwrapped: one stride is 2 pi. Stands still while there is no lock and keeps its reference over stops."""
    frequency: float
    """rad/s of the stride. Without lock: the candidate under examination, or 0."""
    quality: float
    """Explained share of the joint velocities, 0 to 1; 0 without lock."""
    locked: bool
    jerk: NDArray[np.float64]
    """rad/s^3, shape (channels,)."""


class RhythmEstimator(Protocol):
    """Joint velocities of one person in, the rhythm out; causal, one sample at a time.

    All channels share one phase and have a waveform each. A split stream with `snapshot` and `restore` in between
    gives the same bits as an unsplit one.
    """

    @property
    def channels(self) -> int:
        """How many joint velocities each sample has."""

    def step(self, velocity: NDArray[np.float64], dt_s: float) -> RhythmReading:
        """Take one sample.

        Args:
            velocity: rad/s, shape (channels,).
            dt_s: s since the sample before.
        """

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""

    def restore(self, state: State) -> None:
        """Go on from a snapshot of an estimator with the same channels and parameters."""
