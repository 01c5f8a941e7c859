"""Running least-squares line."""

import math
from dataclasses import asdict, dataclass

from services.flow.node import State


@dataclass
class Trend:
    """y over x, updated one pair at a time, after the manner of Welford 1962.

    With dx = x - mean_x before the update: sxx += dx (x - mean_x), sxy += dx (y - mean_y), syy += dy (y - mean_y),
    the means on the right after it.
    """

    count: int = 0
    mean_x: float = 0.0
    mean_y: float = 0.0
    sxx: float = 0.0
    sxy: float = 0.0
    syy: float = 0.0

    def add(self, x: float, y: float) -> None:
        """Take one pair."""
        self.count += 1
        dx, dy = x - self.mean_x, y - self.mean_y
        self.mean_x += dx / self.count
        self.mean_y += dy / self.count
        self.sxx += dx * (x - self.mean_x)
        self.sxy += dx * (y - self.mean_y)
        self.syy += dy * (y - self.mean_y)

    def slope(self) -> tuple[float, float] | None:
        """Slope and its standard error sqrt(SSE / (n - 2) / sxx); None below three pairs or at a single x."""
        if self.count < 3 or self.sxx == 0.0:
            return None
        slope = self.sxy / self.sxx
        unexplained = max(0.0, self.syy - slope * self.sxy)
        return slope, math.sqrt(unexplained / (self.count - 2) / self.sxx)

    def snapshot(self) -> State:
        """All sums."""
        return asdict(self)

    @classmethod
    def restored(cls, state: State) -> "Trend":
        """Inverse of `snapshot`."""
        return cls(**state)
