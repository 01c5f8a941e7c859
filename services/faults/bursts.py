"""Packets are lost in bursts: when a radio fails it fails for several packets in a row.

The two-state channel of Gilbert (1960, Bell System Technical Journal 39, 1253) and Elliott (1963, ibid. 42, 1977):
in the good state nothing is lost, in the bad state everything. Figures are those of 330 files of worn sensors at 100 Hz
(CyrilVoisard/ipol_dataset_1): runs of 1 in 64 %, 2 in 22 %, 3 in 8 %, and a few of up to 64.
"""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True, slots=True)
class BurstModel:
    """How long a channel stays good and bad, in packets."""

    start: float = (
        0.0055  # probability per packet of the good state that a run of losses starts; clinics 0.0055 to 0.08
    )
    mean_length: float = 1.6  # packets of an ordinary run, geometric
    long_share: float = 0.01  # of the runs
    shortest_long: int = 10  # packets of a long run, uniform from here
    longest_long: int = 64  # to here

    @property
    def mean_run(self) -> float:
        """Packets lost in a row, mean over ordinary and long runs."""
        long = 0.5 * (self.shortest_long + self.longest_long)
        return (1.0 - self.long_share) * self.mean_length + self.long_share * long

    @property
    def share(self) -> float:
        """Of the packets that are lost in the long run."""
        return self.mean_run / (self.mean_run + 1.0 / self.start) if self.start else 0.0

    def losing(self, share: float) -> "BurstModel":
        """The same runs, as often as loses this share (0 to below 1) of the packets. Raises ValueError beyond."""
        if not 0.0 <= share < 1.0:
            raise ValueError(f"a channel loses a share of 0 or more and below 1 of its packets, not {share}")
        return replace(self, start=min(share / (1.0 - share) / self.mean_run, 1.0))


class BurstChannel:
    """One channel over time: asked packet by packet, seeded."""

    def __init__(self, model: BurstModel, seed: int) -> None:
        self._model = model
        self._random = np.random.default_rng(seed)
        self._left = 0

    def loses(self) -> bool:
        """Whether the next packet is lost."""
        if self._left == 0 and self._random.random() < self._model.start:
            self._left = self._run() + 1
        # A run is followed by at least one packet: two runs in a row would be a longer one.
        self._left = max(self._left - 1, 0)
        return self._left > 0

    def _run(self) -> int:
        model = self._model
        if self._random.random() < model.long_share:
            return int(self._random.integers(model.shortest_long, model.longest_long + 1))
        return int(self._random.geometric(1.0 / model.mean_length))
