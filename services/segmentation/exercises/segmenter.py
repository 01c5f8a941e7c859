"""From joint coordinates of the whole body to the repetitions of a task."""

from schemas.kinematics import SegmentMotion
from schemas.signals import REPETITION
from schemas.tasks import Repetition
from schemas.vocabulary import Side, Task
from services.flow.message import Output
from services.flow.node import State
from services.segmentation.batch import Batch
from services.segmentation.exercises.body_trail import BodyTrail
from services.segmentation.exercises.movements import FOLLOWED, Course, Movement
from services.segmentation.exercises.parameters import ExerciseParameters
from services.segmentation.exercises.upright import Upright
from services.segmentation.repetitions.excursion import Closed
from services.segmentation.repetitions.movement_watch import ENDS_APART, Followed, MovementWatch
from services.segmentation.repetitions.trail import Sample

DEFAULTS = ExerciseParameters()

UNSEEN = "the person was out of view for a while"
MISSING = "samples are missing"
ENDED = "the session ended before the movement was over"
NOT_BACK = {
    Closed.OTHER_POSTURE: ENDS_APART,
    Closed.FROM_A_HOLD: ENDS_APART,
    Closed.HELD: "the person came to rest elsewhere",
    Closed.ENDLESS: "too slow to be a repetition",
}


class ExerciseSegmenter:
    """Repetitions as they are completed, in order of time, those to the left first.

    An angle that is not valid for a moment is followed as it is estimated meanwhile.
    """

    def __init__(self, task: Task, parameters: ExerciseParameters = DEFAULTS) -> None:
        self._parameters = parameters
        self._body = BodyTrail(task, parameters)
        self._movements = FOLLOWED[task]
        self._followed = tuple(dict.fromkeys(movement for movement, _ in self._movements))
        self._watches = [self._watch(task, movement, side) for movement, side in self._movements]
        self._upright = Upright(parameters) if task is Task.TRUNK_TILT_FRONTAL else None
        self._last_ns: list[int | None] = [None] * len(self._watches)
        self._valid_ns: list[int | None] = [None] * len(self._watches)
        self._newest_ns = 0

    def _watch(self, task: Task, movement: Movement, side: Side | None) -> MovementWatch:
        leans_left = task is Task.TRUNK_TILT_FRONTAL and side is Side.LEFT
        followed = Followed(movement.name, side, NOT_BACK, ENDED, -1 if leans_left else 1)
        return MovementWatch(followed, self._parameters.repetitions_of(task), self._body)

    def take_motion(self, _motion: SegmentMotion | None) -> int:
        """Needs none; nothing is unusable."""
        return 0

    def take(self, batch: Batch) -> list[Output]:
        """The repetitions that these samples complete."""
        self._body.append(batch)
        of_movement = {movement.name: movement.course(batch) for movement in self._followed}
        courses = [of_movement[movement.name] for movement, _ in self._movements]
        outputs: list[Output] = []
        for row, captured_ns in enumerate(batch.captured_ns.tolist()):
            self._newest_ns = captured_ns
            self._stand_upright(courses[0], row)
            for k, course in enumerate(courses):
                found = self._look(k, course, row, captured_ns)
                outputs += [Output(REPETITION, captured_ns, repetition) for repetition in found]
            self._forget(captured_ns)
        return outputs

    def finish(self) -> list[Output]:
        """Those under way."""
        return [Output(REPETITION, self._newest_ns, found) for watch in self._watches for found in watch.finish()]

    def _look(self, k: int, course: Course | None, row: int, captured_ns: int) -> list[Repetition]:
        if course is None:
            return []
        watch, because = self._watches[k], self._interruption(k, captured_ns)
        found = [] if because is None else watch.interrupt(because)
        if because is not None:
            self._valid_ns[k] = None
        if course.is_valid:
            self._valid_ns[k] = captured_ns
        self._last_ns[k] = captured_ns
        if self._valid_ns[k] is None:
            return found
        sense = -1.0 if self._is_to_the_left(k) else 1.0
        angle, rate, std = (float(values[row]) for values in (course.angle, course.rate, course.std))
        return found + watch.take(Sample(captured_ns, sense * angle, sense * rate, std, 0.0))

    def _interruption(self, k: int, captured_ns: int) -> str | None:
        """Why this sample does not go on from the last one."""
        p, last_ns, valid_ns = self._parameters, self._last_ns[k], self._valid_ns[k]
        if last_ns is None or valid_ns is None:
            return None
        if captured_ns - last_ns > p.longest_gap_s * 1e9:
            return MISSING
        return UNSEEN if captured_ns - valid_ns > p.longest_unseen_s * 1e9 else None

    def _is_to_the_left(self, k: int) -> bool:
        return self._upright is not None and self._movements[k][1] is Side.LEFT

    def _stand_upright(self, course: Course | None, row: int) -> None:
        """Where both leans begin; it stays while either is under way."""
        if self._upright is None:
            return
        if course is None or not course.is_valid or any(watch.is_away for watch in self._watches):
            self._upright.interrupt()
        else:
            self._upright.take(self._newest_ns, float(course.angle[row]))
        for k, watch in enumerate(self._watches):
            watch.set_floor(-self._upright.lean if self._is_to_the_left(k) else self._upright.lean)

    def _forget(self, captured_ns: int) -> None:
        needed = [watch.needed_from_ns for watch in self._watches]
        self._body.forget_before(min(captured_ns if ns is None else ns for ns in needed))

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "body": self._body.snapshot(),
            "watches": [watch.snapshot() for watch in self._watches],
            "upright": None if self._upright is None else self._upright.snapshot(),
            "last_ns": list(self._last_ns),
            "valid_ns": list(self._valid_ns),
            "newest_ns": self._newest_ns,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._body.restore(state["body"])
        for watch, kept in zip(self._watches, state["watches"], strict=True):
            watch.restore(kept)
        if self._upright is not None:
            self._upright.restore(state["upright"])
        self._last_ns, self._valid_ns = list(state["last_ns"]), list(state["valid_ns"])
        self._newest_ns = state["newest_ns"]
