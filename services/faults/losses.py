"""What each loss takes away, one function per fault: a question asked for every sample, in the order of time."""

from collections.abc import Callable
from functools import singledispatch

from services.faults.bursts import BurstChannel
from services.faults.faults import HubGap, HubLoss, LossFault, SensorLoss, SensorOff

Loss = Callable[[str, int], bool]
"""Whether the sample of this sensor, captured at this time in ns, is lost. Sensors with one time come one by one."""


@singledispatch
def loss(fault: LossFault) -> Loss:
    """A fresh question for one stream. Raises TypeError for what is no loss."""
    raise TypeError(f"{fault!r} takes no samples away")


@loss.register
def _(fault: SensorOff) -> Loss:
    return lambda sensor, ns: sensor == fault.sensor and fault.from_s <= ns * 1e-9 < fault.to_s


@loss.register
def _(fault: HubGap) -> Loss:
    return lambda _, ns: fault.from_s <= ns * 1e-9 < fault.to_s


@loss.register
def _(fault: SensorLoss) -> Loss:
    channel = BurstChannel(fault.model, fault.seed)
    return lambda sensor, _: sensor == fault.sensor and channel.loses()


@loss.register
def _(fault: HubLoss) -> Loss:
    channel = BurstChannel(fault.model, fault.seed)
    asked_ns: int | None = None
    is_lost = False

    def loses(_: str, ns: int) -> bool:
        nonlocal asked_ns, is_lost
        if ns != asked_ns:
            asked_ns, is_lost = ns, channel.loses()
        return is_lost

    return loses
