"""Puts faults into a stream of imu messages. Pure and seeded: the same input gives the same damage."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from schemas.imu import ImuBatch, SensorSamples
from services.faults.faults import (
    ClockStep,
    Duplicated,
    HubGap,
    Reordered,
    SampleFault,
    SensorOff,
    SensorStuck,
    Spike,
    TransportFault,
)
from services.flow.message import Message

NOTHING = SensorSamples(captured_ns=[], angular_velocity=[], specific_force=[])


def inject(messages: Iterable[Message], sensors: Sequence[str], faults: Sequence[SampleFault]) -> Iterator[Message]:
    """Damage the samples of one hub's imu stream.

    `sensors` are the hub's sensors in the order of the session description. Messages without samples of interest,
    of other signals, and the end of the stream pass unchanged; a message swallowed by a HubGap leaves no hole in
    the numbering, as when the radio was silent before anything was sent.
    """
    held: dict[str, SensorSamples] = {}
    swallowed = 0
    for message in messages:
        batch = message.payload
        sequence = message.envelope.sequence - swallowed
        if not isinstance(batch, ImuBatch):
            yield replace(message, envelope=replace(message.envelope, sequence=sequence)) if swallowed else message
            continue
        time_s = message.envelope.captured_ns * 1e-9
        if any(isinstance(fault, HubGap) and fault.from_s <= time_s < fault.to_s for fault in faults):
            swallowed += 1
            continue
        damaged = [
            _damage(samples, sensor, time_s, faults, held)
            for sensor, samples in zip(sensors, batch.sensors, strict=True)
        ]
        envelope = replace(message.envelope, sequence=sequence)
        yield Message(message.stream, envelope, ImuBatch(sensors=damaged))


def _damage(
    samples: SensorSamples, sensor: str, time_s: float, faults: Sequence[SampleFault], held: dict[str, SensorSamples]
) -> SensorSamples:
    for fault in faults:
        match fault:
            case SensorOff(name, from_s, to_s) if name == sensor and from_s <= time_s < to_s:
                samples = NOTHING
            case SensorStuck(name, from_s, to_s) if name == sensor and from_s <= time_s < to_s and sensor in held:
                samples = held[sensor].model_copy(update={"captured_ns": samples.captured_ns})
            case Spike(name, at_s) if name == sensor and at_s <= time_s < at_s + 0.0099:
                samples = samples.model_copy(
                    update={
                        "angular_velocity": _raised(samples.angular_velocity, fault.angular_velocity),
                        "specific_force": _raised(samples.specific_force, fault.specific_force),
                    }
                )
            case ClockStep(name, at_s, by_s) if name == sensor and time_s >= at_s:
                moved = [captured_ns + int(by_s * 1e9) for captured_ns in samples.captured_ns]
                samples = samples.model_copy(update={"captured_ns": moved})
            case _:
                continue
    if samples.captured_ns:
        held[sensor] = samples
    return samples


def _raised(rows: list[list[float]], by: float) -> list[list[float]]:
    return [[value + by for value in row] for row in rows]


def disturb(messages: Sequence[Message], faults: Sequence[TransportFault], seed: int) -> list[Message]:
    """The order in which a bad network delivers messages; envelopes and payloads stay as they are."""
    random = np.random.default_rng(seed)
    delivered = list(messages)
    for fault in faults:
        match fault:
            case Duplicated(share):
                again = [
                    (place + int(random.integers(1, 20)), message)
                    for place, message in enumerate(delivered)
                    if random.random() < share
                ]
                placed = [*enumerate(delivered), *again]
                delivered = [message for _, message in sorted(placed, key=lambda pair: pair[0])]
            case Reordered(window):
                places = np.arange(len(delivered)) + random.uniform(0, window, len(delivered))
                delivered = [delivered[i] for i in np.argsort(places, kind="stable")]
    return delivered
