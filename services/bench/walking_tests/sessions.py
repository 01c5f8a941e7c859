"""Sessions through the whole chain, and what came of them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from schemas.metrics import Metric, SessionMetrics
from schemas.tasks import TaskPhase
from schemas.vocabulary import TaskPhaseKind
from services.cli.assembly import build_chain
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic.motions import parse_motion


@dataclass(frozen=True)
class Outcome:
    """The final metrics of one session."""

    final: SessionMetrics

    def metric(self, name: str) -> Metric:
        """By its name."""
        return next(metric for metric in self.final.metrics if metric.name == name)

    def phases(self, kind: TaskPhaseKind) -> list[TaskPhase]:
        """Those that ended, in order."""
        return [phase for phase in self.final.phases if phase.phase is kind and phase.end_ns is not None]


def measured(spec: str, changes: Mapping[str, Any] | None = None) -> Outcome:
    """A source as its description says, or with changes to it: what somebody else would have said of the session."""
    source = open_source(spec, session="walking-test")
    description = source.describe().model_copy(update=dict(changes or {}))
    chain = build_chain(description)
    final: SessionMetrics | None = None
    for message in iter_messages(source):
        for produced in chain.push(message):
            if isinstance(produced.payload, SessionMetrics):
                final = produced.payload
    assert final is not None
    return Outcome(final)


def truth_of(spec: str) -> Any:
    """The session behind a synthetic specification."""
    motion, _, options = spec.removeprefix("synthetic:").partition("?")
    return parse_motion(motion, options)
