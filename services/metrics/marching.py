"""What marching on the spot amounts to: the strides' numbers that make sense there, and its rhythm."""

import math

from schemas.gait import Stride
from schemas.metrics import Metric
from schemas.vocabulary import Side
from services.definitions.marching import KEPT, RHYTHM
from services.flow.node import State
from services.metrics import summary
from services.metrics.moments import Moments
from services.metrics.parameters import MetricsParameters
from services.metrics.session_totals import SessionTotals


class MarchingTotals(SessionTotals):
    """Sums as in walking. Nobody gets anywhere, so lengths and speeds are not told; the tempo may be anybody's, so
    the rhythm is told by how successive cycles differ."""

    def __init__(self, paretic_side: Side | None = None) -> None:
        super().__init__(paretic_side)
        self._before: dict[Side, Stride | None] = dict.fromkeys(Side)
        self._squares, self._cycles = Moments.empty(), Moments.empty()

    def add(self, stride: Stride) -> None:
        """Take one cycle; those of one foot come in order."""
        super().add(stride)
        before = self._before[stride.side]
        self._before[stride.side] = stride
        if before is None or before.end_ns != stride.start_ns or not (before.valid and stride.valid):
            return
        self._squares.add((stride.stride_time_s - before.stride_time_s) ** 2)
        self._cycles.add(stride.stride_time_s)

    def metrics(self, parameters: MetricsParameters) -> list[Metric]:
        """Those of the strides under their names, then the rhythm."""
        walking = super().metrics(parameters)
        kept = [each.model_copy(update={"name": KEPT[each.name].name}) for each in walking if each.name in KEPT]
        return [*kept, self._rhythm(parameters)]

    def _rhythm(self, parameters: MetricsParameters) -> Metric:
        """sqrt(mean d^2 / 2) / mean; error value / sqrt(n), since successive differences share a cycle."""
        count = self._squares.count
        because = summary.too_few(count, parameters.least_strides_for_variability)
        if because is not None:
            return summary.withheld(RHYTHM, None, count, because)
        value = math.sqrt(float(self._squares.mean) / 2) / float(self._cycles.mean)
        return summary.shown(RHYTHM, None, value, None, value / math.sqrt(count), count)

    def snapshot(self) -> State:
        """Sums of the strides and of their differences."""
        before = [None if stride is None else stride.model_dump(mode="json") for stride in self._before.values()]
        rhythm = {"before": before, "squares": self._squares.snapshot(), "cycles": self._cycles.snapshot()}
        return super().snapshot() | {"rhythm": rhythm}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        super().restore(state)
        rhythm = state["rhythm"]
        kept = [None if stride is None else Stride.model_validate(stride) for stride in rhythm["before"]]
        self._before = dict(zip(Side, kept, strict=True))
        self._squares, self._cycles = Moments.restored(rhythm["squares"]), Moments.restored(rhythm["cycles"])
