"""Regularity of the trunk: autocorrelation of the lower back's vertical acceleration, where its sensor is alone.

Moe-Nilssen and Helbostad 2004: Ad(m) = mean of x(i) x(i + m) / mean of x(i)^2, unbiased, of a zero-mean acceleration x;
Ad1 at the lag of a step, Ad2 at that of a stride. Here the mean over windows in which the person walks.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import SegmentMotion
from schemas.metrics import Metric
from schemas.session import SessionDescription
from schemas.vocabulary import EventSource, Segment, Side, Task
from services.biomech.event_sources import session_event_sources, session_lone_segments
from services.definitions.trunk import TRUNK, TRUNK_STEP, TRUNK_STRIDE, TRUNK_SYMMETRY
from services.flow.node import State, pack_array, unpack_array
from services.metrics import summary
from services.metrics.parameters import TrunkParameters

Array = NDArray[np.float64]

NO_STRIDE_TIME = "the time of a stride is not known"
NO_WINDOW = "no whole window of walking"
NO_PEAK = "no regular stride"


def wears_back_alone(description: SessionDescription) -> bool:
    """The lower back tells the events of both legs, and the person walks."""
    sources = session_event_sources(description)
    by_back = all(sources[side] is EventSource.LOWER_BACK for side in Side)
    return description.task is not Task.MARCHING and by_back and Segment.PELVIS in session_lone_segments(description)


class TrunkRegularity:
    """Sums of autocorrelations, window by window; the size does not grow with the session."""

    def __init__(self, rate_hz: float, parameters: TrunkParameters) -> None:
        self._p = parameters
        self._rate_hz = rate_hz
        self._length = round(parameters.window_s * rate_hz)
        self._lags = round(parameters.longest_stride_s * rate_hz)
        self._last_ns: int | None = None
        self._window: list[float] = []
        self._sum: Array = np.zeros(self._lags + 1)
        self._windows = 0

    def take(self, motion: SegmentMotion) -> None:
        """Samples in order; a hole begins a new window."""
        for segment in motion.segments:
            if segment.segment is not Segment.PELVIS:
                continue
            for captured_ns, acceleration in zip(segment.captured_ns, segment.acceleration, strict=True):
                self._add(captured_ns, acceleration[1])

    def _add(self, captured_ns: int, upward: float) -> None:
        if self._last_ns is not None and captured_ns - self._last_ns > self._p.longest_hole_s * 1e9:
            self._window = []
        self._last_ns = captured_ns
        self._window.append(upward)
        if len(self._window) == self._length:
            self._close(np.array(self._window))
            self._window = []

    def _close(self, window: Array) -> None:
        window = window - window.mean()
        if window.std() < self._p.least_motion:
            return
        n = len(window)
        products = [float(window[: n - lag] @ window[lag:]) / (n - lag) for lag in range(self._lags + 1)]
        self._sum = self._sum + np.array(products) / products[0]
        self._windows += 1

    def metrics(self, stride_time_s: float | None, strides: int) -> list[Metric]:
        """Every row; `stride_time_s` is the mean, which tells where the peaks are looked for."""
        because = NO_WINDOW if not self._windows else NO_STRIDE_TIME
        if stride_time_s is None or not self._windows:
            return [summary.withheld(definition, None, strides, because) for definition in TRUNK]
        step, stride = self._peak(stride_time_s / 2), self._peak(stride_time_s)
        if stride <= 0:
            return [summary.withheld(definition, None, strides, NO_PEAK) for definition in TRUNK]
        values = zip((TRUNK_STEP, TRUNK_STRIDE, TRUNK_SYMMETRY), (step, stride, step / stride), strict=True)
        return [summary.shown(definition, None, value, None, None, strides) for definition, value in values]

    def _peak(self, lag_s: float) -> float:
        """Largest autocorrelation near a lag."""
        near = self._p.peak_within * lag_s
        first, last = (round(edge * self._rate_hz) for edge in (lag_s - near, lag_s + near))
        return float((self._sum[first : last + 1] / self._windows).max(initial=-1.0))

    def snapshot(self) -> State:
        """The window in the making, and the sums."""
        return {
            "last_ns": self._last_ns,
            "window": pack_array(np.array(self._window)),
            "sum": pack_array(self._sum),
            "windows": self._windows,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._last_ns, self._windows = state["last_ns"], state["windows"]
        self._window, self._sum = unpack_array(state["window"]).tolist(), unpack_array(state["sum"])


def trunk_regularity(description: SessionDescription, parameters: TrunkParameters) -> TrunkRegularity | None:
    """Of a session in which the lower back is all that tells the gait."""
    if not wears_back_alone(description):
        return None
    rates = [s.rate_hz for hub in description.hubs for s in hub.sensors if s.segment is Segment.PELVIS]
    return TrunkRegularity(rates[0], parameters)


def trunk_metrics(trunk: TrunkRegularity, walking: Sequence[Metric]) -> list[Metric]:
    """Every row, from the strides of the same session."""
    stride_time = next(metric for metric in walking if metric.name == "stride_time")
    return trunk.metrics(stride_time.value, stride_time.strides)
