"""The samples of lone segments, checked and at hand by time."""

import math
from typing import NamedTuple

from schemas.kinematics import SegmentMotion, SegmentSamples
from schemas.vocabulary import Segment
from services.flow.node import State

Vector = list[float]
MOST_ACCELERATION, MOST_RATE = 1e3, 200.0
"""m/s^2 and rad/s; beyond them a value is no movement of a body."""


class Motion(NamedTuple):
    """One segment at one time, in its heading frame (x forward, y up, z right)."""

    acceleration: Vector  # m/s^2, without gravity
    angular_velocity: Vector  # rad/s


class LoneMotion:
    """Keeps the samples of the batch at hand, and when each segment was heard last."""

    def __init__(self) -> None:
        self._rows: dict[Segment, dict[int, Motion]] = {}
        self._heard_ns: dict[Segment, int] = {}

    def take(self, motion: SegmentMotion | None) -> int:
        """The batch that belongs to the joint states at hand. Returns how many of its samples can not be used."""
        self._rows = {}
        refused = 0
        for samples in motion.segments if motion is not None else ():
            rows = _rows(samples)
            self._rows[samples.segment] = {ns: row for ns, row in rows.items() if _is_plausible(row)}
            refused += len(samples.captured_ns) - len(self._rows[samples.segment])
        return refused

    def at(self, segment: Segment, captured_ns: int) -> Motion | None:
        """The sample of a segment at one of the batch's times; None when it has none."""
        found = self._rows.get(segment, {}).get(captured_ns)
        if found is not None:
            self._heard_ns[segment] = captured_ns
        return found

    def is_heard(self, segment: Segment, captured_ns: int, silence_s: float) -> bool:
        """Whether the segment has had a sample within a time."""
        heard_ns = self._heard_ns.get(segment)
        return heard_ns is not None and captured_ns - heard_ns <= silence_s * 1e9

    def snapshot(self) -> State:
        """When each segment was heard last; between messages no batch is at hand."""
        return {"heard_ns": {segment.value: ns for segment, ns in sorted(self._heard_ns.items())}}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._heard_ns = {Segment(name): ns for name, ns in state["heard_ns"].items()}


def _rows(samples: SegmentSamples) -> dict[int, Motion]:
    """The samples by time; none when the columns have different lengths."""
    if not len(samples.captured_ns) == len(samples.acceleration) == len(samples.angular_velocity):
        return {}
    columns = zip(samples.captured_ns, samples.acceleration, samples.angular_velocity, strict=True)
    return {ns: Motion(acceleration, rate) for ns, acceleration, rate in columns}


def _is_plausible(row: Motion) -> bool:
    return math.hypot(*row.acceleration) < MOST_ACCELERATION and math.hypot(*row.angular_velocity) < MOST_RATE
