"""What a session amounts to: the strides that count, summed up as they come."""

from dataclasses import dataclass

from schemas.gait import Stride
from schemas.metrics import MeanCurve, Metric, SideComparison
from schemas.vocabulary import Side
from services.definitions.definition import CV_SUFFIX, SD_SUFFIX, Definition
from services.definitions.strides import STRIDE_METRICS
from services.definitions.variability import (
    COUNTED,
    COUNTS,
    ENDS,
    REJECTED,
    TURNING,
    VARIABILITY,
    VARIABILITY_OF,
)
from services.flow.node import State
from services.metrics import summary
from services.metrics.parameters import MetricsParameters
from services.metrics.shared_errors import SharedErrors
from services.metrics.sides import compare_sides
from services.metrics.sums import Sums, sides_of
from services.metrics.symmetry import symmetry_metrics

_ROWS = {definition.name: definition for definition in (*STRIDE_METRICS, *VARIABILITY)}


@dataclass(frozen=True, slots=True)
class Newest:
    """The last stride of a foot so far. Whether it was the last of a walk shows only in what follows."""

    stride: Stride
    first: bool  # of its walk


class SessionTotals:
    """Sums over steady strides, and over the first and last of each foot in a walk; counts by side.

    A stride goes on from another when it starts with the contact that ended that one. The first and the last of such
    a row are a start and a stop (or their neighbours were not seen): half a step long, slow, and no property of steady
    walking. They are left out as soon as every foot that is seen has enough steady strides; until then all count.
    The size does not grow with the session.
    """

    def __init__(self, paretic_side: Side | None = None, shared: SharedErrors | None = None) -> None:
        """`shared`: errors that no number of strides averages out; None where nothing is known of them."""
        self._paretic_side = paretic_side
        self._shared = shared
        self._used = dict.fromkeys(Side, 0)
        self._steady = Sums()
        self._ends = Sums()
        self._newest: dict[Side, Newest | None] = dict.fromkeys(Side)
        self._unused = {(name, side): 0 for name in (TURNING, REJECTED) for side in Side}

    def add(self, stride: Stride) -> None:
        """Take one stride; strides of one foot come in order."""
        newest = self._newest[stride.side]
        first = newest is None or newest.stride.end_ns != stride.start_ns
        if newest is not None and _counts(newest.stride):
            (self._ends if newest.first or first else self._steady).add(newest.stride)
        self._newest[stride.side] = Newest(stride, first)
        self._used[stride.side] += stride.valid
        if not _counts(stride):
            self._unused[TURNING if stride.valid else REJECTED, stride.side] += 1

    def metrics(self, parameters: MetricsParameters) -> list[Metric]:
        """Every row of the table, in its order."""
        sums, left_out = self._counting(parameters)
        means = self._means(sums, parameters)
        symmetry = symmetry_metrics(means, self._paretic_side, self._log_std)
        variability = _variability(sums, self._shared, parameters)
        return [*means.values(), *symmetry, *variability, *self._numbers(sums, left_out)]

    def _means(self, sums: Sums, parameters: MetricsParameters) -> dict[tuple[str, str | None], Metric]:
        stride_time_s, deviations = float(sums.scalars["stride_time", None].mean), sums.mean_deviations()
        found = {}
        for definition in STRIDE_METRICS:
            for side in sides_of(definition):
                moments, shared_std = sums.scalars[definition.name, side], 0.0
                if self._shared is not None and moments.count:
                    value = float(moments.mean)
                    shared_std = self._shared.std(definition, value, side, stride_time_s, deviations)
                least = parameters.least_strides
                found[definition.name, side] = summary.mean_metric(
                    definition, side, moments, least, shared_std=shared_std
                )
        return found

    def _log_std(self, definition: Definition) -> float:
        return 0.0 if self._shared is None else self._shared.log_std(definition)

    def rejected_shares(self) -> dict[str | None, float]:
        """Of the strides of each side, and of both, those about which something is wrong."""
        wrong = {side: self._unused[REJECTED, side] for side in Side}
        all_of = {side: wrong[side] + self._used[side] for side in Side}
        shares: dict[str | None, float] = {
            side.value: wrong[side] / all_of[side] if all_of[side] else 0.0 for side in Side
        }
        # Of what rests on either foot the better one decides.
        seen = [shares[side.value] for side in Side if all_of[side]]
        return {**shares, None: min(seen, default=0.0)}

    def sides(self, parameters: MetricsParameters) -> list[SideComparison]:
        """Leg against leg, joint by joint: the paretic one against the other, else left against right."""
        sums, _ = self._counting(parameters)
        reference = Side.RIGHT if self._paretic_side is None else self._paretic_side.other
        return compare_sides(sums.curves, reference, parameters.least_strides)

    def curves(self, parameters: MetricsParameters) -> list[MeanCurve]:
        """Mean curves of the joints that were seen in enough strides."""
        sums, _ = self._counting(parameters)
        drawn = [summary.mean_curve(name, moments, parameters.least_strides) for name, moments in sums.curves.items()]
        return [curve for curve in drawn if curve is not None]

    def _counting(self, parameters: MetricsParameters) -> tuple[Sums, dict[Side, int]]:
        """The sums over the strides that count, and how many of each foot are left out as start or stop."""
        newest = [kept.stride for kept in self._newest.values() if kept is not None and _counts(kept.stride)]
        at_ends = {side: count + sum(one.side is side for one in newest) for side, count in self._ends.strides.items()}
        seen = [side for side in Side if self._steady.strides[side] + at_ends[side]]
        if seen and all(self._steady.strides[side] >= parameters.least_steady_strides for side in seen):
            return self._steady, at_ends
        last = Sums()
        for stride in newest:
            last.add(stride)
        return self._steady.merged(self._ends.merged(last)), dict.fromkeys(Side, 0)

    def _numbers(self, sums: Sums, left_out: dict[Side, int]) -> list[Metric]:
        numbers = self._unused | {(COUNTED, side): sums.strides[side] for side in Side}
        numbers |= {(ENDS, side): left_out[side] for side in Side}
        return [
            summary.shown(definition, side.value, float(number), None, None, number)
            for definition in COUNTS
            for side in Side
            for number in [numbers[definition.name, side]]
        ]

    def snapshot(self) -> State:
        """Sums, counts and the newest strides."""
        return {
            "steady": self._steady.snapshot(),
            "ends": self._ends.snapshot(),
            "unused": [[name, side.value, number] for (name, side), number in self._unused.items()],
            "used": {side.value: number for side, number in self._used.items()},
            "newest": [[kept.stride.model_dump(mode="json"), kept.first] for kept in self._newest.values() if kept],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._steady.restore(state["steady"])
        self._ends.restore(state["ends"])
        self._unused |= {(name, Side(side)): number for name, side, number in state["unused"]}
        self._used = {side: state["used"][side.value] for side in Side}
        self._newest = dict.fromkeys(Side)
        for kept, first in state["newest"]:
            stride = Stride.model_validate(kept)
            self._newest[stride.side] = Newest(stride, first)


def _counts(stride: Stride) -> bool:
    return stride.valid and not stride.turning


def _variability(sums: Sums, shared: SharedErrors | None, parameters: MetricsParameters) -> list[Metric]:
    metrics: list[Metric] = []
    for name in VARIABILITY_OF:
        sd, cv = _ROWS[name + SD_SUFFIX], _ROWS[name + CV_SUFFIX]
        pairs = []
        for side in sides_of(sd):
            moments, noise = sums.scalars[name, side], summary.NO_NOISE
            if shared is not None and moments.count:
                noise = summary.Noise(shared.noise(sd, float(moments.mean)), shared.noise(cv, float(moments.mean)))
            least = parameters.least_strides_for_variability
            pairs.append(summary.variability_metrics(sd, cv, side, moments, least, noise=noise))
        metrics += [pair[0] for pair in pairs] + [pair[1] for pair in pairs]
    return metrics
