"""One knee: its repetitions, and those that do not count with the reason."""

from statistics import median

from schemas.tasks import Repetition
from schemas.vocabulary import Side
from services.flow.node import State
from services.segmentation.repetitions.excursion import Closed, Excursion, ExcursionDetector, Point
from services.segmentation.repetitions.parameters import RepetitionParameters
from services.segmentation.repetitions.shape import Shape, shape_of
from services.segmentation.repetitions.trail import Sample, Trail

MISSING = "samples are missing"
SET_ANEW = "the angle was set anew"
UNSEEN = "the knee was not seen for a while"
ENDED = "the session ended before the knee was back"
SHORT = "too quick to be a repetition"
ENDS_APART = "it began or ended away from the resting side"
PARTIAL = "less than half of the usual range"
STEP = "a step: the thigh swung"
NOT_BACK = {
    Closed.OTHER_POSTURE: "the person sat down or stood up",
    Closed.FROM_A_HOLD: ENDS_APART,
    Closed.HELD: "the knee came to rest elsewhere",
    Closed.ENDLESS: "too slow to be a repetition",
}


class KneeWatch:
    """Feed it the samples of one knee in order of time, and what interrupts them."""

    def __init__(self, side: Side, parameters: RepetitionParameters) -> None:
        self._side = side
        self._parameters = parameters
        self._detector = ExcursionDetector(parameters)
        self._trail = Trail()
        self._ranges: list[float] = []
        self._count = 0

    def take(self, sample: Sample) -> list[Repetition]:
        """The repetitions that this sample closes."""
        p = self._parameters
        broken = self.interrupt(SET_ANEW) if self._has_jumped(sample) else []
        self._trail.append(sample)
        point = Point(sample.captured_ns, *self._trail.recent_mean(p.smoothing_s))
        excursion = self._detector.step(point, *self._least_ways())
        found = [] if excursion is None else [self._repetition(excursion, NOT_BACK.get(excursion.closed))]
        needed_ns = self._detector.needed_from_ns
        if needed_ns is not None:
            self._trail.forget_before(needed_ns - round(p.margin_s * 1e9))
        return broken + found

    def _has_jumped(self, sample: Sample) -> bool:
        """Whether the angle is further from the last one than its velocity takes it: the estimator changed its mind."""
        last = self._trail.newest
        if last is None:
            return False
        moved = max(abs(sample.rate), abs(last.rate)) * (sample.captured_ns - last.captured_ns) / 1e9
        return abs(sample.angle - last.angle) > moved + self._parameters.jump

    def interrupt(self, because: str) -> list[Repetition]:
        """What comes next does not belong to what came before.

        A repetition under way does not count; that of a knee that has come back, but not yet rested, does.
        """
        excursion = self._detector.break_off()
        found: list[Repetition] = []
        if excursion is not None:
            come_back = abs(excursion.farthest.angle - excursion.end.angle)
            is_back = come_back >= self._parameters.rested_share * excursion.way
            found = [self._repetition(excursion, None if is_back else because)]
        self._trail.clear()
        return found

    def finish(self) -> list[Repetition]:
        """The session has ended."""
        return self.interrupt(ENDED)

    def _least_ways(self) -> tuple[float, float]:
        p = self._parameters
        usual = self._usual_range()
        if usual is None:
            return p.turn_floor, p.turn_floor
        hysteresis = max(p.turn_floor, p.turn_share * usual)
        return hysteresis, max(hysteresis, p.partial_share * usual)

    def _usual_range(self) -> float | None:
        return median(self._ranges) if len(self._ranges) >= self._parameters.least_memory else None

    def _repetition(self, excursion: Excursion, because: str | None) -> Repetition:
        course = self._trail.course(self._parameters.smoothing_s)
        shape = shape_of(course, excursion, self._parameters)
        within = slice(shape.start, shape.end + 1)
        made = Repetition(
            degree_of_freedom=f"knee_flexion_{self._side}",
            side=self._side,
            index=self._count,
            start_ns=int(course.captured_ns[shape.start]),
            turn_ns=shape.turn_ns,
            end_ns=int(course.captured_ns[shape.end]),
            start_angle=float(course.angle[shape.start]),
            turn_angle=shape.turn_angle,
            end_angle=float(course.angle[shape.end]),
            angle_std=float(course.std[within].mean()),
            largest_velocity=float(abs(course.rate[within]).max()),
            hold_s=None,
            ranges={},
            valid=True,
            rejected_because=None,
        )
        because = because or self._flaw(made, shape)
        if because in (None, PARTIAL):
            self._ranges = [*self._ranges, range_of(made)][-self._parameters.memory :]
        self._count += 1
        return made if because is None else made.model_copy(update={"valid": False, "rejected_because": because})

    def _flaw(self, made: Repetition, shape: Shape) -> str | None:
        p = self._parameters
        usual, reach = self._usual_range(), range_of(made)
        if made.end_ns - made.start_ns < p.shortest_s * 1e9:
            return SHORT
        if abs(shape.thigh_swing) > max(p.step_floor, p.step_share * reach):
            return STEP
        if abs(made.start_angle - made.end_angle) > p.ends_share * reach:
            return ENDS_APART
        return PARTIAL if usual is not None and reach < p.partial_share * usual else None

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "detector": self._detector.snapshot(),
            "trail": self._trail.snapshot(),
            "ranges": list(self._ranges),
            "count": self._count,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._detector.restore(state["detector"])
        self._trail.restore(state["trail"])
        self._ranges = list(state["ranges"])
        self._count = state["count"]


def range_of(repetition: Repetition) -> float:
    """rad, the largest minus the smallest angle of a repetition."""
    angles = (repetition.start_angle, repetition.turn_angle, repetition.end_angle)
    return max(angles) - min(angles)
