"""What goes wrong with sensors and radios, one small class each.

Times are seconds of session time, ends excluded. Losses take samples away, value faults change them; transport faults
change when and how often messages arrive, and leave the messages themselves alone.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from services.faults.bursts import BurstModel


@dataclass(frozen=True, slots=True)
class SensorOff:
    """A sensor delivers nothing: battery, strap, radio."""

    sensor: str
    from_s: float
    to_s: float


@dataclass(frozen=True, slots=True)
class SensorStuck:
    """A sensor repeats its last sample with fresh times."""

    sensor: str
    from_s: float
    to_s: float


@dataclass(frozen=True, slots=True)
class Spike:
    """One sample is far out."""

    sensor: str
    at_s: float
    angular_velocity: float
    """rad/s added to each axis"""
    specific_force: float
    """m/s^2 added to each axis"""


@dataclass(frozen=True, slots=True)
class HubGap:
    """The receiver delivers nothing at all and its numbering goes on without a hole."""

    from_s: float
    to_s: float


@dataclass(frozen=True, slots=True)
class SensorLoss:
    """A sensor's radio loses samples in bursts."""

    sensor: str
    model: BurstModel
    seed: int


@dataclass(frozen=True, slots=True)
class HubLoss:
    """The receiver misses ticks in bursts: what all its sensors said at one instant is lost together."""

    model: BurstModel
    seed: int


@dataclass(frozen=True, slots=True)
class ClockStep:
    """A sensor's clock jumps at one instant and stays off."""

    sensor: str
    at_s: float
    by_s: float


@dataclass(frozen=True, slots=True)
class Duplicated:
    """Each message comes a second time, a little later, with this probability."""

    share: float


@dataclass(frozen=True, slots=True)
class Reordered:
    """Messages change places within a window of this many."""

    window: int


LossFault = SensorOff | HubGap | SensorLoss | HubLoss
ValueFault = SensorStuck | Spike | ClockStep
SampleFault = LossFault | ValueFault
TransportFault = Duplicated | Reordered


def radio_loss(sensors: Sequence[str], share: float, seed: int) -> list[SampleFault]:
    """Each sensor loses `share` of its samples, half of the runs on a channel that all share.

    Two independent channels of share a lose 1 - (1 - a)^2 together. Losses are shared on the radio: in the recordings
    both feet miss the same packet 5 times more often than by chance.
    """
    channel = BurstModel().losing(1.0 - math.sqrt(1.0 - share))
    own = [SensorLoss(sensor, channel, _seed_of(seed, place)) for place, sensor in enumerate(sensors, start=1)]
    return [HubLoss(channel, _seed_of(seed, 0)), *own]


def _seed_of(seed: int, channel: int) -> int:
    """Seeds of neighbouring channels and of neighbouring runs differ."""
    return seed * 1009 + channel
