"""A walking test: the contacts and strides of gait, and the phases that they and the heading make."""

import math
from dataclasses import replace

from schemas.gait import GaitEvent, Stride
from schemas.kinematics import SegmentMotion
from schemas.session import SessionDescription
from schemas.signals import TASK_PHASE
from schemas.tasks import TaskPhase
from schemas.vocabulary import EventSource, GaitEventKind, Segment, Task
from services.biomech.event_sources import session_event_sources, used_segments
from services.flow.message import Output
from services.flow.node import State
from services.segmentation.batch import INDEX, Batch
from services.segmentation.gait.segmenter import GaitSegmenter
from services.segmentation.parameters import SegmentationParameters
from services.segmentation.timed_up_and_go.instants import Instant
from services.segmentation.timed_up_and_go.trace import Trace
from services.segmentation.walking_tests.feet import Feet
from services.segmentation.walking_tests.parameters import WalkingTestParameters
from services.segmentation.walking_tests.sight import Sight, WalkingTest
from services.segmentation.walking_tests.six_minutes import SixMinutes
from services.segmentation.walking_tests.step_trail import Landing, StepTrail
from services.segmentation.walking_tests.ten_metres import TenMetres
from services.segmentation.walking_tests.zone import Zone

WALKING_TESTS = (Task.SIX_MINUTE_WALK, Task.TEN_METRE_WALK)
DEFAULTS = WalkingTestParameters()
_HEADING = INDEX["pelvis_rotation"]


class WalkingTestSegmenter:
    """Gait as in any walk, and the phases of the test, instant by instant, whatever a message holds."""

    def __init__(
        self,
        description: SessionDescription,
        gait: SegmentationParameters,
        parameters: WalkingTestParameters = DEFAULTS,
    ) -> None:
        sources = session_event_sources(description).values()
        sees_both = EventSource.NOTHING not in sources
        late_s = parameters.back_late_s if EventSource.LOWER_BACK in sources else 0.0
        self._late_ns = round(late_s * 1e9)
        if not sees_both:
            # Of one leg every second step is seen.
            parameters = replace(parameters, rest_s=2 * parameters.rest_s)
        self._parameters = parameters
        self._feet = Feet(parameters, description.anthropometry)
        self._gait = GaitSegmenter(description, gait)
        self._longest_gap_s = gait.longest_gap_s
        used = used_segments(description)
        self._shanks = used & {Segment.SHANK_LEFT, Segment.SHANK_RIGHT}
        self._trail, self._trace = StepTrail(parameters), Trace(parameters.memory_s)
        self._test = _test(description, parameters, self._trail, sees_both=sees_both)
        self._last_ns: int | None = None
        self._lost_ns = 0
        """Since the last contact."""
        self._heading: float | None = None
        """rad, at the last contact."""

    def take_motion(self, motion: SegmentMotion | None) -> int:
        """The motion of lone segments at the samples that come next. Returns how many of its samples are unusable."""
        return self._gait.take_motion(motion)

    def take(self, batch: Batch) -> list[Output]:
        """Events, strides and phases that these samples lead to."""
        found = self._gait.take(batch)
        outputs: list[Output] = []
        newest = 0
        for i, captured_ns in enumerate(batch.captured_ns.tolist()):
            self._note_gap(captured_ns, batch)
            while newest < len(found) and found[newest].captured_ns <= captured_ns:
                self._note(found[newest], batch, i)
                outputs.append(found[newest])
                newest += 1
            if self._is_new_instant(captured_ns):
                heading = float(batch.position[i, _HEADING])
                self._trace.append(Instant(captured_ns, heading, None, None, None, None, None, None))
                self._feet.remember(captured_ns, batch, i)
                self._trail.settle(captured_ns)
                sight = Sight(self._trace, self._trail, self._stands(captured_ns - self._late_ns))
                outputs += _sent(captured_ns, self._test.look(sight))
            self._last_ns = captured_ns
        return outputs

    def finish(self) -> list[Output]:
        """The strides that still waited, and the phase that goes on when the session ends."""
        outputs = self._gait.finish()
        for output in outputs:
            if isinstance(output.payload, Stride):
                self._trail.measure(output.payload)
        self._trail.settle(None)
        now_ns = self._last_ns or 0
        return [*outputs, *_sent(now_ns, self._test.finish(now_ns))]

    def _note(self, output: Output, batch: Batch, row: int) -> None:
        payload = output.payload
        if isinstance(payload, Stride):
            self._trail.measure(payload)
        elif isinstance(payload, GaitEvent) and payload.kind is GaitEventKind.TOE_OFF:
            self._trail.lift(payload.side, payload.captured_ns)
        elif isinstance(payload, GaitEvent):
            self._land(payload, batch, row)

    def _land(self, event: GaitEvent, batch: Batch, row: int) -> None:
        heading, before = float(batch.position[row, _HEADING]), self._heading
        stands = self._stands(event.captured_ns)
        straight, self._heading = self._test.turns.state.straight, heading
        turning = before is not None and not stands and abs(heading - before) > self._parameters.turning_step
        onward = 1.0 if straight is None else abs(math.cos(heading - straight))
        side, at_ns = event.side, event.captured_ns
        apart_m = self._feet.ahead(batch, row, side)
        missed_m = self._feet.missed_step(side, self._trail.lifted_ns(side, at_ns)) if stands else 0.0
        lost_s = self._lost_ns * 1e-9
        landing = Landing(side, at_ns, event.time_std_s, onward, apart_m, lost_s, turning, missed_m)
        self._trail.land(landing, stands)
        self._lost_ns = 0

    def _stands(self, at_ns: int) -> bool:
        last_ns = self._trail.last_ns
        return last_ns is None or at_ns - last_ns - self._lost_ns > self._parameters.rest_s * 1e9

    def _note_gap(self, captured_ns: int, batch: Batch) -> None:
        """Time in which no step would have been seen."""
        since_ns = 0 if self._last_ns is None else captured_ns - self._last_ns
        if since_ns > self._longest_gap_s * 1e9 or not self._shanks <= batch.observed:
            self._lost_ns += since_ns
        if since_ns > self._parameters.memory_s * 1e9:
            self._trace.clear()

    def _is_new_instant(self, captured_ns: int) -> bool:
        """By captured time alone, so that batches and sensor rates decide nothing."""
        every_ns = round(self._parameters.instant_s * 1e9)
        return self._last_ns is None or captured_ns // every_ns != self._last_ns // every_ns

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "gait": self._gait.snapshot(),
            "trail": self._trail.snapshot(),
            "feet": self._feet.snapshot(),
            "trace": self._trace.snapshot(),
            "test": self._test.snapshot(),
            "last_ns": self._last_ns,
            "lost_ns": self._lost_ns,
            "heading": self._heading,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._gait.restore(state["gait"])
        self._trail.restore(state["trail"])
        self._feet.restore(state["feet"])
        self._trace.restore(state["trace"])
        self._test.restore(state["test"])
        self._last_ns, self._lost_ns, self._heading = state["last_ns"], state["lost_ns"], state["heading"]


def _test(
    description: SessionDescription, parameters: WalkingTestParameters, trail: StepTrail, *, sees_both: bool
) -> WalkingTest:
    if description.task is Task.SIX_MINUTE_WALK:
        said = description.conditions.test_duration_s
        return SixMinutes(parameters, trail, said, sees_both=sees_both)
    return TenMetres(parameters, trail, Zone.of(description, parameters), sees_both=sees_both)


def _sent(captured_ns: int, phases: list[TaskPhase]) -> list[Output]:
    return [Output(TASK_PHASE, captured_ns, phase) for phase in phases]
