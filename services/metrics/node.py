"""From strides, and from what the rhythm learned of them, to what the session amounts to."""

from schemas.gait import Stride
from schemas.health import Rejection
from schemas.metrics import SessionMetrics
from schemas.rhythm import LearnedRhythm
from schemas.session import SessionDescription
from schemas.signals import LEARNED_RHYTHM, METRICS, REPETITION, STRIDE, TASK_PHASE, Signal
from schemas.vocabulary import Side
from services.flow.message import Message, Output, Stream
from services.flow.node import Node, State
from services.metrics.parameters import MetricsParameters
from services.metrics.rhythms import rhythm_metrics
from services.metrics.session_totals import SessionTotals

DEFAULTS = MetricsParameters()


class MetricsNode:
    """Metrics after each stride of both feet, and the final ones at the end.

    When only one foot is seen, they come after every second stride of that foot. Learned rhythms are compared in the
    final ones only: until both streams have ended, it depends on chance which of them has come further.
    """

    outputs: tuple[Signal, ...] = (METRICS,)
    streams: tuple[Stream, ...] = (
        Stream(STRIDE, "segmentation"),
        Stream(LEARNED_RHYTHM, "estimation"),
        Stream(TASK_PHASE, "segmentation"),
        Stream(REPETITION, "segmentation"),
    )

    def __init__(
        self,
        description: SessionDescription,
        parameters: MetricsParameters = DEFAULTS,
    ) -> None:
        self._parameters = parameters
        self._known = description.known_rhythms
        self._learned: LearnedRhythm | None = None
        self._totals = SessionTotals()
        self._unreported = dict.fromkeys(Side, 0)
        self._captured_ns = 0

    def step(self, message: Message) -> list[Output]:
        """Take a stride, or what the rhythm has learned so far."""
        stride = message.payload
        if isinstance(stride, LearnedRhythm):
            self._learned = stride
        if not isinstance(stride, Stride):
            return []
        self._captured_ns = max(self._captured_ns, message.envelope.captured_ns)
        self._totals.add(stride)
        self._unreported[stride.side] += 1
        if all(self._unreported.values()) or max(self._unreported.values()) > 1:
            self._unreported = dict.fromkeys(Side, 0)
            return [self._report(final=False)]
        return []

    def finish(self) -> list[Output]:
        """The final metrics, even of a session without a stride."""
        return [self._report(final=True)]

    def _report(self, *, final: bool) -> Output:
        payload = SessionMetrics(
            captured_ns=self._captured_ns,
            final=final,
            metrics=[
                *self._totals.metrics(self._parameters),
                *rhythm_metrics(self._learned if final else None, self._known, final=final),
            ],
            curves=self._totals.curves(self._parameters),
            phases=[],
            repetitions=[],
        )
        return Output(METRICS, self._captured_ns, payload)

    def rejections(self) -> list[Rejection]:
        """None: strides that do not count are metrics of their own."""
        return []

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "totals": self._totals.snapshot(),
            "unreported": {side.value: number for side, number in self._unreported.items()},
            "captured_ns": self._captured_ns,
            "learned": None if self._learned is None else self._learned.model_dump(mode="json"),
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        self._totals.restore(state["totals"])
        self._unreported = {side: state["unreported"][side.value] for side in Side}
        self._captured_ns = state["captured_ns"]
        learned = state["learned"]
        self._learned = None if learned is None else LearnedRhythm.model_validate(learned)


def build(description: SessionDescription) -> Node:
    """The node with default parameters."""
    return MetricsNode(description)
