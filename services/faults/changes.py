"""How each value fault changes a sample, one function per fault."""

from collections.abc import Callable
from functools import singledispatch
from typing import NamedTuple

from services.faults.faults import ClockStep, SensorStuck, Spike, ValueFault


class SensorSample(NamedTuple):
    """One sample of one sensor."""

    captured_ns: int
    angular_velocity: list[float]  # (3,) rad/s
    specific_force: list[float]  # (3,) m/s^2


Change = Callable[[str, SensorSample], SensorSample]
"""The sample of this sensor as it arrives."""


@singledispatch
def change(fault: ValueFault) -> Change:
    """A fresh change for one stream. Raises TypeError for what changes no sample."""
    raise TypeError(f"{fault!r} changes no samples")


@change.register
def _(fault: SensorStuck) -> Change:
    held: SensorSample | None = None

    def stick(sensor: str, sample: SensorSample) -> SensorSample:
        nonlocal held
        if sensor != fault.sensor:
            return sample
        if held is not None and fault.from_s <= sample.captured_ns * 1e-9 < fault.to_s:
            return held._replace(captured_ns=sample.captured_ns)
        held = sample
        return sample

    return stick


@change.register
def _(fault: Spike) -> Change:
    is_over = False

    def strike(sensor: str, sample: SensorSample) -> SensorSample:
        nonlocal is_over
        if is_over or sensor != fault.sensor or sample.captured_ns * 1e-9 < fault.at_s:
            return sample
        is_over = True
        return SensorSample(
            sample.captured_ns,
            [value + fault.angular_velocity for value in sample.angular_velocity],
            [value + fault.specific_force for value in sample.specific_force],
        )

    return strike


@change.register
def _(fault: ClockStep) -> Change:
    def step(sensor: str, sample: SensorSample) -> SensorSample:
        if sensor != fault.sensor or sample.captured_ns * 1e-9 < fault.at_s:
            return sample
        return sample._replace(captured_ns=sample.captured_ns + round(fault.by_s * 1e9))

    return step
