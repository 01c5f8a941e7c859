"""Watches both legs, each by what tells its events best: the whole leg, a shank, a foot, or the lower back."""

from collections.abc import Mapping
from typing import NamedTuple, Protocol

from schemas.kinematics import SegmentMotion
from schemas.session import Anthropometry
from schemas.vocabulary import EventSource, Segment, Side
from services.flow.node import State
from services.segmentation.batch import INDEX, Batch
from services.segmentation.gait.back_steps import BackStepDetector
from services.segmentation.gait.leg_kinematics import SIDES, leg_motion
from services.segmentation.gait.lone_motion import LoneMotion
from services.segmentation.gait.lone_swing import FootSwingDetector, ShankSwingDetector
from services.segmentation.gait.swing import Contact, SwingDetector
from services.segmentation.parameters import SegmentationParameters

OF_THE_MODEL = (EventSource.FULL_LEG, EventSource.SHANK)
"""Sources that the joint coordinates tell; the others have a motion of their own."""

SWING_DETECTORS: dict[EventSource, type[SwingDetector]] = {
    EventSource.FULL_LEG: SwingDetector,
    EventSource.SHANK: ShankSwingDetector,
    EventSource.FOOT: FootSwingDetector,
}


class LegInstant(NamedTuple):
    """One leg at one time, as its source tells it."""

    is_seen: bool
    rate: float | None  # rad/s forward rotation of shank or foot; None without a sample
    forward: float  # m, the ankle ahead of the pelvis
    activity: float | None  # rad/s, how fast what is seen turns; None without a sample


class Legs(Protocol):
    """Whatever tells the events of both legs."""

    def take_motion(self, motion: SegmentMotion | None) -> int:
        """The motion of lone segments at the samples that come next. Returns how many of its samples are unusable."""

    def begin(self, batch: Batch) -> None:
        """The samples that are looked at next, one by one."""

    def look(self, captured_ns: int, row: int) -> list[LegInstant]:
        """Both legs at one sample."""

    def detect(self, captured_ns: int, legs: list[LegInstant]) -> list[tuple[Side, Contact]]:
        """The events that are recognised now."""

    def interrupt(self, leg: int) -> None:
        """Samples of a leg are missing: what was going on is given up."""

    def snapshot(self) -> State:
        """Everything that changes; between messages no batch is at hand."""

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""


class LegWatch:
    """The detectors of a session whose sensors tell the events."""

    def __init__(
        self, sources: Mapping[Side, EventSource], parameters: SegmentationParameters, body: Anthropometry
    ) -> None:
        self._parameters = parameters
        self._body = body
        self._sources = [sources[side] for side in SIDES]
        self._needed = [
            [INDEX[name] for name in ("pelvis_tilt", f"hip_flexion_{side}", f"knee_flexion_{side}")] for side in SIDES
        ]
        self._swings = [
            SWING_DETECTORS[source](parameters) if source in SWING_DETECTORS else None for source in self._sources
        ]
        self._back = BackStepDetector(parameters) if EventSource.LOWER_BACK in self._sources else None
        self.lone = LoneMotion()
        self._in_joints: list[bool] = []
        self._rates: list[list[float]] = []
        self._forward: list[list[float]] = []

    def take_motion(self, motion: SegmentMotion | None) -> int:
        """The motion of lone segments at the samples that come next. Returns how many of its samples are unusable."""
        return self.lone.take(motion)

    def begin(self, batch: Batch) -> None:
        """The samples that are looked at next, one by one."""
        motion = leg_motion(batch.position, batch.velocity, self._body)
        self._in_joints = self._seen_in_joints(batch)
        self._rates, self._forward = motion.shank_rate.tolist(), motion.ankle[0].tolist()

    def _seen_in_joints(self, batch: Batch) -> list[bool]:
        """Which legs the joint coordinates show: the whole leg or, where it never can be, its shank."""
        return [
            bool(batch.valid[needed].all())
            if source is EventSource.FULL_LEG
            else source is EventSource.SHANK and Segment(f"shank_{side}") in batch.observed
            for side, source, needed in zip(SIDES, self._sources, self._needed, strict=True)
        ]

    def look(self, captured_ns: int, row: int) -> list[LegInstant]:
        """Both legs at one sample."""
        rates, forward = self._rates[row], self._forward[row]
        return [
            LegInstant(self._in_joints[leg], rates[leg], forward[leg], abs(rates[leg]))
            if source in OF_THE_MODEL
            else self._look_alone(captured_ns, leg, source)
            for leg, source in enumerate(self._sources)
        ]

    def _look_alone(self, captured_ns: int, leg: int, source: EventSource) -> LegInstant:
        if source is EventSource.NOTHING:
            return LegInstant(False, None, 0.0, None)
        segment = Segment(f"foot_{SIDES[leg]}") if source is EventSource.FOOT else Segment.PELVIS
        motion = self.lone.at(segment, captured_ns)
        is_seen = self.lone.is_heard(segment, captured_ns, self._parameters.longest_gap_s)
        if motion is None:
            return LegInstant(is_seen, None, 0.0, None)
        x, y, z = motion.angular_velocity
        return LegInstant(is_seen, z, 0.0, max(abs(x), abs(y), abs(z)))

    def detect(self, captured_ns: int, legs: list[LegInstant]) -> list[tuple[Side, Contact]]:
        """The events that are recognised now."""
        rotating = [swing is not None and swing.rotating for swing in self._swings]
        found: list[tuple[Side, Contact]] = []
        for leg, (side, swing, now) in enumerate(zip(SIDES, self._swings, legs, strict=True)):
            if swing is None or not now.is_seen or now.rate is None:
                continue
            event = swing.step(captured_ns, now.rate, now.forward, rotating[1 - leg])
            if event is not None:
                found.append((side, event))
        return found + self._steps_of_the_back(captured_ns)

    def _steps_of_the_back(self, captured_ns: int) -> list[tuple[Side, Contact]]:
        motion = None if self._back is None else self.lone.at(Segment.PELVIS, captured_ns)
        if self._back is None or motion is None:
            return []
        _, up, right = motion.acceleration
        steps = self._back.step(captured_ns, up, right)
        return [
            (step.side, step.contact)
            for step in steps
            if self._sources[SIDES.index(step.side)] is EventSource.LOWER_BACK
        ]

    def interrupt(self, leg: int) -> None:
        """Samples of a leg are missing: what was going on is given up."""
        swing = self._swings[leg]
        if swing is not None:
            swing.interrupt()
        elif self._back is not None:
            self._back.interrupt()

    def snapshot(self) -> State:
        """What the detectors remember."""
        return {
            "swings": [None if swing is None else swing.snapshot() for swing in self._swings],
            "back": None if self._back is None else self._back.snapshot(),
            "lone": self.lone.snapshot(),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        for swing, kept in zip(self._swings, state["swings"], strict=True):
            if swing is not None:
                swing.restore(kept)
        if self._back is not None:
            self._back.restore(state["back"])
        self.lone.restore(state["lone"])
