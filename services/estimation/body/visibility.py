"""What of the estimate may be shown: centres seen a moment ago, angles they have shown for a while."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre, Segment
from services.biomech.whole_body.model import CENTRE_NAMES
from services.biomech.whole_body.observability import observable
from services.estimation.body.filters import Told
from services.estimation.body.parameters import BodyParameters
from services.flow.node import State

Flags = NDArray[np.bool_]
States = NDArray[np.int64]

ANGLES = 22

_ENDS = {
    Segment.PELVIS: ("spine_base", "hip_right", "hip_left"),
    Segment.TORSO: ("spine_base", "spine_mid", "spine_shoulder"),
    Segment.THIGH_LEFT: ("hip_left", "knee_left"),
    Segment.THIGH_RIGHT: ("hip_right", "knee_right"),
    Segment.SHANK_LEFT: ("knee_left", "ankle_left"),
    Segment.SHANK_RIGHT: ("knee_right", "ankle_right"),
}
SEGMENT_CENTRES = {
    segment: [CENTRE_NAMES.index(JointCentre(name)) for name in names] for segment, names in _ENDS.items()
}
"""Places in JointCentre of the centres that give a segment its tilt."""


class Visibility:
    """Of one person in view. An angle is shown once it has been observable for `show_after_s`, hidden at once."""

    def __init__(self, parameters: BodyParameters) -> None:
        self._seen_ns, self._after_ns = round(parameters.seen_s * 1e9), round(parameters.show_after_s * 1e9)
        self._tracked_ns: list[int | None] = [None] * len(CENTRE_NAMES)
        self._hidden_ns: list[int | None] = [None] * ANGLES
        """Per angle: when it was last not observable; None while it has been observable since the start."""

    def begin(self) -> None:
        """A new start: nothing has been seen yet, and what is observable at once is shown at once."""
        self._tracked_ns = [None] * len(CENTRE_NAMES)
        self._hidden_ns = [None] * ANGLES

    def hide(self, now_ns: int) -> None:
        """Nothing is seen, so that everything has to be observable for a while again."""
        self._tracked_ns = [None] * len(CENTRE_NAMES)
        self._hidden_ns = [now_ns] * ANGLES

    def see(self, now_ns: int, state: States) -> None:
        """Centres that are tracked, not guessed, in this frame."""
        self._tracked_ns = [
            now_ns if level == 2 else before for level, before in zip(state.tolist(), self._tracked_ns, strict=True)
        ]

    def seen(self, now_ns: int) -> list[bool]:
        """(15,) tracked within the last `seen_s`."""
        return [ns is not None and now_ns - ns <= self._seen_ns for ns in self._tracked_ns]

    def shown(self, now_ns: int, told: Told) -> list[bool]:
        """(22,) angles that may be shown now."""
        flags: Flags = observable(told.q[3:], told.deviations[0], self.seen(now_ns)) & told.usable
        pairs = zip(flags.tolist(), self._hidden_ns, strict=True)
        self._hidden_ns = [before if flag else now_ns for flag, before in pairs]
        # What is hidden now was hidden 0 s ago.
        return [ns is None or now_ns - ns >= self._after_ns for ns in self._hidden_ns]

    def snapshot(self) -> State:
        """Times."""
        return {"tracked_ns": list(self._tracked_ns), "hidden_ns": list(self._hidden_ns)}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._tracked_ns, self._hidden_ns = list(state["tracked_ns"]), list(state["hidden_ns"])


def observed_segments(seen: Iterable[bool]) -> list[Segment]:
    """Segments all of whose centres are seen."""
    flags = list(seen)
    return [segment for segment, places in SEGMENT_CENTRES.items() if all(flags[m] for m in places)]
