"""What the repetitions of a session amount to: sums as they come, and the first of them one by one."""

from collections.abc import Iterable

from schemas.metrics import Metric
from schemas.tasks import Repetition
from schemas.vocabulary import Side
from services.definitions.repetitions import (
    RANGE,
    RANGE_CV,
    RANGE_SD,
    RANGE_SLOPE,
    REPETITION_MEANS,
    REPETITIONS_COUNTED,
    REPETITIONS_REJECTED,
    TEMPO,
    RepetitionMeans,
    range_of,
)
from services.flow.node import State
from services.metrics import summary
from services.metrics.intervals import of_mean
from services.metrics.moments import Moments
from services.metrics.parameters import MetricsParameters
from services.metrics.trend import Trend

NOUN = "repetitions"


class MovementTotals:
    """One movement. The size does not grow with the number of repetitions."""

    def __init__(self, means: RepetitionMeans) -> None:
        self._means = means
        self.moments = {definition.name: Moments.empty() for definition, _ in means}
        self.intervals = Moments.empty()
        self.ranges = Trend()
        self.rejected = 0
        self._newest: tuple[int, int, int] | None = None  # index, start and end in ns, of the last that counted

    def add(self, repetition: Repetition, longest_pause_s: float) -> None:
        """Take the next one."""
        if not repetition.valid:
            self.rejected += 1
            return
        for definition, measure in self._means:
            value = measure(repetition)
            if value is not None:
                self.moments[definition.name].add(value)
        # Counted by those that count: a partial one between two others is told, but no step of the trend.
        self.ranges.add(float(self.ranges.count), range_of(repetition))
        if self._newest is not None:
            index, start_ns, end_ns = self._newest
            follows = repetition.index == index + 1
            if follows and repetition.start_ns - end_ns <= longest_pause_s * 1e9:
                self.intervals.add((repetition.start_ns - start_ns) / 1e9)
        self._newest = repetition.index, repetition.start_ns, repetition.end_ns

    def metrics(self, side: str | None, parameters: MetricsParameters) -> list[Metric]:
        """Every row of the table, in its order; side None for a movement of the whole body."""
        least, ranges = parameters.least_repetitions, self.moments[RANGE]
        return [
            summary.shown(REPETITIONS_COUNTED, side, float(ranges.count), None, None, ranges.count),
            summary.shown(REPETITIONS_REJECTED, side, float(self.rejected), None, None, self.rejected),
            *(
                summary.mean_metric(definition, side, self.moments[definition.name], least, NOUN)
                for definition, _ in self._means
            ),
            *summary.variability_metrics(RANGE_SD, RANGE_CV, side, ranges, least, NOUN),
            self._slope(side, least),
            self._tempo(side, least),
        ]

    def _slope(self, side: str | None, least: int) -> Metric:
        count, slope = self.ranges.count, self.ranges.slope()
        because = summary.too_few(count, least, NOUN)
        if because is not None or slope is None:
            return summary.withheld(RANGE_SLOPE, side, count, because or summary.too_few(count, 3, NOUN) or "")
        return summary.shown(RANGE_SLOPE, side, slope[0], None, slope[1], count, of_mean(*slope, count - 2))

    def _tempo(self, side: str | None, least: int) -> Metric:
        """60 / mean interval; its spread and error follow to first order."""
        mean = summary.mean_metric(TEMPO, side, self.intervals, least - 1, "intervals between repetitions of a set")
        if mean.value is None or mean.spread is None or mean.mean_std is None:
            return mean
        tempo = 60.0 / mean.value
        spread, error = (tempo * std / mean.value for std in (mean.spread, mean.mean_std))
        interval = of_mean(tempo, error, mean.strides - 1)
        return summary.shown(TEMPO, side, tempo, spread, error, mean.strides, interval)

    def snapshot(self) -> State:
        """All sums."""
        return {
            "moments": {name: moments.snapshot() for name, moments in self.moments.items()},
            "intervals": self.intervals.snapshot(),
            "ranges": self.ranges.snapshot(),
            "rejected": self.rejected,
            "newest": None if self._newest is None else list(self._newest),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.moments = {name: Moments.restored(kept) for name, kept in state["moments"].items()}
        self.intervals = Moments.restored(state["intervals"])
        self.ranges = Trend.restored(state["ranges"])
        self.rejected = state["rejected"]
        newest = state["newest"]
        self._newest = None if newest is None else (newest[0], newest[1], newest[2])


class RepetitionTotals:
    """The knees of a session that wear sensors."""

    def __init__(self, sides: Iterable[Side], parameters: MetricsParameters) -> None:
        self._parameters = parameters
        self._knees = {side: MovementTotals(REPETITION_MEANS) for side in sides}
        self.first: list[Repetition] = []
        """One by one, those that count and those that do not, as many as a message takes."""

    def add(self, repetition: Repetition) -> None:
        """Take the next one."""
        if repetition.side in self._knees:
            self._knees[repetition.side].add(repetition, self._parameters.longest_pause_s)
        if len(self.first) < self._parameters.most_repetitions:
            self.first.append(repetition)

    def metrics(self) -> list[Metric]:
        """Row by row, the sides beside each other."""
        columns = [knee.metrics(side.value, self._parameters) for side, knee in self._knees.items()]
        return [metric for row in zip(*columns, strict=True) for metric in row]

    def snapshot(self) -> State:
        """Sums, and the first repetitions."""
        return {
            "knees": {side.value: knee.snapshot() for side, knee in self._knees.items()},
            "first": [repetition.model_dump(mode="json") for repetition in self.first],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        for side, knee in self._knees.items():
            knee.restore(state["knees"][side.value])
        self.first = [Repetition.model_validate(repetition) for repetition in state["first"]]
