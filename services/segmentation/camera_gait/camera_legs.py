"""Watches both legs by the joint centres of a camera."""

import math

from schemas.kinematics import SegmentMotion
from schemas.vocabulary import GaitEventKind, JointCentre, Side
from services.flow.node import State
from services.segmentation.batch import Batch, Centres
from services.segmentation.camera_gait.ankle_swing import AnkleSwingDetector
from services.segmentation.camera_gait.direction import Floor, Walker, WalkingDirection
from services.segmentation.camera_gait.parameters import CameraGaitParameters
from services.segmentation.camera_gait.placements import Placements
from services.segmentation.gait.leg_kinematics import SIDES
from services.segmentation.gait.leg_watch import LegInstant
from services.segmentation.gait.swing import Contact

_AT = {centre: i for i, centre in enumerate(JointCentre)}
_HIPS, _SHOULDERS, _ANKLES = (
    [_AT[JointCentre(f"{joint}_{side}")] for side in SIDES] for joint in ("hip", "shoulder", "ankle")
)
_PELVIS = [_AT[JointCentre.SPINE_BASE], *_HIPS]
_LEG = [[_AT[JointCentre(f"{joint}_{side}")] for joint in ("hip", "knee", "ankle")] for side in SIDES]
_X_AND_Z = [0, 2]


class CameraLegs:
    """The detectors of a session whose events a camera tells."""

    def __init__(self, parameters: CameraGaitParameters) -> None:
        self._parameters = parameters
        self._direction = WalkingDirection(parameters)
        self.placements = Placements(parameters)
        self._swings = [AnkleSwingDetector(parameters) for _ in SIDES]
        self._contact_ns: list[int | None] = [None, None]
        self._recent: list[tuple[int, float, float]] = []  # ns, and both ankles ahead of the pelvis, m
        self._walkers: list[Walker] = []
        self._leg_lengths: list[float] = []
        self._seen = [False, False]

    def take_motion(self, _motion: SegmentMotion | None) -> int:
        """Needs none; nothing is unusable."""
        return 0

    def begin(self, batch: Batch) -> None:
        """The samples that are looked at next, one by one."""
        centres = batch.centres
        if centres is None:
            self._seen, self._walkers = [False, False], []
            return
        pelvis_seen = bool(centres.seen[_PELVIS[0]])
        self._seen = [pelvis_seen and bool(centres.seen[leg].all()) for leg in _LEG]
        self._walkers = _walkers(centres)
        self._leg_lengths = _leg_lengths(centres)

    def look(self, captured_ns: int, row: int) -> list[LegInstant]:
        """Both legs at one sample."""
        if not self._walkers:
            return [LegInstant(False, None, 0.0, None) for _ in SIDES]
        walker = self._walkers[row]
        forward = self._direction.step(captured_ns, walker)
        self.placements.append(captured_ns, walker, forward)
        left, right = (_along(ankle, walker.pelvis, forward) for ankle in walker.ankles)
        speeds = self._speeds(captured_ns, left, right)
        length = self._leg_lengths[row]
        return [
            LegInstant(seen, None, ahead, None if speed is None else speed / length)
            for seen, ahead, speed in zip(self._seen, (left, right), speeds, strict=True)
        ]

    def _speeds(self, captured_ns: int, left: float, right: float) -> tuple[float | None, float | None]:
        """m/s of both ankles against the pelvis, over some frames."""
        self._recent.append((captured_ns, left, right))
        oldest = captured_ns - round(self._parameters.activity_s * 1e9)
        while len(self._recent) > 1 and self._recent[1][0] <= oldest:
            del self._recent[0]
        ns, left_then, right_then = self._recent[0]
        since_s = (captured_ns - ns) / 1e9
        if since_s <= 0.0:
            return None, None
        return abs(left - left_then) / since_s, abs(right - right_then) / since_s

    def detect(self, captured_ns: int, legs: list[LegInstant]) -> list[tuple[Side, Contact]]:
        """The events that are recognised now."""
        found: list[tuple[Side, Contact]] = []
        for leg, (side, swing, now) in enumerate(zip(SIDES, self._swings, legs, strict=True)):
            event = swing.step(captured_ns, now.forward) if now.is_seen else None
            if event is not None:
                self._note(leg, event)
                found.append((side, event))
        return found

    def _note(self, leg: int, event: Contact) -> None:
        if event.kind is GaitEventKind.INITIAL_CONTACT:
            self._contact_ns[leg] = event.captured_ns
            return
        contact_ns, self._contact_ns[leg] = self._contact_ns[leg], None
        if contact_ns is not None and event.captured_ns - contact_ns < self._parameters.longest_stance_s * 1e9:
            self.placements.stood(SIDES[leg], contact_ns, event.captured_ns)

    def interrupt(self, leg: int) -> None:
        """Samples of a leg are missing: what was going on is given up."""
        self._swings[leg].interrupt()
        self._contact_ns[leg] = None

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "direction": self._direction.snapshot(),
            "placements": self.placements.snapshot(),
            "swings": [swing.snapshot() for swing in self._swings],
            "contact_ns": list(self._contact_ns),
            "recent": [list(sample) for sample in self._recent],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._direction.restore(state["direction"])
        self.placements.restore(state["placements"])
        for swing, kept in zip(self._swings, state["swings"], strict=True):
            swing.restore(kept)
        self._contact_ns = list(state["contact_ns"])
        self._recent = [(ns, left, right) for ns, left, right in state["recent"]]


def _walkers(centres: Centres) -> list[Walker]:
    floor = centres.position[:, :, _X_AND_Z]
    pelvis = floor[:, _PELVIS].mean(axis=1).tolist()
    ankles = floor[:, _ANKLES].tolist()
    across = (floor[:, [_HIPS[1], _SHOULDERS[1]]] - floor[:, [_HIPS[0], _SHOULDERS[0]]]).sum(axis=1).tolist()
    return [
        Walker((p[0], p[1]), ((left[0], left[1]), (right[0], right[1])), (a[0], a[1]))
        for p, (left, right), a in zip(pelvis, ankles, across, strict=True)
    ]


def _leg_lengths(centres: Centres) -> list[float]:
    """m, from the hips down to the ankles, never so short that a speed would become none."""
    heights = centres.position[:, :, 1]
    down: list[float] = (heights[:, _HIPS].mean(axis=1) - heights[:, _ANKLES].mean(axis=1)).tolist()
    return [max(length, 0.3) for length in down]


def _along(place: Floor, origin: Floor, forward: Floor) -> float:
    return math.fsum(((place[0] - origin[0]) * forward[0], (place[1] - origin[1]) * forward[1]))
