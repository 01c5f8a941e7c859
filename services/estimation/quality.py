"""What of the session was told and used so far: `data_quality`, now and then and at the end.

Everything is counted in the order of captured time and told before the first sample of the next `period_s`, so that
how samples were batched into messages decides nothing.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from schemas.kinematics import Calibration
from schemas.quality import DataQuality
from schemas.signals import DATA_QUALITY
from schemas.vocabulary import Segment
from services.estimation.parameters import QualityParameters
from services.estimation.quality_data import calibration_flags, misplaced_segments
from services.estimation.quality_sources import Refusal, SourceTallies
from services.estimation.quality_spans import Spans, take_outputs
from services.estimation.samples import Tick
from services.flow.message import Output
from services.flow.node import State

FLAGS = ("calibrated", "absolute")


class Source(NamedTuple):
    """A sensor or camera that is used."""

    name: str
    rate_hz: float
    segment: Segment | None


class QualityWatch:
    """Of one estimator. It sees what goes in and what comes out, and changes neither."""

    def __init__(
        self,
        sources: Sequence[Source],
        needed: Iterable[str],
        refused_before: Callable[[int | None], list[Refusal]],
        parameters: QualityParameters,
        model: str = "lower_body",
    ) -> None:
        """`refused_before` hands out, once, what was refused before a time, ns, or in all."""
        self._sources = sources
        self._refused_before = refused_before
        self._period_ns = round(parameters.period_s * 1e9)
        self._tallies = SourceTallies([source.rate_hz for source in sources])
        self._spans = Spans(model, needed, parameters)
        self._flags = dict.fromkeys(FLAGS, False)
        self._misplaced: list[str] = []
        self._told_until_ns = self._period_ns

    def runs(self, ticks: Sequence[Tick]) -> Iterator[Sequence[Tick]]:
        """The same ticks, cut where something is to be told between two of them."""
        first = 0
        while first < len(ticks):
            until_ns = (ticks[first].captured_ns // self._period_ns + 1) * self._period_ns
            last = len(ticks)
            if ticks[-1].captured_ns >= until_ns:
                last = next(k for k in range(first, len(ticks)) if ticks[k].captured_ns >= until_ns)
            yield ticks[first:last]
            first = last

    def is_due(self, now_ns: int) -> bool:
        """Something is to be told before the sample of this time is counted."""
        return now_ns >= self._told_until_ns

    def due(self, now_ns: int) -> list[Output]:
        """What is to be told before the sample of this time is counted."""
        if not self.is_due(now_ns):
            return []
        begun_ns = now_ns // self._period_ns * self._period_ns
        self._told_until_ns = begun_ns + self._period_ns
        self._tallies.refuse(self._refused_before(begun_ns))
        return self._tell()

    def finish(self) -> list[Output]:
        """The session as a whole."""
        self._tallies.refuse(self._refused_before(None))
        return self._tell()

    def count(self, ticks: Iterable[Tick]) -> None:
        """Ticks of one run."""
        self._tallies.take(ticks)
        self._tallies.refuse(self._refused_before(self._tallies.newest_ns))

    def count_frame(self, captured_ns: int, *, used: bool) -> None:
        """A frame of the only camera; not used when nobody was in it."""
        self._tallies.count(captured_ns, [used])
        self._tallies.refuse(self._refused_before(captured_ns))

    def hear(self, outputs: Sequence[Output]) -> None:
        """What the estimator put out, in its order."""
        take_outputs(self._spans, outputs)
        for output in outputs:
            if isinstance(output.payload, Calibration):
                self._judge(output.payload)

    def _judge(self, calibration: Calibration) -> None:
        self._flags = dict(zip(FLAGS, calibration_flags(calibration), strict=True))
        segments = misplaced_segments(calibration)
        self._misplaced = [source.name for source in self._sources if source.segment in segments]

    def _tell(self) -> list[Output]:
        quality = self._quality()
        return [Output(DATA_QUALITY, quality.captured_ns, quality)]

    def _quality(self) -> DataQuality:
        return DataQuality(
            captured_ns=self._tallies.newest_ns,
            sources=[
                self._tallies.quality(s, source.name, source.name in self._misplaced)
                for s, source in enumerate(self._sources)
            ],
            **self._flags,
            **self._spans.seconds(),
            late=self._tallies.late,
        )

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "tallies": self._tallies.snapshot(),
            "spans": self._spans.snapshot(),
            "flags": dict(self._flags),
            "misplaced": list(self._misplaced),
            "told_until_ns": self._told_until_ns,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._tallies.restore(state["tallies"])
        self._spans.restore(state["spans"])
        self._flags, self._misplaced = dict(state["flags"]), list(state["misplaced"])
        self._told_until_ns = state["told_until_ns"]
