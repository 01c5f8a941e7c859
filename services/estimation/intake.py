"""From imu messages of one or several hubs to ticks in the order of captured time."""

from bisect import bisect_right
from dataclasses import dataclass
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from schemas.health import Reason
from schemas.imu import ImuBatch, SensorSamples
from schemas.session import SensorDescription, SessionDescription
from schemas.signals import IMU
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.event_sources import lone_segments, worn_segments
from services.estimation.parameters import EstimationParameters
from services.estimation.samples import Sample, TickBatch, gather
from services.estimation.sensor_checks import SensorChecks
from services.flow.message import Message, Stream
from services.flow.node import State, pack_array, unpack_array


class Used(NamedTuple):
    """Sensors in the order of the ticks, the body's first; and why the others, by name, are not used."""

    sensors: list[SensorDescription]
    body_sensors: int
    unused: dict[str, str]


def used_by_lower_body(description: SessionDescription) -> Used:
    """Sensors of the model, then those on feet and back that tell the events of a leg."""
    worn = [sensor for hub in description.hubs for sensor in hub.sensors]
    lone = lone_segments(worn_segments(description.hubs))
    of_the_model = [sensor for sensor in worn if sensor.segment in SEGMENTS]
    used = of_the_model + [s for s in worn if s.segment in lone and s.segment not in SEGMENTS]
    unused = {sensor.name: _why_unused(sensor.segment) for sensor in worn if sensor not in used}
    return Used(used, len(of_the_model), unused)


@dataclass(frozen=True)
class _Pending:
    """A message that waits for the other hubs."""

    until_ns: int
    hub: int
    captured_ns: int


class Intake:
    """Merges the hubs of a session.

    A message is passed on, with all samples up to its last one, when every hub has come that far, or when some hub is
    more than `lateness_s` of captured time further. Only captured times decide, never arrival. Samples that come
    after their time has been passed on are refused as late.
    """

    def __init__(self, description: SessionDescription, parameters: EstimationParameters, used: Used) -> None:
        self.streams = tuple(Stream(IMU, hub.name) for hub in description.hubs)
        self.sensors, self.body_sensors, self.unused = used
        self._places = [[self._place(sensor) for sensor in hub.sensors] for hub in description.hubs]
        self.checks = SensorChecks([sensor.name for sensor in self.sensors], parameters.checks)
        self._lateness_ns = round(parameters.lateness_s * 1e9)
        self._same_tick_ns = round(parameters.same_tick_s * 1e9)
        self._reached_ns: list[int] = [-1] * len(self.streams)
        self._passed_ns = -1
        self._waiting: list[_Pending] = []
        self._samples: list[Sample] = []

    def _place(self, sensor: SensorDescription) -> int | None:
        return self.sensors.index(sensor) if sensor in self.sensors else None

    def accept(self, message: Message) -> list[TickBatch]:
        """Take an imu message; the batches that are now complete, in order."""
        hub = self.streams.index(message.stream)
        batch, captured_ns = message.payload, message.envelope.captured_ns
        assert isinstance(batch, ImuBatch)
        if len(batch.sensors) != len(self._places[hub]):
            self.checks.refuse(message.stream.source, Reason.WRONG_SHAPE)
            return []
        until_ns = captured_ns
        for place, samples in zip(self._places[hub], batch.sensors, strict=True):
            if place is not None:
                until_ns = max(until_ns, self._keep_usable(place, samples, captured_ns))
        self._reached_ns[hub] = max(self._reached_ns[hub], until_ns)
        self._waiting.append(_Pending(until_ns, hub, captured_ns))
        return self._pass_on(everything=False)

    def finish(self) -> list[TickBatch]:
        """No more messages: what still waits."""
        return self._pass_on(everything=True)

    def _keep_usable(self, place: int, samples: SensorSamples, message_ns: int) -> int:
        """Keep what may be used; the time that the message reaches with it."""
        until_ns, passed_ns, accept = message_ns, self._passed_ns, self.checks.accept
        for captured_ns, rate, force in zip(
            samples.captured_ns, samples.angular_velocity, samples.specific_force, strict=True
        ):
            values = (*rate, *force)
            if captured_ns <= passed_ns and self._is_new(place, captured_ns):
                self.checks.refuse_sample(place, captured_ns, Reason.LATE)
            elif accept(place, captured_ns, values, message_ns):
                self._samples.append(Sample(captured_ns, place, values))
                if captured_ns > until_ns:
                    until_ns = captured_ns
        return until_ns

    def _is_new(self, place: int, captured_ns: int) -> bool:
        newest_ns = self.checks.records[place].newest_ns
        return newest_ns is None or captured_ns > newest_ns

    def _pass_on(self, *, everything: bool) -> list[TickBatch]:
        self._waiting.sort(key=lambda pending: (pending.until_ns, pending.hub, pending.captured_ns))
        batches = []
        while self._waiting:
            pending = self._waiting[0]
            all_there = min(self._reached_ns) >= pending.until_ns
            too_late = max(self._reached_ns) > pending.until_ns + self._lateness_ns
            if not (everything or all_there or too_late):
                break
            batches.append(self._complete(self._waiting.pop(0)))
        return batches

    def _complete(self, pending: _Pending) -> TickBatch:
        self._samples.sort(key=itemgetter(0, 1))
        count = bisect_right(self._samples, pending.until_ns, key=itemgetter(0))
        ready = self._samples[:count]
        del self._samples[:count]
        self._passed_ns = max(self._passed_ns, pending.until_ns)
        return TickBatch(pending.captured_ns, gather(ready, len(self.sensors), self._same_tick_ns))

    def snapshot(self) -> State:
        """What waits, how far the hubs are, and the checks."""
        return {
            "checks": self.checks.snapshot(),
            "reached_ns": list(self._reached_ns),
            "passed_ns": self._passed_ns,
            "waiting": [[pending.until_ns, pending.hub, pending.captured_ns] for pending in self._waiting],
            "samples_ns": [[sample.captured_ns, sample.sensor] for sample in self._samples],
            "samples": pack_array(np.array([sample.values for sample in self._samples]).reshape(-1, 6)),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.checks.restore(state["checks"])
        self._reached_ns = list(state["reached_ns"])
        self._passed_ns = state["passed_ns"]
        self._waiting = [_Pending(*pending) for pending in state["waiting"]]
        values = unpack_array(state["samples"]).tolist()
        self._samples = [
            Sample(time_ns, place, row) for (time_ns, place), row in zip(state["samples_ns"], values, strict=True)
        ]


def _why_unused(segment: Segment) -> str:
    if segment in (Segment.FOOT_LEFT, Segment.FOOT_RIGHT):
        return "the shank sensor of this leg tells its gait events"
    return f"the {segment.value} is not part of the body model"
