"""Moments of every measure and every curve over a set of strides."""

import numpy as np

from schemas.gait import CURVE_POINTS, Stride
from schemas.vocabulary import ANKLES, LOWER_BODY, WHOLE_BODY, Side
from services.definitions.definition import Definition
from services.definitions.strides import STRIDE_METRICS
from services.flow.node import State
from services.metrics.moments import Moments
from services.metrics.shared_errors import FILTER_STEP

HEADING = "pelvis_rotation"
CURVES = tuple(dict.fromkeys(dof.name for dof in (*LOWER_BODY, *WHOLE_BODY, *ANKLES)))
"""Joints of every body model; in a session those of its own are seen."""


def sides_of(definition: Definition) -> tuple[str | None, ...]:
    """The values of `side` that a metric comes with."""
    return (Side.LEFT.value, Side.RIGHT.value) if definition.per_side else (None,)


def side_of_curve(degree_of_freedom: str) -> Side:
    """Whose strides the mean curve of a joint is taken over; the right foot's for the pelvis."""
    return Side.LEFT if degree_of_freedom.endswith("_left") else Side.RIGHT


class Sums:
    """Running sums; their size does not grow with the number of strides."""

    def __init__(self) -> None:
        self.scalars = {
            (definition.name, side): Moments.empty() for definition in STRIDE_METRICS for side in sides_of(definition)
        }
        self.curves = {name: Moments.empty(CURVE_POINTS) for name in CURVES}
        self.deviations = {name: Moments.empty() for name in (FILTER_STEP, *CURVES)}
        self.strides = dict.fromkeys(Side, 0)

    def add(self, stride: Stride) -> None:
        """Take one stride."""
        self.strides[stride.side] += 1
        for definition in STRIDE_METRICS:
            value = None if definition.measure is None else definition.measure(stride)
            if value is not None:
                self.scalars[definition.name, stride.side.value if definition.per_side else None].add(value)
        if stride.step_length_std_m is not None:
            self.deviations[FILTER_STEP].add(stride.step_length_std_m)
        for name, curve in stride.curves.items():
            if name in self.curves and side_of_curve(name) is stride.side:
                self.deviations[name].add(curve.position_std)
                position = np.array(curve.position)
                # Where a person walks to is no property of the gait: the heading is shown about its mean.
                self.curves[name].add(position - position.mean() if name == HEADING else position)

    def merged(self, other: "Sums") -> "Sums":
        """The sums over the strides of both; neither changes."""
        both = Sums()
        both.scalars = {key: moments.merged(other.scalars[key]) for key, moments in self.scalars.items()}
        both.curves = {name: moments.merged(other.curves[name]) for name, moments in self.curves.items()}
        both.deviations = {name: moments.merged(other.deviations[name]) for name, moments in self.deviations.items()}
        both.strides = {side: number + other.strides[side] for side, number in self.strides.items()}
        return both

    def mean_deviations(self) -> dict[str, float]:
        """The filter's own standard deviations, mean over the strides: of a step, m, and of each joint, rad."""
        return {name: float(moments.mean) for name, moments in self.deviations.items() if moments.count}

    def snapshot(self) -> State:
        """All moments and counts."""
        return {
            "scalars": [[name, side, moments.snapshot()] for (name, side), moments in self.scalars.items()],
            "curves": {name: moments.snapshot() for name, moments in self.curves.items() if moments.count},
            "deviations": {name: moments.snapshot() for name, moments in self.deviations.items() if moments.count},
            "strides": {side.value: number for side, number in self.strides.items()},
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.scalars |= {(name, side): Moments.restored(kept) for name, side, kept in state["scalars"]}
        self.curves |= {name: Moments.restored(kept) for name, kept in state["curves"].items()}
        self.deviations |= {name: Moments.restored(kept) for name, kept in state["deviations"].items()}
        self.strides = {side: state["strides"][side.value] for side in Side}
