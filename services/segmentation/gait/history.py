"""The last seconds of joint coordinates: what a stride is cut from."""

from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from schemas.gait import CURVE_POINTS
from services.flow.node import State, pack_array, unpack_array
from services.segmentation.batch import INDEX, Batch

Array = NDArray[np.float64]
HEADING = INDEX["pelvis_rotation"]


@dataclass(frozen=True, slots=True)
class Instant:
    """The body at one time."""

    position: Array  # (d,) rad
    position_std: Array  # (d,) rad
    valid: NDArray[np.bool_]  # (d,)
    phase: float | None  # rad


@dataclass
class Span:
    """The samples from one time to another, both ends interpolated."""

    start_ns: int
    end_ns: int
    captured_ns: NDArray[np.int64] = field(repr=False)
    position: Array = field(repr=False)  # (n, d) rad, heading unwrapped
    phase: Array = field(repr=False)
    position_std: Array = field(repr=False)  # (d,) rad, mean
    valid: NDArray[np.bool_] = field(repr=False)  # (d,) valid all the time

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
    """Samples in order of time. How many came in one message leaves no trace."""

    def __init__(self) -> None:
        self._captured_ns: list[int] = []
        self._phase: list[float] = []
        self._position: list[Array] = []  # (d,) rad each, d as in a batch
        self._position_std: list[Array] = []  # (d,) rad each
        self._valid: list[NDArray[np.bool_]] = []  # (d,) each

    def append(self, batch: Batch, row: int) -> None:
        """Add the newest sample: one row of a batch."""
        self._captured_ns.append(int(batch.captured_ns[row]))
        self._phase.append(float(batch.phase[row]))
        self._position.append(batch.position[row])
        self._position_std.append(batch.position_std[row])
        self._valid.append(batch.valid)

    def forget_before(self, captured_ns: int) -> None:
        """Drop the samples before a time, except the last of them."""
        old = max(bisect_left(self._captured_ns, captured_ns) - 1, 0)
        for column in self._columns():
            del column[:old]

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
        first = bisect_right(self._captured_ns, start_ns) - 1
        last = bisect_left(self._captured_ns, end_ns) + 1
        if first < 0 or last > len(self._captured_ns):
            return None
        position = np.array(self._position[first:last])
        position[:, HEADING] = np.unwrap(position[:, HEADING])
        return Span(
            start_ns,
            end_ns,
            np.array(self._captured_ns[first:last], dtype=np.int64),
            position,
            np.array(self._phase[first:last]),
            np.mean(self._position_std[first:last], axis=0),
            np.all(self._valid[first:last], axis=0),
        )

    def _columns(self) -> tuple[list[Any], ...]:
        return self._captured_ns, self._phase, self._position, self._position_std, self._valid

    def snapshot(self) -> State:
        """All samples, column by column."""
        return {
            "captured_ns": list(self._captured_ns),
            "phase": pack_array(np.array(self._phase)),
            "position": pack_array(np.array(self._position)),
            "position_std": pack_array(np.array(self._position_std)),
            "valid": ["".join("1" if value else "0" for value in valid) for valid in self._valid],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._captured_ns = list(state["captured_ns"])
        self._phase = unpack_array(state["phase"]).tolist()
        self._position = list(unpack_array(state["position"]))
        self._position_std = list(unpack_array(state["position_std"]))
        self._valid = [np.array([digit == "1" for digit in digits]) for digits in state["valid"]]
