"""From strides, and from what the rhythm learned of them, to what the session amounts to."""

from schemas.gait import Stride
from schemas.health import Rejection
from schemas.kinematics import SegmentMotion
from schemas.metrics import Metric, SessionMetrics
from schemas.quality import DataQuality
from schemas.rhythm import LearnedRhythm
from schemas.session import SessionDescription
from schemas.signals import (
    DATA_QUALITY,
    LEARNED_RHYTHM,
    METRICS,
    REPETITION,
    SEGMENT_MOTION,
    STRIDE,
    TASK_PHASE,
    Signal,
)
from schemas.tasks import Repetition, TaskPhase
from schemas.vocabulary import Segment, Side, Task
from services.biomech.event_sources import worn_segments
from services.flow.message import Message, Output, Stream
from services.flow.node import Node, State
from services.flow.software import SOFTWARE
from services.metrics.exercises import SIDES_OF, ExerciseTotals
from services.metrics.marching import MarchingTotals
from services.metrics.parameters import MetricsParameters
from services.metrics.repetitions import RepetitionTotals
from services.metrics.rhythms import rhythm_metrics
from services.metrics.session_totals import SessionTotals
from services.metrics.shared_errors import SharedErrors
from services.metrics.trunk import trunk_metrics, trunk_regularity
from services.metrics.trust import Trust
from services.metrics.walking_tests import TimedTestTotals, timed_test_totals

DEFAULTS = MetricsParameters()


class MetricsNode:
    """Metrics after each stride of both feet, and the final ones at the end.

    When only one foot is seen, they come after every second stride of that foot. Learned rhythms are compared, and the
    quality of the data is heeded, in the final ones only: until all streams have ended, it depends on chance which of
    them has come further. For the same reason a session with an exercise tells of the exercise alone, after each
    repetition, until it ends, and one with a timed test of that test, after each phase. A task of the whole body has
    no metrics of a walk at all.
    """

    outputs: tuple[Signal, ...] = (METRICS,)
    _always: tuple[Stream, ...] = (
        Stream(STRIDE, "segmentation"),
        Stream(LEARNED_RHYTHM, "estimation"),
        Stream(DATA_QUALITY, "estimation"),
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
        self._quality: DataQuality | None = None
        self._totals = _totals(description, parameters)
        self._trust = Trust(description)
        self._trunk = trunk_regularity(description, parameters.trunk)
        self._is_exercise = description.task is Task.KNEE_FLEXION or description.task in SIDES_OF
        self._walks = description.task not in SIDES_OF
        self._repetitions = _repetitions(description, parameters)
        self._attempts = timed_test_totals(description, parameters)
        self._unreported = dict.fromkeys(Side, 0)
        self._captured_ns = 0
        self._repeated_ns = 0
        self._tested_ns = 0

    @property
    def streams(self) -> tuple[Stream, ...]:
        """The motion of the lower back, too, where it is all that tells the gait."""
        return self._always if self._trunk is None else (*self._always, Stream(SEGMENT_MOTION, "estimation"))

    def step(self, message: Message) -> list[Output]:
        """Take a stride, a repetition, a phase, or what the rhythm has learned so far."""
        stride = message.payload
        if isinstance(stride, Repetition):
            return self._take_repetition(stride, message.envelope.captured_ns)
        if isinstance(stride, TaskPhase) and self._attempts is not None:
            return self._take_phase(stride, message.envelope.captured_ns, self._attempts)
        if isinstance(stride, LearnedRhythm):
            self._learned = stride
        if isinstance(stride, DataQuality):
            self._quality = stride
        if isinstance(stride, SegmentMotion) and self._trunk is not None:
            self._trunk.take(stride)
        if not isinstance(stride, Stride) or not self._walks:
            return []
        self._captured_ns = max(self._captured_ns, message.envelope.captured_ns)
        self._totals.add(stride)
        self._unreported[stride.side] += 1
        is_walk = not self._is_exercise and self._attempts is None
        if is_walk and (all(self._unreported.values()) or max(self._unreported.values()) > 1):
            self._unreported = dict.fromkeys(Side, 0)
            return [self._report(final=False)]
        return []

    def _take_repetition(self, repetition: Repetition, captured_ns: int) -> list[Output]:
        self._repetitions.add(repetition)
        self._repeated_ns = max(self._repeated_ns, captured_ns)
        metrics = self._trust.judged(self._repetitions.metrics(), None, {})
        payload = _so_far(self._repeated_ns, metrics, [])
        return [Output(METRICS, self._repeated_ns, payload)]

    def _take_phase(self, phase: TaskPhase, captured_ns: int, attempts: TimedTestTotals) -> list[Output]:
        self._tested_ns = max(self._tested_ns, captured_ns)
        if not attempts.add(phase):
            return []
        metrics, phases = self._trust.judged(attempts.metrics(final=False), None, {}), list(attempts.phases)
        payload = _so_far(self._tested_ns, metrics, phases)
        return [Output(METRICS, self._tested_ns, payload)]

    def finish(self) -> list[Output]:
        """The final metrics, even of a session without a stride."""
        return [self._report(final=True)]

    def _report(self, *, final: bool) -> Output:
        captured_ns, attempts = max(self._captured_ns, self._repeated_ns, self._tested_ns), self._attempts
        quality = self._quality if final else None
        payload = SessionMetrics(
            captured_ns=captured_ns,
            final=final,
            software=SOFTWARE,
            metrics=self._trust.judged(self._metrics(final=final), quality, self._totals.rejected_shares()),
            curves=self._totals.curves(self._parameters),
            sides=self._totals.sides(self._parameters),
            quality=quality,
            phases=[] if attempts is None else list(attempts.phases),
            repetitions=self._repetitions.first if final else [],
        )
        return Output(METRICS, captured_ns, payload)

    def _metrics(self, *, final: bool) -> list[Metric]:
        """Every row that the session has, before anybody has judged it."""
        attempts = self._attempts
        walking = [] if self._is_exercise else self._totals.metrics(self._parameters)
        return [
            *self._repetitions.metrics(),
            *([] if attempts is None else attempts.metrics(final=final)),
            *walking,
            *([] if self._trunk is None or not final else trunk_metrics(self._trunk, walking)),
            *(rhythm_metrics(self._learned if final else None, self._known, final=final) if self._walks else []),
        ]

    def rejections(self) -> list[Rejection]:
        """None: strides that do not count are metrics of their own."""
        return []

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "totals": self._totals.snapshot(),
            "unreported": {side.value: number for side, number in self._unreported.items()},
            "captured_ns": self._captured_ns,
            "repetitions": self._repetitions.snapshot(),
            "repeated_ns": self._repeated_ns,
            "attempts": None if self._attempts is None else self._attempts.snapshot(),
            "tested_ns": self._tested_ns,
            "learned": None if self._learned is None else self._learned.model_dump(mode="json"),
            "trunk": None if self._trunk is None else self._trunk.snapshot(),
            "quality": None if self._quality is None else self._quality.model_dump(mode="json"),
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        self._totals.restore(state["totals"])
        self._unreported = {side: state["unreported"][side.value] for side in Side}
        self._captured_ns = state["captured_ns"]
        self._repetitions.restore(state["repetitions"])
        self._repeated_ns, self._tested_ns = state["repeated_ns"], state["tested_ns"]
        if self._attempts is not None:
            self._attempts.restore(state["attempts"])
        if self._trunk is not None:
            self._trunk.restore(state["trunk"])
        learned, quality = state["learned"], state["quality"]
        self._quality = None if quality is None else DataQuality.model_validate(quality)
        self._learned = None if learned is None else LearnedRhythm.model_validate(learned)


def _so_far(captured_ns: int, metrics: list[Metric], phases: list[TaskPhase]) -> SessionMetrics:
    """Of a task alone, while it goes on."""
    return SessionMetrics(
        captured_ns=captured_ns,
        final=False,
        software=SOFTWARE,
        metrics=metrics,
        curves=[],
        sides=[],
        quality=None,
        phases=phases,
        repetitions=[],
    )


def _totals(description: SessionDescription, parameters: MetricsParameters) -> SessionTotals:
    paretic_side = description.conditions.paretic_side
    if description.task is Task.MARCHING:
        return MarchingTotals(paretic_side)
    return SessionTotals(paretic_side, SharedErrors(description, parameters.shared))


def _repetitions(description: SessionDescription, parameters: MetricsParameters) -> RepetitionTotals | ExerciseTotals:
    if description.task in SIDES_OF:
        return ExerciseTotals(description.task, parameters)
    return RepetitionTotals(_exercised(description) if description.task is Task.KNEE_FLEXION else (), parameters)


def _exercised(description: SessionDescription) -> list[Side]:
    """The knees that wear a sensor above and below."""
    worn = worn_segments(description.hubs)
    return [side for side in Side if {Segment(f"thigh_{side}"), Segment(f"shank_{side}")} <= worn]


def build(description: SessionDescription) -> Node:
    """The node with default parameters."""
    return MetricsNode(description)
