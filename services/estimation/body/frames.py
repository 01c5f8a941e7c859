"""From skeleton messages to frames of joint centres, with what is refused of them and why."""

import math
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.health import Reason, Rejection
from schemas.session import CameraDescription
from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import JointCentre, SensorState, SkeletonJoint, TrackingState
from services.biomech.whole_body.model import CENTRE_NAMES
from services.estimation.body.parameters import BodyParameters
from services.flow.node import State

Array = NDArray[np.float64]
States = NDArray[np.int64]

LEVEL = {TrackingState.NOT_TRACKED: 0, TrackingState.INFERRED: 1, TrackingState.TRACKED: 2}
"""How the filter numbers what a camera says of a centre."""


class Frame(NamedTuple):
    """What one camera saw at one instant."""

    captured_ns: int
    body: int | None  # None: nobody was followed
    people: int
    centres: Array  # (15, 3) m, room axes, in the order of JointCentre; 0 where not tracked; of single precision
    state: States  # (15,) 0 not tracked, 1 inferred, 2 tracked

    @property
    def is_somebody(self) -> bool:
        """Anybody's centres are in it."""
        return self.body is not None and bool(self.state.any())


def missing_centres(camera: CameraDescription) -> list[JointCentre]:
    """Centres of the body that a camera does not deliver."""
    return [centre for centre in CENTRE_NAMES if SkeletonJoint(centre.value) not in camera.joints]


class FrameIntake:
    """Judges the frames of one camera one by one, and counts what it refuses."""

    def __init__(self, camera: CameraDescription, parameters: BodyParameters) -> None:
        self.camera, self._parameters = camera, parameters
        self._places = [camera.joints.index(SkeletonJoint(centre.value)) for centre in CENTRE_NAMES]
        self._newest_ns: int | None = None
        self._usable_ns: int | None = None
        self._last: list[list[float] | None] = []
        self._repeats = 0
        self._refused: Counter[Reason] = Counter()
        self._dated: list[tuple[int, int, str]] = []

    def accept(self, batch: SkeletonBatch, message_ns: int) -> Iterator[Frame]:
        """The usable frames of a message, in order of capture."""
        for captured_ns, body, people, position, state in zip(
            batch.captured_ns, batch.body, batch.people, batch.position, batch.state, strict=True
        ):
            reason = self._reason(captured_ns, body, position, state, message_ns)
            if reason is not None:
                self._refused[reason] += 1
                self._dated.append((self._newest_ns or 0, 0, reason.value))
                continue
            self._usable_ns = captured_ns
            yield self._frame(captured_ns, body, people, position, state)

    def _reason(
        self, captured_ns: int, body: int | None, position: list[list[float] | None], state: list[TrackingState],
        message_ns: int,
    ) -> Reason | None:  # fmt: skip
        p = self._parameters
        if len(position) != len(self.camera.joints) or len(state) != len(self.camera.joints):
            return Reason.WRONG_SHAPE
        if abs(captured_ns - message_ns) > p.farthest_from_message_s * 1e9:
            return Reason.OUT_OF_RANGE
        if self._newest_ns is not None and captured_ns <= self._newest_ns:
            return Reason.CLOCK_BACKWARDS
        self._newest_ns = captured_ns
        self._repeats = self._repeats + 1 if body is not None and position == self._last else 0
        self._last = position
        return Reason.STUCK if self._repeats >= p.stuck_after else None

    def _frame(
        self, captured_ns: int, body: int | None, people: int, position: list[list[float] | None],
        state: list[TrackingState],
    ) -> Frame:  # fmt: skip
        # Single precision, 1 um: the last seconds of frames are in every checkpoint.
        centres = np.zeros((len(CENTRE_NAMES), 3), dtype=np.float32)
        levels = np.zeros(len(CENTRE_NAMES), dtype=np.int64)
        for m, place in enumerate(self._places):
            found, level = position[place], LEVEL[state[place]]
            if found is None or level == 0 or body is None:
                continue
            reason = _doubtful(found, self._parameters.farthest_m)
            if reason is not None:
                self._refused[reason] += 1
                continue
            centres[m], levels[m] = found, level
        return Frame(captured_ns, body, people, centres.astype(np.float64), levels)

    def state_at(self, now_ns: int, silent_s: float) -> tuple[SensorState, int]:
        """State of the camera and since when, ns of session time."""
        since_ns = self._usable_ns or 0
        if self._usable_ns is not None and now_ns - self._usable_ns <= silent_s * 1e9:
            return SensorState.OK, since_ns
        return (SensorState.STUCK if self._repeats >= self._parameters.stuck_after else SensorState.REJECTED), since_ns

    def refused_before(self, until_ns: int | None) -> list[tuple[int, int, str]]:
        """Refused frames dated before a time, or all: handed out once."""
        taken = [each for each in self._dated if until_ns is None or each[0] < until_ns]
        self._dated = [each for each in self._dated if until_ns is not None and each[0] >= until_ns]
        return taken

    def rejections(self) -> list[Rejection]:
        """Counts by reason: of frames, and of single centres that are not finite or out of range."""
        name = self.camera.name
        return [Rejection(subject=name, reason=why, count=n) for why, n in sorted(self._refused.items())]

    def snapshot(self) -> State:
        """Times, the last frame's positions, and the counts."""
        return {
            "times_ns": [self._newest_ns, self._usable_ns],
            "last": self._last if _is_finite(self._last) else [],
            "repeats": self._repeats,
            "dated": [list(each) for each in self._dated],
            "refused": {why.value: n for why, n in sorted(self._refused.items())},
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._newest_ns, self._usable_ns = state["times_ns"]
        self._last, self._repeats = state["last"], state["repeats"]
        self._dated = [(captured_ns, place, reason) for captured_ns, place, reason in state["dated"]]
        self._refused = Counter({Reason(why): n for why, n in state["refused"].items()})


def _doubtful(position: list[float], farthest_m: float) -> Reason | None:
    if not all(map(math.isfinite, position)):
        return Reason.NOT_FINITE
    return Reason.OUT_OF_RANGE if max(map(abs, position)) > farthest_m else None


def _is_finite(positions: list[list[float] | None]) -> bool:
    return all(each is None or all(map(math.isfinite, each)) for each in positions)
