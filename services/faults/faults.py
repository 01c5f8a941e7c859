"""What goes wrong with sensors and radios, one small class each.

Times are seconds of session time, ends excluded. Sensor faults change the samples; transport faults change which
messages arrive, when and how often, and leave the messages themselves alone.
"""

from dataclasses import dataclass


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


SampleFault = SensorOff | SensorStuck | Spike | HubGap | ClockStep
TransportFault = Duplicated | Reordered
