"""What lost samples cost in strides: how many are still found, and how long they are taken to be."""

from typing import NamedTuple

import numpy as np
from rich.progress import Progress

from schemas.gait import Stride
from schemas.imu import ReferenceBatch
from schemas.signals import IMU
from schemas.vocabulary import GaitEventKind, Side
from services.bench.gait.stride_scores import Truth
from services.bench.scoreboard import Row, informative
from services.cli.assembly import build_chain
from services.faults.faults import SampleFault, radio_loss
from services.faults.inject import Injection
from services.flow.message import Message
from services.ingest.source import iter_messages, open_source

WALKS = ("speed=1.1&seed=205&duration=40", "speed=0.9&seed=206&duration=40&rate=50")
SHARE, SEED = 0.2, 3
NEAR_S = 0.1
"""s within which the start of a stride is a true initial contact."""


class Strides(NamedTuple):
    """Strides of a session against the true contacts."""

    true: int
    found: int  # with a true contact at either end
    invented: int
    valid: int
    errors_ms: list[float]  # of the stride time, of those found

    @property
    def spread_ms(self) -> float:
        """RMS error of the stride time, ms."""
        return float(np.sqrt(np.mean(np.square(self.errors_ms)))) if self.errors_ms else float("nan")


def strides_of(query: str, share: float) -> Strides:
    """A synthetic walk through the whole chain."""
    source = open_source(f"synthetic:walk?{query}", session="loss", estimator="rhythmic_ekf")
    description = source.describe()
    messages = list(iter_messages(source))
    truth = Truth(description)
    for message in messages:
        if isinstance(message.payload, ReferenceBatch):
            truth.take(message.payload)
    sensors = [sensor.name for sensor in description.hubs[0].sensors]
    faults: list[SampleFault] = radio_loss(sensors, share, SEED) if share else []
    imu: list[Message] = [message for message in messages if message.stream.signal is IMU]
    chain = build_chain(description)
    strides = [
        produced.payload
        for message in Injection(sensors, faults).apply(imu)
        for produced in chain.push(message)
        if isinstance(produced.payload, Stride)
    ]
    return compare(strides, {side: truth.contact_edges_s(side, GaitEventKind.INITIAL_CONTACT) for side in Side})


def compare(strides: list[Stride], contacts_s: "dict[Side, np.ndarray[tuple[int], np.dtype[np.float64]]]") -> Strides:
    """Strides with a true contact near both ends, one stride apart, are found; all others are invented."""
    errors = []
    for stride in strides:
        true = contacts_s[stride.side]
        first, last = (int(np.abs(true - ns * 1e-9).argmin()) for ns in (stride.start_ns, stride.end_ns))
        near = all(abs(true[i] - ns * 1e-9) < NEAR_S for i, ns in ((first, stride.start_ns), (last, stride.end_ns)))
        if near and last == first + 1:
            errors.append((stride.stride_time_s - float(true[last] - true[first])) * 1e3)
    count = sum(len(true) - 1 for true in contacts_s.values())
    return Strides(count, len(errors), len(strides) - len(errors), sum(stride.valid for stride in strides), errors)


def stride_rows(progress: Progress) -> list[Row]:
    """With a fifth of the samples lost; the baseline is the undisturbed walk."""
    rows = []
    for query in progress.track(WALKS, description="strides"):
        clean, lossy = strides_of(query, 0.0), strides_of(query, SHARE)
        title = f"strides of {query.partition('&duration')[0]}, {SHARE:.0%} lost"
        rows += [
            informative(f"{title}: found of {lossy.true}", lossy.found, "", clean.found),
            informative(f"{title}: invented", lossy.invented, "", clean.invented),
            informative(f"{title}: valid", lossy.valid, "", clean.valid),
            informative(f"{title}: stride time, RMS error", lossy.spread_ms, "ms", clean.spread_ms),
        ]
    return rows
