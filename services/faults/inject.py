"""Puts faults into a stream of imu messages. Pure and seeded: the same input gives the same damage."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from schemas.imu import ImuBatch, SensorSamples
from schemas.signals import IMU
from services.faults.changes import Change, SensorSample, change
from services.faults.faults import LossFault, SampleFault
from services.faults.losses import Loss, loss
from services.flow.message import Message

Rows = list[list[SensorSample]]
"""Samples of each sensor."""


def inject(messages: Iterable[Message], sensors: Sequence[str], faults: Sequence[SampleFault]) -> Iterator[Message]:
    """Damage the samples of one hub's imu stream; `Injection` also tells what was lost."""
    return Injection(sensors, faults).apply(messages)


class Injection:
    """Faults at work on one hub's imu stream, one after another in the order given, and what they took away.

    `sensors` are the hub's sensors in the order of the session description. Every sample is judged by its own time,
    so it makes no difference how samples are batched into messages.
    """

    def __init__(self, sensors: Sequence[str], faults: Sequence[SampleFault]) -> None:
        self.sensors = list(sensors)
        self.sent = dict.fromkeys(self.sensors, 0)
        """Samples that each sensor had."""
        self.lost: dict[str, set[int]] = {sensor: set() for sensor in self.sensors}
        """Times of the samples of each sensor that were taken away, ns. All others were delivered."""
        self._losses_and_changes = [
            (loss(fault), None) if isinstance(fault, LossFault) else (None, change(fault)) for fault in faults
        ]

    def apply(self, messages: Iterable[Message]) -> Iterator[Message]:
        """The damaged stream. Messages of other signals pass unchanged.

        A message without a sample left is not sent, and the numbering goes on without a hole, as when the radio
        was silent before anything was sent.
        """
        swallowed = 0
        for message in messages:
            payload = message.payload
            if message.stream.signal is not IMU:
                yield message
                continue
            if isinstance(payload, ImuBatch):
                payload = self._damage(payload)
                if not any(samples.captured_ns for samples in payload.sensors):
                    swallowed += 1
                    continue
            envelope = replace(message.envelope, sequence=message.envelope.sequence - swallowed)
            yield Message(message.stream, envelope, payload)

    def _damage(self, batch: ImuBatch) -> ImuBatch:
        rows = [_rows(samples) for samples in batch.sensors]
        for sensor, samples in zip(self.sensors, rows, strict=True):
            self.sent[sensor] += len(samples)
        for takes, changes in self._losses_and_changes:
            if takes is not None:
                rows = self._take(rows, takes)
            if changes is not None:
                rows = self._change(rows, changes)
        return ImuBatch(sensors=[_samples(samples) for samples in rows], marks=batch.marks)

    def _take(self, rows: Rows, takes: Loss) -> Rows:
        left: Rows = [[] for _ in rows]
        in_time = sorted((sample.captured_ns, s, i) for s, row in enumerate(rows) for i, sample in enumerate(row))
        for captured_ns, s, i in in_time:
            if takes(self.sensors[s], captured_ns):
                self.lost[self.sensors[s]].add(captured_ns)
            else:
                left[s].append(rows[s][i])
        return left

    def _change(self, rows: Rows, changes: Change) -> Rows:
        return [
            [changes(sensor, sample) for sample in samples] for sensor, samples in zip(self.sensors, rows, strict=True)
        ]


def _rows(samples: SensorSamples) -> list[SensorSample]:
    columns = (samples.captured_ns, samples.angular_velocity, samples.specific_force)
    return [SensorSample(*parts) for parts in zip(*columns, strict=True)]


def _samples(rows: list[SensorSample]) -> SensorSamples:
    return SensorSamples(
        captured_ns=[row.captured_ns for row in rows],
        angular_velocity=[row.angular_velocity for row in rows],
        specific_force=[row.specific_force for row in rows],
    )
