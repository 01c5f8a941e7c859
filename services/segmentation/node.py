"""From joint angles and rhythm to gait events and strides."""

from schemas.gait import GaitEvent
from schemas.health import Rejection
from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.session import SessionDescription
from schemas.signals import GAIT_EVENT, STRIDE, Signal
from schemas.vocabulary import Segment, Side
from services.flow.message import Message, Output, Stream
from services.flow.node import Node, State
from services.segmentation.history import History
from services.segmentation.intake import JOINTS_FROM, RHYTHM_FROM, Intake
from services.segmentation.leg_kinematics import INDEX, SIDES, leg_motion
from services.segmentation.pairing import Pairing
from services.segmentation.parameters import SegmentationParameters
from services.segmentation.shank_swing import ShankSwingDetector
from services.segmentation.strides import GAP, SENSOR_MISSING, Flaw, StrideAssembler
from services.segmentation.swing import SwingDetector

SECOND_NS = 1_000_000_000
DEFAULTS = SegmentationParameters()


class SegmentationNode:
    """Events as they are recognised, strides once they are complete."""

    outputs: tuple[Signal, ...] = (GAIT_EVENT, STRIDE)
    streams: tuple[Stream, ...] = (JOINTS_FROM, RHYTHM_FROM)

    def __init__(self, description: SessionDescription, parameters: SegmentationParameters = DEFAULTS) -> None:
        self._parameters = parameters
        self._body = description.anthropometry
        self._intake = Intake()
        self._pairing = Pairing()
        self._history = History()
        self._strides = StrideAssembler(parameters, self._body, self._history)
        worn = {sensor.segment for hub in description.hubs for sensor in hub.sensors}
        self._seen_by = [_needed(side, worn) for side in SIDES]
        self._swings = [
            ShankSwingDetector(parameters) if needed is None else SwingDetector(parameters) for needed in self._seen_by
        ]
        self._seen = [False, False]
        self._last_ns: int | None = None
        self._still_since_ns: int | None = None

    def step(self, message: Message) -> list[Output]:
        """Take a message of either stream."""
        payload = message.payload
        if isinstance(payload, JointState) and payload.captured_ns:
            pairs = self._pairing.add_joints(payload)
        elif isinstance(payload, Rhythm) and payload.captured_ns:
            pairs = self._pairing.add_rhythm(payload)
        else:
            return []
        return [output for joints, rhythm in pairs for output in self._take(joints, rhythm)]

    def finish(self) -> list[Output]:
        """The strides that still waited."""
        outputs = [output for joints, rhythm in self._pairing.flush() for output in self._take(joints, rhythm)]
        now_ns = self._last_ns or 0
        return outputs + [Output(STRIDE, now_ns, stride) for stride in self._strides.release(None)]

    def _take(self, joints: JointState, rhythm: Rhythm | None) -> list[Output]:
        kept = self._intake.take(joints, rhythm)
        if kept is None:
            return []
        batch, velocity = kept
        motion = leg_motion(batch.position, velocity, self._body)
        seen = [_is_seen(side, needed, joints) for side, needed in zip(SIDES, self._seen_by, strict=True)]
        outputs: list[Output] = []
        for i, captured_ns in enumerate(batch.captured_ns.tolist()):
            if self._last_ns is not None and captured_ns // SECOND_NS != self._last_ns // SECOND_NS:
                self._strides.forget(captured_ns)
            self._history.append(batch, i)
            outputs += self._sample(captured_ns, motion.shank_rate[i].tolist(), motion.ankle[0, i].tolist(), seen)
        return outputs

    def _sample(self, captured_ns: int, rates: list[float], forward: list[float], seen: list[bool]) -> list[Output]:
        self._note_gap(captured_ns)
        self._note_sight(captured_ns, seen)
        self._note_pause(captured_ns, [rate for rate, visible in zip(rates, seen, strict=True) if visible])
        rotating = [swing.rotating for swing in self._swings]
        outputs: list[Output] = []
        for leg, side in enumerate(SIDES):
            if not seen[leg]:
                continue
            event = self._swings[leg].step(captured_ns, rates[leg], forward[leg], rotating[1 - leg])
            if event is not None:
                self._strides.add_event(side, event)
                payload = GaitEvent(kind=event.kind, side=side, captured_ns=event.captured_ns, time_std_s=event.std_s)
                outputs.append(Output(GAIT_EVENT, captured_ns, payload))
        self._last_ns = captured_ns
        return outputs + [Output(STRIDE, captured_ns, stride) for stride in self._strides.release(captured_ns)]

    def _note_gap(self, captured_ns: int) -> None:
        last_ns = self._last_ns
        if last_ns is None or captured_ns - last_ns <= self._parameters.longest_gap_s * 1e9:
            return
        for side, swing in zip(SIDES, self._swings, strict=True):
            self._strides.add_flaw(side, Flaw(last_ns, captured_ns, GAP))
            swing.interrupt()

    def _note_sight(self, captured_ns: int, seen: list[bool]) -> None:
        for leg, side in enumerate(SIDES):
            if seen[leg] == self._seen[leg] and self._last_ns is not None:
                continue
            flaws = self._strides.legs[side].flaws
            if not seen[leg]:
                self._strides.add_flaw(side, Flaw(captured_ns, None, SENSOR_MISSING))
                self._swings[leg].interrupt()
            elif flaws and flaws[-1].until_ns is None:
                flaws[-1].until_ns = captured_ns
        self._seen = seen

    def _note_pause(self, captured_ns: int, rates: list[float]) -> None:
        if any(abs(rate) > self._parameters.pause_rate for rate in rates):
            self._still_since_ns = None
        elif self._still_since_ns is None:
            self._still_since_ns = captured_ns
        elif captured_ns - self._still_since_ns > self._parameters.pause_s * 1e9:
            self._strides.end_bout()

    def rejections(self) -> list[Rejection]:
        """Samples that were not used."""
        return self._intake.rejections()

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "pairing": self._pairing.snapshot(),
            "history": self._history.snapshot(),
            "strides": self._strides.snapshot(),
            "swings": [swing.snapshot() for swing in self._swings],
            "seen": self._seen,
            "last_ns": self._last_ns,
            "still_since_ns": self._still_since_ns,
            "intake": self._intake.snapshot(),
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        self._pairing.restore(state["pairing"])
        self._history.restore(state["history"])
        self._strides.restore(state["strides"])
        for swing, kept in zip(self._swings, state["swings"], strict=True):
            swing.restore(kept)
        self._seen = list(state["seen"])
        self._last_ns = state["last_ns"]
        self._still_since_ns = state["still_since_ns"]
        self._intake.restore(state["intake"])


def _needed(side: Side, worn: set[Segment]) -> list[int] | None:
    """Coordinates that are valid while the whole leg is seen; None for a leg that does not wear all its sensors."""
    if not {Segment.PELVIS, Segment(f"thigh_{side}"), Segment(f"shank_{side}")} <= worn:
        return None
    return [INDEX[name] for name in ("pelvis_tilt", f"hip_flexion_{side}", f"knee_flexion_{side}")]


def _is_seen(side: Side, needed: list[int] | None, joints: JointState) -> bool:
    """Either the whole leg is seen or, where it never can be, its shank."""
    if needed is None:
        return Segment(f"shank_{side}") in joints.observed
    return all(joints.valid[index] for index in needed)


def build(description: SessionDescription) -> Node:
    """The node with default parameters."""
    return SegmentationNode(description)
