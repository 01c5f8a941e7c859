"""One movement: its repetitions, and those that do not count with the reason."""

from collections.abc import Mapping
from dataclasses import dataclass
from statistics import median
from typing import Protocol

from schemas.tasks import Repetition
from schemas.vocabulary import Side
from services.flow.node import State
from services.segmentation.repetitions.excursion import Closed, Excursion, ExcursionDetector, Point
from services.segmentation.repetitions.parameters import RepetitionParameters
from services.segmentation.repetitions.shape import Shape, shape_of
from services.segmentation.repetitions.trail import Sample, Trail

MISSING = "samples are missing"
SET_ANEW = "the angle was set anew"
SHORT = "too quick to be a repetition"
ENDS_APART = "it began or ended away from the resting side"
PARTIAL = "less than half of the usual range"


class Witness(Protocol):
    """Who knows what the rest of the body did meanwhile."""

    def ranges(self, start_ns: int, end_ns: int) -> dict[str, float]:
        """rad, largest minus smallest angle of what was seen all the time."""

    def flaw(self, start_ns: int, end_ns: int, reach: float) -> str | None:
        """Why a movement by `reach`, rad, is none of the exercise; None when it is."""


@dataclass(frozen=True, slots=True)
class Followed:
    """What is followed, and how it is told why a repetition does not count.

    `sense` -1 follows the angle downwards: a repetition goes out where it becomes smaller.
    """

    movement: str
    side: Side | None
    because: Mapping[Closed, str]
    ended: str
    sense: int = 1


class MovementWatch:
    """Feed it the samples of one movement in order of time, in its sense, and what interrupts them.

    Up to a margin above a floor, rad, nothing is followed: whatever the angle does there, the movement is at home.
    """

    def __init__(self, followed: Followed, parameters: RepetitionParameters, witness: Witness | None = None) -> None:
        self._followed = followed
        self._parameters = parameters
        self._witness = witness
        self._detector = ExcursionDetector(parameters)
        self._trail = Trail()
        self._ranges: list[float] = []
        self._count = 0
        self._floor: float | None = None

    @property
    def is_away(self) -> bool:
        """Whether a movement is under way."""
        return self._detector.state.away is not None

    @property
    def needed_from_ns(self) -> int | None:
        """Samples before this time belong to nothing that is still open."""
        needed_ns = self._detector.needed_from_ns
        return None if needed_ns is None else needed_ns - round(self._parameters.margin_s * 1e9)

    def set_floor(self, floor: float) -> None:
        """Where the movement is at home from now on; what was known of home belongs to the old one."""
        if floor != self._floor:
            self._floor = floor
            self._detector.forget_home()

    def take(self, sample: Sample) -> list[Repetition]:
        """The repetitions that this sample closes."""
        p = self._parameters
        broken = self.interrupt(SET_ANEW) if self._has_jumped(sample) else []
        self._trail.append(sample)
        angle, thigh = self._trail.recent_mean(p.smoothing_s)
        point = Point(
            sample.captured_ns, angle if self._floor is None else max(angle, self._floor + p.floor_margin), thigh
        )
        excursion = self._detector.step(point, *self._least_ways())
        because = self._followed.because
        found = [] if excursion is None else [self._repetition(excursion, because.get(excursion.closed))]
        needed_ns = self.needed_from_ns
        if needed_ns is not None:
            self._trail.forget_before(needed_ns)
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

        A repetition under way does not count; that of a movement that has come back, but not yet rested, does.
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
        return self.interrupt(self._followed.ended)

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
        shape = shape_of(course, excursion, self._parameters, self._floor)
        within, sense = slice(shape.start, shape.end + 1), self._followed.sense
        start_ns, end_ns = int(course.captured_ns[shape.start]), int(course.captured_ns[shape.end])
        made = Repetition(
            degree_of_freedom=self._followed.movement,
            side=self._followed.side,
            index=self._count,
            start_ns=start_ns,
            turn_ns=shape.turn_ns,
            end_ns=end_ns,
            start_angle=sense * float(course.angle[shape.start]),
            turn_angle=sense * shape.turn_angle,
            end_angle=sense * float(course.angle[shape.end]),
            angle_std=float(course.std[within].mean()),
            largest_velocity=float(abs(course.rate[within]).max()),
            hold_s=shape.hold_s,
            ranges={} if self._witness is None else self._witness.ranges(start_ns, end_ns),
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
        other = self._movement_flaw(made, shape, reach)
        if other is not None:
            return other
        if abs(made.start_angle - made.end_angle) > p.ends_share * reach:
            return ENDS_APART
        return PARTIAL if usual is not None and reach < p.partial_share * usual else None

    def _movement_flaw(self, made: Repetition, _shape: Shape, reach: float) -> str | None:
        """What this kind of movement must not be."""
        return None if self._witness is None else self._witness.flaw(made.start_ns, made.end_ns, reach)

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "detector": self._detector.snapshot(),
            "trail": self._trail.snapshot(),
            "ranges": list(self._ranges),
            "count": self._count,
            "floor": self._floor,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._detector.restore(state["detector"])
        self._trail.restore(state["trail"])
        self._ranges = list(state["ranges"])
        self._count, self._floor = state["count"], state["floor"]


def range_of(repetition: Repetition) -> float:
    """rad, the largest minus the smallest angle of a repetition."""
    angles = (repetition.start_angle, repetition.turn_angle, repetition.end_angle)
    return max(angles) - min(angles)
