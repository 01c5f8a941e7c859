"""Rows and joint centres as messages: one of each for a run of frames in which the same is seen."""

from schemas.kinematics import JointCentres
from schemas.signals import JOINT_CENTRES
from services.estimation.body.coordinates import MODEL
from services.estimation.body.tracker import Posture
from services.estimation.body.visibility import observed_segments
from services.estimation.estimates import estimates
from services.estimation.rows import Row
from services.flow.message import Output

LONGEST_RUN = 50
"""Rows of one message at most: a start has all that was kept."""


class Run:
    """Of one skeleton message."""

    def __init__(self) -> None:
        self.outputs: list[Output] = []
        self.learned: list[Output] = []
        self.last: Row | None = None
        self.valid: list[bool] = []
        self.posture: Posture | None = None
        self._rows: list[Row] = []
        self._postures: list[Posture] = []
        self._heard = 0

    def add(self, row: Row, valid: list[bool], posture: Posture) -> None:
        """Take the next row."""
        changed = self.posture is not None and (valid != self.valid or posture.seen != self.posture.seen)
        if self._rows and (changed or len(self._rows) >= LONGEST_RUN):
            self.close()
        self._rows.append(row)
        self._postures.append(posture)
        self.last, self.valid, self.posture = row, valid, posture

    def close(self) -> None:
        """What comes next is not to be in one message with what was before."""
        if not self._rows:
            return
        assert self.posture is not None
        seen = self.posture.seen
        self.outputs += estimates(self._rows, self.valid, observed_segments(seen), MODEL)
        centres = JointCentres(
            captured_ns=[posture.captured_ns for posture in self._postures],
            position=[posture.centres.tolist() for posture in self._postures],
            seen=seen,
        )
        self.outputs.append(Output(JOINT_CENTRES, self._rows[-1].captured_ns, centres))
        self._rows, self._postures = [], []

    def unheard(self) -> list[Output]:
        """The messages since this was asked last."""
        heard, self._heard = self._heard, len(self.outputs)
        return self.outputs[heard:]

    def finish(self) -> list[Output]:
        """All messages, and what was learned after them."""
        self.close()
        return self.outputs + self.learned
