"""One knee: a movement whose thigh tells repetitions from steps and from changes of posture."""

from schemas.tasks import Repetition
from schemas.vocabulary import Side
from services.segmentation.repetitions.excursion import Closed
from services.segmentation.repetitions.movement_watch import ENDS_APART, Followed, MovementWatch
from services.segmentation.repetitions.parameters import RepetitionParameters
from services.segmentation.repetitions.shape import Shape

UNSEEN = "the knee was not seen for a while"
ENDED = "the session ended before the knee was back"
STEP = "a step: the thigh swung"
NOT_BACK = {
    Closed.OTHER_POSTURE: "the person sat down or stood up",
    Closed.FROM_A_HOLD: ENDS_APART,
    Closed.HELD: "the knee came to rest elsewhere",
    Closed.ENDLESS: "too slow to be a repetition",
}


class KneeWatch(MovementWatch):
    """Feed it the samples of one knee, each with its thigh's inclination."""

    def __init__(self, side: Side, parameters: RepetitionParameters) -> None:
        super().__init__(Followed(f"knee_flexion_{side}", side, NOT_BACK, ENDED), parameters)

    def _movement_flaw(self, _made: Repetition, shape: Shape, reach: float) -> str | None:
        p = self._parameters
        return STEP if abs(shape.thigh_swing) > max(p.step_floor, p.step_share * reach) else None
