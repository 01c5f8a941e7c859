"""What of the estimate may be shown: centres seen a moment ago, angles they have shown for a while."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre, Segment
from services.biomech.whole_body.directions import LARGEST_DEVIATION
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
    """Of one person in view. An angle is shown once it has been observable for `show_after_s`.

    It is hidden at once where the posture does not show it or its centres are not seen, and when its deviation has been
    too large for `hide_after_s`: that has peaks of a frame or two, and travels along.
    """

    def __init__(self, parameters: BodyParameters) -> None:
        self._seen_ns = round(parameters.seen_s * 1e9)
        self._after_ns = {True: round(parameters.show_after_s * 1e9), False: round(parameters.hide_after_s * 1e9)}
        self._tracked_ns: list[int | None] = [None] * len(CENTRE_NAMES)
        self._shown: list[bool] = []
        """Per angle; empty before the first frame of a start."""
        self._contrary_ns: list[int | None] = [None] * ANGLES
        """Per angle: since when it should be shown but is not, or the other way round."""

    def begin(self) -> None:
        """A new start: nothing has been seen yet, and what is observable at once is shown at once."""
        self._tracked_ns = [None] * len(CENTRE_NAMES)
        self._shown, self._contrary_ns = [], [None] * ANGLES

    def hide(self) -> None:
        """Nothing is seen, so that everything has to be observable for a while again."""
        self._tracked_ns = [None] * len(CENTRE_NAMES)
        self._shown, self._contrary_ns = [False] * ANGLES, [None] * ANGLES

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
        possible: Flags = observable(told.q[3:], np.zeros(ANGLES), self.seen(now_ns)) & told.usable
        wanted = (possible & (told.deviations[0] <= LARGEST_DEVIATION)).tolist()
        if not self._shown:
            self._shown = list(wanted)
        for i, (flag, can_be, is_shown) in enumerate(zip(wanted, possible.tolist(), self._shown, strict=True)):
            since_ns = self._contrary_ns[i]
            if flag == is_shown:
                self._contrary_ns[i] = None
            elif not can_be:
                self._shown[i], self._contrary_ns[i] = False, None
            elif since_ns is None:
                self._contrary_ns[i] = now_ns
            elif now_ns - since_ns >= self._after_ns[flag]:
                self._shown[i], self._contrary_ns[i] = flag, None
        return list(self._shown)

    def snapshot(self) -> State:
        """Times and flags."""
        return {
            "tracked_ns": list(self._tracked_ns),
            "shown": list(self._shown),
            "contrary_ns": list(self._contrary_ns),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._tracked_ns, self._shown = list(state["tracked_ns"]), list(state["shown"])
        self._contrary_ns = list(state["contrary_ns"])


def observed_segments(seen: Iterable[bool]) -> list[Segment]:
    """Segments all of whose centres are seen."""
    flags = list(seen)
    return [segment for segment, places in SEGMENT_CENTRES.items() if all(flags[m] for m in places)]
