"""The last seconds of joint coordinates: what a stride is cut from."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.gait import CURVE_POINTS
from services.flow.node import State, pack_array, unpack_array
from services.segmentation.leg_kinematics import INDEX

Array = NDArray[np.float64]
HEADING = INDEX["pelvis_rotation"]
DOFS = len(INDEX)


@dataclass(frozen=True, slots=True)
class Batch:
    """Samples of one message. `phase` is NaN while the rhythm is not locked, and never leaves this module."""

    captured_ns: NDArray[np.int64]  # (n,)
    position: Array  # (n, 15) rad
    phase: Array  # (n,) rad
    position_std: Array  # (15,) rad, mean over the batch
    valid: NDArray[np.bool_]  # (15,)


@dataclass(frozen=True, slots=True)
class Instant:
    """The body at one time."""

    position: Array  # (15,) rad
    position_std: Array  # (15,) rad
    valid: NDArray[np.bool_]  # (15,)
    phase: float | None  # rad


@dataclass
class Span:
    """The samples from one time to another, both ends interpolated."""

    start_ns: int
    end_ns: int
    captured_ns: NDArray[np.int64] = field(repr=False)
    position: Array = field(repr=False)  # (n, 15) rad, heading unwrapped
    phase: Array = field(repr=False)
    position_std: Array = field(repr=False)  # (15,) rad, mean
    valid: NDArray[np.bool_] = field(repr=False)  # (15,) valid all the time

    def curve(self, dof: int) -> Array:
        """(101,) rad at 0, 1, ... 100 % of the span."""
        at = np.linspace(self.start_ns, self.end_ns, CURVE_POINTS)
        return np.interp(at, self.captured_ns, self.position[:, dof])

    def phase_advance(self) -> float | None:
        """rad of rhythm phase over the span; None when the rhythm was not locked all the time."""
        if np.isnan(self.phase).any():
            return None
        ends = np.interp([self.start_ns, self.end_ns], self.captured_ns, self.phase)
        return float(ends[1] - ends[0])

    def mean_heading(self) -> float:
        """rad, mean pelvis rotation."""
        return float(self.curve(HEADING).mean())


class History:
    """Batches in order of time."""

    def __init__(self) -> None:
        self._batches: list[Batch] = []

    def append(self, batch: Batch) -> None:
        """Add the newest batch."""
        self._batches.append(batch)

    def forget_before(self, captured_ns: int) -> None:
        """Drop the batches that end before a time, except the last of them."""
        while len(self._batches) > 1 and self._batches[1].captured_ns[0] < captured_ns:
            self._batches.pop(0)

    def at(self, captured_ns: int) -> Instant | None:
        """The body at a time within the history."""
        span = self.between(captured_ns, captured_ns)
        if span is None:
            return None
        position = np.array([np.interp(captured_ns, span.captured_ns, column) for column in span.position.T])
        phase = float(np.interp(captured_ns, span.captured_ns, span.phase))
        return Instant(position, span.position_std, span.valid, None if np.isnan(phase) else phase)

    def between(self, start_ns: int, end_ns: int) -> Span | None:
        """Samples of a span with one more at each end; None when the history does not reach that far."""
        begin = sum(batch.captured_ns[0] <= start_ns for batch in self._batches) - 1
        stop = sum(batch.captured_ns[-1] < end_ns for batch in self._batches) + 1
        if begin < 0 or stop > len(self._batches):
            return None
        kept = self._batches[begin:stop]
        captured_ns = np.concatenate([batch.captured_ns for batch in kept])
        # One sample outside the span at either end, so that its ends can be interpolated.
        first = int(np.searchsorted(captured_ns, start_ns, side="right")) - 1
        last = int(np.searchsorted(captured_ns, end_ns, side="left")) + 1
        position = np.concatenate([batch.position for batch in kept])[first:last]
        position[:, HEADING] = np.unwrap(position[:, HEADING])
        return Span(
            start_ns,
            end_ns,
            captured_ns[first:last],
            position,
            np.concatenate([batch.phase for batch in kept])[first:last],
            np.mean([batch.position_std for batch in kept], axis=0),
            np.all([batch.valid for batch in kept], axis=0),
        )

    def snapshot(self) -> State:
        """All batches, their arrays joined."""
        batches = self._batches
        return {
            "lengths": [len(batch.captured_ns) for batch in batches],
            "captured_ns": [int(ns) for batch in batches for ns in batch.captured_ns],
            "position": pack_array(np.array([row for batch in batches for row in batch.position]).reshape(-1, DOFS)),
            "phase": pack_array(np.array([value for batch in batches for value in batch.phase])),
            "position_std": pack_array(np.array([batch.position_std for batch in batches]).reshape(-1, DOFS)),
            "valid": ["".join("1" if value else "0" for value in batch.valid) for batch in batches],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        if not state["lengths"]:
            self._batches = []
            return
        cuts = np.cumsum(state["lengths"])[:-1]
        columns = (
            np.split(np.array(state["captured_ns"], dtype=np.int64), cuts),
            np.split(unpack_array(state["position"]), cuts),
            np.split(unpack_array(state["phase"]), cuts),
            unpack_array(state["position_std"]),
            np.array([[digit == "1" for digit in digits] for digits in state["valid"]]),
        )
        self._batches = [Batch(*row) for row in zip(*columns, strict=True)]
