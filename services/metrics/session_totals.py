"""What a session amounts to: the strides that count, summed up as they come."""

import numpy as np

from schemas.gait import CURVE_POINTS, Stride
from schemas.metrics import MeanCurve, Metric
from schemas.vocabulary import LOWER_BODY, Side
from services.flow.node import State
from services.metrics import summary
from services.metrics.definitions import (
    COUNTED,
    COUNTS,
    CV_SUFFIX,
    RATIOS,
    RATIOS_OF,
    REJECTED,
    SD_SUFFIX,
    STRIDE_METRICS,
    TURNING,
    VARIABILITY,
    VARIABILITY_OF,
    Definition,
)
from services.metrics.moments import Moments
from services.metrics.parameters import MetricsParameters

HEADING = "pelvis_rotation"
_ROWS = {definition.name: definition for definition in (*STRIDE_METRICS, *VARIABILITY)}


def sides_of(definition: Definition) -> tuple[str | None, ...]:
    """The values of `side` that a metric comes with."""
    return (Side.LEFT.value, Side.RIGHT.value) if definition.per_side else (None,)


def side_of_curve(degree_of_freedom: str) -> Side:
    """Whose strides the mean curve of a joint is taken over; the right foot's for the pelvis."""
    return Side.LEFT if degree_of_freedom.endswith("_left") else Side.RIGHT


class SessionTotals:
    """Moments of every measure and curve; counts by side. Its size does not grow with the session."""

    def __init__(self) -> None:
        self._scalars = {
            (definition.name, side): Moments.empty() for definition in STRIDE_METRICS for side in sides_of(definition)
        }
        self._curves = {dof.name: Moments.empty(CURVE_POINTS) for dof in LOWER_BODY}
        self._counts = {(definition.name, side.value): 0 for definition in COUNTS for side in Side}

    def add(self, stride: Stride) -> None:
        """Take one stride."""
        count = REJECTED if not stride.valid else TURNING if stride.turning else COUNTED
        self._counts[count, stride.side.value] += 1
        if count != COUNTED:
            return
        for definition in STRIDE_METRICS:
            value = None if definition.measure is None else definition.measure(stride)
            if value is not None:
                self._scalars[definition.name, stride.side.value if definition.per_side else None].add(value)
        for name, curve in stride.curves.items():
            if name in self._curves and side_of_curve(name) is stride.side:
                position = np.array(curve.position)
                # Where a person walks to is no property of the gait: the heading is shown about its mean.
                self._curves[name].add(position - position.mean() if name == HEADING else position)

    def metrics(self, parameters: MetricsParameters) -> list[Metric]:
        """Every row of the table, in its order."""
        means = {
            (definition.name, side): summary.mean_metric(
                definition, side, self._scalars[definition.name, side], parameters.least_strides
            )
            for definition in STRIDE_METRICS
            for side in sides_of(definition)
        }
        ratios = [
            summary.ratio_metric(definition, means[name, Side.LEFT.value], means[name, Side.RIGHT.value])
            for name, definition in zip(RATIOS_OF, RATIOS, strict=True)
        ]
        return [*means.values(), *ratios, *self._variability(parameters), *self._numbers()]

    def curves(self, parameters: MetricsParameters) -> list[MeanCurve]:
        """Mean curves of the joints that were seen in enough strides."""
        drawn = [summary.mean_curve(name, moments, parameters.least_strides) for name, moments in self._curves.items()]
        return [curve for curve in drawn if curve is not None]

    def _variability(self, parameters: MetricsParameters) -> list[Metric]:
        metrics: list[Metric] = []
        for name in VARIABILITY_OF:
            sd, cv = _ROWS[name + SD_SUFFIX], _ROWS[name + CV_SUFFIX]
            pairs = [
                summary.variability_metrics(
                    sd, cv, side, self._scalars[name, side], parameters.least_strides_for_variability
                )
                for side in sides_of(sd)
            ]
            metrics += [pair[0] for pair in pairs] + [pair[1] for pair in pairs]
        return metrics

    def _numbers(self) -> list[Metric]:
        return [
            summary.shown(definition, side.value, float(number), None, None, number)
            for definition in COUNTS
            for side in Side
            for number in [self._counts[definition.name, side.value]]
        ]

    def snapshot(self) -> State:
        """Moments and counts."""
        return {
            "scalars": [[name, side, moments.snapshot()] for (name, side), moments in self._scalars.items()],
            "curves": {name: moments.snapshot() for name, moments in self._curves.items()},
            "counts": [[name, side, number] for (name, side), number in self._counts.items()],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._scalars |= {(name, side): Moments.restored(kept) for name, side, kept in state["scalars"]}
        self._curves |= {name: Moments.restored(kept) for name, kept in state["curves"].items()}
        self._counts |= {(name, side): number for name, side, number in state["counts"]}
