"""From joint angles, or from the motion of lone segments, to contacts and strides."""

from dataclasses import replace

from schemas.gait import GaitEvent
from schemas.kinematics import SegmentMotion
from schemas.session import SessionDescription
from schemas.signals import GAIT_EVENT, STRIDE
from schemas.vocabulary import EventSource
from services.biomech.event_sources import session_event_sources
from services.flow.message import Output
from services.flow.node import State
from services.segmentation.batch import Batch
from services.segmentation.camera_gait.camera_legs import CameraLegs
from services.segmentation.camera_gait.parameters import CameraGaitParameters
from services.segmentation.gait.history import History
from services.segmentation.gait.leg_kinematics import SIDES
from services.segmentation.gait.leg_watch import LegInstant, Legs, LegWatch
from services.segmentation.gait.strides import GAP, OUT_OF_VIEW, SENSOR_MISSING, Flaw, StrideAssembler
from services.segmentation.parameters import SegmentationParameters

SECOND_NS = 1_000_000_000


class GaitSegmenter:
    """Events as they are recognised, strides once they are complete; by sensors or by a camera."""

    def __init__(self, description: SessionDescription, parameters: SegmentationParameters) -> None:
        sources = session_event_sources(description)
        if EventSource.LOWER_BACK in sources.values():
            parameters = replace(parameters, history_margin_s=parameters.back_history_margin_s)
        by_camera = EventSource.CAMERA in sources.values()
        camera = CameraGaitParameters()
        self._parameters = parameters = camera.over(parameters) if by_camera else parameters
        body, self._history = description.anthropometry, History()
        self._legs: Legs
        if by_camera:
            self._legs = legs = CameraLegs(camera)
            places = legs.placements
            self._strides = StrideAssembler(parameters, body, self._history, places.step, places.width)
        else:
            self._legs = LegWatch(sources, parameters, body)
            self._strides = StrideAssembler(parameters, body, self._history)
        self._unseen = OUT_OF_VIEW if by_camera else SENSOR_MISSING
        self._seen = [False, False]
        self._last_ns: int | None = None
        self._still_since_ns: int | None = None

    def take_motion(self, motion: SegmentMotion | None) -> int:
        """The motion of lone segments at the samples that come next. Returns how many of its samples are unusable."""
        return self._legs.take_motion(motion)

    def take(self, batch: Batch) -> list[Output]:
        """Events and strides that these samples lead to."""
        self._legs.begin(batch)
        outputs: list[Output] = []
        for i, captured_ns in enumerate(batch.captured_ns.tolist()):
            if self._last_ns is not None and captured_ns // SECOND_NS != self._last_ns // SECOND_NS:
                self._strides.forget(captured_ns)
            self._history.append(batch, i)
            outputs += self._sample(captured_ns, self._legs.look(captured_ns, i))
        return outputs

    def finish(self) -> list[Output]:
        """The strides that still waited."""
        now_ns = self._last_ns or 0
        return [Output(STRIDE, now_ns, stride) for stride in self._strides.release(None)]

    def _sample(self, captured_ns: int, legs: list[LegInstant]) -> list[Output]:
        self._note_gap(captured_ns)
        self._note_sight(captured_ns, [leg.is_seen for leg in legs])
        self._note_pause(captured_ns, legs)
        outputs: list[Output] = []
        for side, event in self._legs.detect(captured_ns, legs):
            self._strides.add_event(side, event)
            payload = GaitEvent(kind=event.kind, side=side, captured_ns=event.captured_ns, time_std_s=event.std_s)
            outputs.append(Output(GAIT_EVENT, captured_ns, payload))
        self._last_ns = captured_ns
        return outputs + [Output(STRIDE, captured_ns, stride) for stride in self._strides.release(captured_ns)]

    def _note_gap(self, captured_ns: int) -> None:
        last_ns = self._last_ns
        if last_ns is None or captured_ns - last_ns <= self._parameters.longest_gap_s * 1e9:
            return
        for leg, side in enumerate(SIDES):
            self._strides.add_flaw(side, Flaw(last_ns, captured_ns, GAP))
            self._legs.interrupt(leg)

    def _note_sight(self, captured_ns: int, seen: list[bool]) -> None:
        for leg, side in enumerate(SIDES):
            if seen[leg] == self._seen[leg] and self._last_ns is not None:
                continue
            flaws = self._strides.legs[side].flaws
            if not seen[leg]:
                self._strides.add_flaw(side, Flaw(captured_ns, None, self._unseen))
                self._legs.interrupt(leg)
            elif flaws and flaws[-1].until_ns is None:
                flaws[-1].until_ns = captured_ns
        self._seen = seen

    def _note_pause(self, captured_ns: int, legs: list[LegInstant]) -> None:
        visible = [leg for leg in legs if leg.is_seen]
        if visible and all(leg.activity is None for leg in visible):
            return
        if any(leg.activity is not None and leg.activity > self._parameters.pause_rate for leg in visible):
            self._still_since_ns = None
        elif self._still_since_ns is None:
            self._still_since_ns = captured_ns
        elif captured_ns - self._still_since_ns > self._parameters.pause_s * 1e9:
            self._strides.end_bout()

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "history": self._history.snapshot(),
            "strides": self._strides.snapshot(),
            "legs": self._legs.snapshot(),
            "seen": self._seen,
            "last_ns": self._last_ns,
            "still_since_ns": self._still_since_ns,
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        self._history.restore(state["history"])
        self._strides.restore(state["strides"])
        self._legs.restore(state["legs"])
        self._seen = list(state["seen"])
        self._last_ns = state["last_ns"]
        self._still_since_ns = state["still_since_ns"]
