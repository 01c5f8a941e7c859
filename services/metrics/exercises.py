"""What a task of the whole body amounts to: its movements, and both sides beside each other."""

from collections.abc import Iterable

from schemas.metrics import Metric
from schemas.tasks import Repetition
from schemas.vocabulary import Side, Task
from services.definitions.definition import Definition
from services.definitions.exercises import (
    EXERCISE_MEANS,
    JOINT_RANGES,
    JOINT_RATIOS,
    JOINTS_OF,
    RANGE_RATIO,
    joint_range,
)
from services.definitions.repetitions import RANGE
from services.flow.node import State
from services.metrics import summary
from services.metrics.moments import Moments
from services.metrics.parameters import MetricsParameters
from services.metrics.repetitions import NOUN, MovementTotals

SIDES_OF: dict[Task, tuple[Side | None, ...]] = {
    Task.SQUAT: (None,),
    Task.STEPPING: tuple(Side),
    Task.TRUNK_TILT_SAGITTAL: (None,),
    Task.TRUNK_TILT_FRONTAL: tuple(Side),
}
"""What a task's repetitions are counted for."""


class ExerciseTotals:
    """Sums over the repetitions of one task, and the first of them one by one."""

    def __init__(self, task: Task, parameters: MetricsParameters) -> None:
        self._parameters = parameters
        self._movements = {side: MovementTotals(EXERCISE_MEANS) for side in SIDES_OF[task]}
        self._joints = {(joint, side): Moments.empty() for joint in JOINTS_OF.get(task, ()) for side in Side}
        self.first: list[Repetition] = []
        """One by one, those that count and those that do not, as many as a message takes."""

    def add(self, repetition: Repetition) -> None:
        """Take the next one."""
        if repetition.side in self._movements:
            self._movements[repetition.side].add(repetition, self._parameters.longest_pause_s)
        for (joint, side), moments in self._joints.items():
            value = joint_range(repetition, joint, side) if repetition.valid else None
            if value is not None:
                moments.add(value)
        if len(self.first) < self._parameters.most_repetitions:
            self.first.append(repetition)

    def metrics(self) -> list[Metric]:
        """Row by row, the sides beside each other, then their symmetry."""
        columns = [totals.metrics(side, self._parameters) for side, totals in self._movements.items()]
        rows = [metric for row in zip(*columns, strict=True) for metric in row]
        joints = [self._joint(joint, side) for joint, side in self._joints]
        ratios = [] if None in self._movements else [_ratio(RANGE_RATIO, rows, RANGE)]
        ratios += [
            _ratio(JOINT_RATIOS[joint], joints, JOINT_RANGES[joint].name)
            for joint in dict.fromkeys(joint for joint, _ in self._joints)
            if joint in JOINT_RATIOS
        ]
        return [*rows, *joints, *ratios]

    def _joint(self, joint: str, side: Side) -> Metric:
        least, definition = self._parameters.least_repetitions, JOINT_RANGES[joint]
        return summary.mean_metric(definition, side, self._joints[joint, side], least, NOUN)

    def snapshot(self) -> State:
        """Sums, and the first repetitions."""
        return {
            "movements": [totals.snapshot() for totals in self._movements.values()],
            "joints": [moments.snapshot() for moments in self._joints.values()],
            "first": [repetition.model_dump(mode="json") for repetition in self.first],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        for totals, kept in zip(self._movements.values(), state["movements"], strict=True):
            totals.restore(kept)
        self._joints = {key: Moments.restored(kept) for key, kept in zip(self._joints, state["joints"], strict=True)}
        self.first = [Repetition.model_validate(repetition) for repetition in state["first"]]


def _ratio(definition: Definition, metrics: Iterable[Metric], name: str) -> Metric:
    of_side = {metric.side: metric for metric in metrics if metric.name == name}
    return summary.ratio_metric(definition, of_side[Side.LEFT], of_side[Side.RIGHT])
