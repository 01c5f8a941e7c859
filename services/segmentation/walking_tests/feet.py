"""How far one foot is ahead of the other, over the last seconds."""

from bisect import bisect_left
from operator import itemgetter

import numpy as np

from schemas.session import Anthropometry
from schemas.vocabulary import Side
from services.flow.node import State
from services.segmentation.batch import DOFS, Batch
from services.segmentation.gait.leg_kinematics import SIDES, leg_motion
from services.segmentation.gait.step_length import NEEDED
from services.segmentation.walking_tests.parameters import WalkingTestParameters


class Feet:
    """The ankles of postures whose angles are all known."""

    def __init__(self, parameters: WalkingTestParameters, body: Anthropometry) -> None:
        self._parameters, self._body = parameters, body
        self._ahead: list[tuple[int, float]] = []
        """ns, and m by which the left ankle is ahead of the right one."""

    def ahead(self, batch: Batch, row: int, side: Side) -> float | None:
        """m by which a foot is ahead of the other in one sample; None where an angle is not known."""
        if not batch.valid[NEEDED].all():
            return None
        posture = batch.position[row : row + 1, :DOFS]
        ankles = leg_motion(posture, np.zeros_like(posture), self._body).ankle[0, 0]
        lead = SIDES.index(side)
        return float(ankles[lead] - ankles[1 - lead])

    def remember(self, captured_ns: int, batch: Batch, row: int) -> None:
        """Take the newest instant."""
        ahead = self.ahead(batch, row, Side.LEFT)
        if ahead is not None:
            self._ahead.append((captured_ns, ahead))
        while self._ahead and self._ahead[0][0] < captured_ns - self._parameters.feet_memory_s * 1e9:
            del self._ahead[0]

    def missed_step(self, side: Side, lifted_ns: int) -> float:
        """m that the other foot went before this one was lifted for the first time; 0 where it stayed.

        A person's first step is often too small to be told as one. The foot that is lifted next still stands where it
        stood, so that step is what the other foot is ahead by now and was not while the person stood.
        """
        p = self._parameters
        now, before = (self._at(ns) for ns in (lifted_ns, lifted_ns - round(p.stood_before_s * 1e9)))
        if now is None or before is None:
            return 0.0
        went_m = (before - now) if side is Side.LEFT else (now - before)
        return went_m if went_m > p.least_missed_m else 0.0

    def _at(self, captured_ns: int) -> float | None:
        i = bisect_left(self._ahead, captured_ns, key=itemgetter(0))
        near = self._ahead[max(0, i - 1) : i + 1]
        within = [ahead for ns, ahead in near if abs(ns - captured_ns) < 2e8]
        return within[-1] if within else None

    def snapshot(self) -> State:
        """The last seconds."""
        return {"ahead": [list(each) for each in self._ahead]}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._ahead = [(ns, ahead) for ns, ahead in state["ahead"]]
