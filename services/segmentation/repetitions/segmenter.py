"""From joint angles to the repetitions of each knee that is seen."""

from schemas.kinematics import SegmentMotion
from schemas.signals import REPETITION
from schemas.tasks import Repetition
from schemas.vocabulary import Side
from services.flow.message import Output
from services.flow.node import State
from services.segmentation.batch import INDEX, Batch
from services.segmentation.repetitions.knee_watch import UNSEEN, KneeWatch
from services.segmentation.repetitions.movement_watch import MISSING
from services.segmentation.repetitions.parameters import RepetitionParameters
from services.segmentation.repetitions.trail import Sample

DEFAULTS = RepetitionParameters()
TILT = INDEX["pelvis_tilt"]


class RepetitionSegmenter:
    """Repetitions as they are completed, in order of time, the left knee first."""

    def __init__(self, parameters: RepetitionParameters = DEFAULTS) -> None:
        self._parameters = parameters
        self._knees = {side: KneeWatch(side, parameters) for side in Side}
        self._last_ns: dict[Side, int | None] = dict.fromkeys(Side)

    def take_motion(self, _motion: SegmentMotion | None) -> int:
        """Needs none; nothing is unusable."""
        return 0

    def take(self, batch: Batch) -> list[Output]:
        """The repetitions that these samples complete."""
        outputs: list[Output] = []
        for row, captured_ns in enumerate(batch.captured_ns.tolist()):
            for side, knee in self._knees.items():
                found = self._look(side, knee, batch, row, captured_ns)
                outputs += [Output(REPETITION, captured_ns, repetition) for repetition in found]
        return outputs

    def finish(self) -> list[Output]:
        """Those under way."""
        return [
            Output(REPETITION, self._last_ns[side] or 0, repetition)
            for side, knee in self._knees.items()
            for repetition in knee.finish()
        ]

    def _look(self, side: Side, knee: KneeWatch, batch: Batch, row: int, captured_ns: int) -> list[Repetition]:
        last_ns, at = self._last_ns[side], INDEX[f"knee_flexion_{side}"]
        if not batch.valid[at]:
            self._last_ns[side] = None
            return [] if last_ns is None else knee.interrupt(UNSEEN)
        late = last_ns is not None and captured_ns - last_ns > self._parameters.longest_gap_s * 1e9
        found = knee.interrupt(MISSING) if late else []
        self._last_ns[side] = captured_ns
        position = batch.position[row]
        # Positive pelvis tilt turns the front down, positive hip flexion the thigh up, both about the same axis.
        thigh = float(position[INDEX[f"hip_flexion_{side}"]] - position[TILT])
        rate, std = float(batch.velocity[row, at]), float(batch.position_std[row, at])
        return found + knee.take(Sample(captured_ns, float(position[at]), rate, std, thigh))

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "knees": {side.value: knee.snapshot() for side, knee in self._knees.items()},
            "last_ns": {side.value: last_ns for side, last_ns in self._last_ns.items()},
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._last_ns = {side: state["last_ns"][side.value] for side in Side}
        for side, knee in self._knees.items():
            knee.restore(state["knees"][side.value])
