"""Sources through the whole chain, and angles through the segmenter alone."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.gait import Stride
from schemas.imu import ReferenceBatch
from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.tasks import Repetition
from schemas.vocabulary import LOWER_BODY, Side, Task
from services.bench.gait.joint_walks import JointTrack
from services.bench.repetitions.exercises import Array
from services.cli.assembly import build_chain
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic.knee_flexion import SyntheticKnee
from services.segmentation.batch import INDEX
from services.segmentation.node import build
from services.segmentation.repetitions.knee_watch import KneeWatch
from services.segmentation.repetitions.movement_watch import MISSING
from services.segmentation.repetitions.parameters import RepetitionParameters
from services.segmentation.repetitions.trail import Sample


@dataclass
class Run:
    """What came out of a session, and the truth beside it."""

    repetitions: list[Repetition] = field(default_factory=list)
    rhythm: list[tuple[int, float, bool]] = field(default_factory=list)  # ns, rad, locked
    reference: list[tuple[int, list[float | None]]] = field(default_factory=list)
    channels: list[str] = field(default_factory=list)
    seen_from_ns: dict[Side, int] = field(default_factory=dict)
    """When each knee was valid for the first time."""

    def of(self, side: Side) -> list[Repetition]:
        """Those of one knee."""
        return [one for one in self.repetitions if one.side is side]

    def phase(self) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Time s, phase rad and lock of the rhythm."""
        table = np.array(self.rhythm, dtype=np.float64).reshape(-1, 3)
        return table[:, 0] / 1e9, table[:, 1], table[:, 2] > 0.5


def through_chain(spec: str, estimator: str | None = None) -> Run:
    """Run a source to its end as an exercise. Raises SourceError when it cannot be read."""
    source = open_source(spec, estimator=estimator, task=Task.KNEE_FLEXION)
    description = source.describe()
    chain = build_chain(description)
    run = Run(channels=[channel.name for channel in description.reference])
    for message in iter_messages(source):
        if isinstance(message.payload, ReferenceBatch):
            run.reference += zip(message.payload.captured_ns, message.payload.values, strict=True)
        for produced in chain.push(message):
            payload = produced.payload
            if isinstance(payload, Repetition):
                run.repetitions.append(payload)
            elif isinstance(payload, JointState) and payload.captured_ns:
                for side in Side:
                    if payload.valid[INDEX[f"knee_flexion_{side}"]]:
                        run.seen_from_ns.setdefault(side, payload.captured_ns[0])
            elif isinstance(payload, Rhythm):
                run.rhythm += zip(payload.captured_ns, payload.phase, payload.locked, strict=True)
    return run


def strides_of(spec: str) -> int:
    """How many strides the same source has as a walk. Raises SourceError when it cannot be read."""
    source = open_source(spec, task=Task.WALK)
    chain = build_chain(source.describe())
    messages = (message for message in iter_messages(source) if not isinstance(message.payload, ReferenceBatch))
    return sum(isinstance(produced.payload, Stride) for message in messages for produced in chain.push(message))


def of_exact_angles(session: SyntheticKnee) -> list[Repetition]:
    """What the segmenter makes of the true joint angles, of the knee that exercises."""
    time_s = np.arange(session.sample_count) / session.parameters.rate
    angles = session.gait.angles(session.strides(time_s))
    position = np.column_stack([angles[dof.name].value for dof in LOWER_BODY])
    velocity = np.column_stack([angles[dof.name].rate for dof in LOWER_BODY])
    track = JointTrack(time_s, position, velocity, np.full(len(time_s), np.nan))
    node = build(session.description())
    outputs = [output for message in track.messages() for output in node.step(message)] + node.finish()
    found = [output.payload for output in outputs if isinstance(output.payload, Repetition)]
    return [one for one in found if one.side is session.side]


def of_reference(run: Run, side: Side) -> list[Repetition]:
    """What the segmenter makes of a measured knee, whose thigh is not known, from when on the estimate is valid."""
    at = run.channels.index(f"knee_flexion_{side}")
    parameters = RepetitionParameters()
    knee, found = KneeWatch(side, parameters), list[Repetition]()
    last: tuple[int, float] | None = None
    for captured_ns, values in run.reference:
        angle = values[at]
        if angle is None or captured_ns < run.seen_from_ns.get(side, 0):
            continue
        if last is not None and captured_ns - last[0] > parameters.longest_gap_s * 1e9:
            found += knee.interrupt(MISSING)
            last = None
        rate = 0.0 if last is None else (angle - last[1]) / ((captured_ns - last[0]) / 1e9)
        found += knee.take(Sample(captured_ns, angle, rate, 0.0, 0.0))
        last = captured_ns, angle
    return found + knee.finish()
