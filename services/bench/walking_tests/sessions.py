"""Sessions through the whole chain, and what came of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from schemas.metrics import Metric, SessionMetrics
from schemas.session import SessionDescription
from schemas.tasks import TaskPhase
from schemas.vocabulary import TaskPhaseKind
from services.cli.assembly import NODES
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic.motions import parse_motion

UNCHANGED: Mapping[str, Any] = {}


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


def measured(spec: str, changes: Mapping[str, Any] = UNCHANGED) -> Outcome:
    """A source as its description says, or with changes to it."""
    return measured_as(spec, [changes])[0]


def measured_as(spec: str, told: Sequence[Mapping[str, Any]]) -> list[Outcome]:
    """One source, estimated once, as several people would have told of it: changes to its description."""
    source = open_source(spec, session="walking-test")
    described = [source.describe().model_copy(update=dict(changes)) for changes in told]
    estimation = _chain(described[0], ("estimation",))
    others = [_chain(description, ("segmentation", "metrics")) for description in described]
    finals: list[SessionMetrics | None] = [None] * len(told)
    for message in iter_messages(source):
        for estimated in estimation.push(message):
            for k, chain in enumerate(others):
                for produced in chain.push(estimated):
                    finals[k] = produced.payload if isinstance(produced.payload, SessionMetrics) else finals[k]
    return [Outcome(final) for final in finals if final is not None]


def _chain(description: SessionDescription, names: tuple[str, ...]) -> Chain:
    return Chain([HostedNode(name, description.session, NODES[name](description)) for name in names])


def truth_of(spec: str) -> Any:
    """The session behind a synthetic specification."""
    motion, _, options = spec.removeprefix("synthetic:").partition("?")
    return parse_motion(motion, options)
