"""Samples as arrays, and how they become messages: one per hub and tick or per frame of a camera, as captured."""

import heapq
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ImuBatch, ReferenceBatch
from services.flow.message import Stream
from services.flow.raw_streams import REFERENCE_STREAM
from services.ingest.driver import SourceMessage
from services.ingest.skeleton import RoomFrames, skeleton_batch

Times = NDArray[np.int64]
Values = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ImuTrack:
    """One sensor: captured_ns n (increasing), angular_velocity n x 3 rad/s, specific_force n x 3 m/s^2, all finite."""

    captured_ns: Times
    angular_velocity: Values
    specific_force: Values


@dataclass(frozen=True, slots=True)
class SkeletonTrack:
    """One camera: captured_ns n (increasing), whom it followed and how many it saw, n each, and the n frames."""

    captured_ns: Times
    body: list[int | None]
    people: list[int]
    frames: RoomFrames


@dataclass(frozen=True, slots=True)
class ReferenceTrack:
    """Truth: captured_ns n (increasing), values n x channels in SI, NaN where unknown."""

    captured_ns: Times
    values: Values


def hub_messages(stream: Stream, tracks: Sequence[ImuTrack], tick_ns: int) -> Iterator[SourceMessage]:
    """Samples of a hub's sensors, tick by tick; a tick in which nobody delivered has no message.

    A sample belongs to the tick whose nominal instant is nearest, so jitter below half a tick moves nothing.
    """
    present, cuts = _cut([track.captured_ns for track in tracks], tick_ns)
    columns = [
        (track.captured_ns.tolist(), track.angular_velocity.tolist(), track.specific_force.tolist()) for track in tracks
    ]
    for k in range(present):
        # Validating one nested dict takes half the time of constructing the models one by one.
        batch = ImuBatch.model_validate(
            {
                "sensors": [
                    {
                        "captured_ns": times[cut[k] : cut[k + 1]],
                        "angular_velocity": rates[cut[k] : cut[k + 1]],
                        "specific_force": forces[cut[k] : cut[k + 1]],
                    }
                    for (times, rates, forces), cut in zip(columns, cuts, strict=True)
                ],
                "marks": [],
            }
        )
        newest = max(samples.captured_ns[-1] for samples in batch.sensors if samples.captured_ns)
        yield SourceMessage(stream, newest, batch)


def skeleton_messages(stream: Stream, track: SkeletonTrack) -> Iterator[SourceMessage]:
    """Frames of a camera, one by one."""
    frames = track.frames
    for k, captured_ns in enumerate(track.captured_ns.tolist()):
        one = frames._replace(position=frames.position[k : k + 1], state=frames.state[k : k + 1])
        batch = skeleton_batch([captured_ns], track.body[k : k + 1], track.people[k : k + 1], one)
        yield SourceMessage(stream, captured_ns, batch)


def reference_messages(track: ReferenceTrack, tick_ns: int) -> Iterator[SourceMessage]:
    """Truth in messages of one tick."""
    present, (cut,) = _cut([track.captured_ns], tick_ns)
    times = track.captured_ns.tolist()
    rows = [[None if value != value else value for value in row] for row in track.values.tolist()]
    for k in range(present):
        span = slice(cut[k], cut[k + 1])
        batch = ReferenceBatch(captured_ns=times[span], values=rows[span])
        yield SourceMessage(REFERENCE_STREAM, times[span][-1], batch)


def in_order(streams: Iterable[Iterator[SourceMessage]]) -> Iterator[SourceMessage]:
    """Interleave streams by time of capture; on a tie in the order given."""
    return heapq.merge(*streams, key=attrgetter("captured_ns"))


def _cut(times: Sequence[Times], tick_ns: int) -> tuple[int, list[list[int]]]:
    """How many ticks hold anything, and per sensor the index of its first sample of each such tick, plus the end."""
    ticks = [(captured_ns + tick_ns // 2) // tick_ns for captured_ns in times]
    present = np.unique(np.concatenate(ticks))
    return len(present), [[*np.searchsorted(tick, present).tolist(), len(tick)] for tick in ticks]
