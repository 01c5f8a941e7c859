"""Brings the streams of estimation together and hands them to the segmenters that the session's task needs."""

from typing import Protocol

from schemas.health import Rejection
from schemas.kinematics import JointCentres, JointState, SegmentMotion
from schemas.rhythm import Rhythm
from schemas.session import SessionDescription
from schemas.signals import GAIT_EVENT, REPETITION, STRIDE, TASK_PHASE, Signal
from schemas.vocabulary import Task
from services.biomech.event_sources import session_lone_segments, uses_camera
from services.flow.message import Message, Output, Stream
from services.flow.node import Node, State
from services.segmentation.batch import Batch
from services.segmentation.exercises.movements import FOLLOWED
from services.segmentation.exercises.segmenter import ExerciseSegmenter
from services.segmentation.gait.segmenter import GaitSegmenter
from services.segmentation.intake import CENTRES_FROM, JOINTS_FROM, MOTION_FROM, RHYTHM_FROM, Intake
from services.segmentation.pairing import Pairing, Together
from services.segmentation.parameters import SegmentationParameters
from services.segmentation.repetitions.segmenter import RepetitionSegmenter
from services.segmentation.timed_up_and_go.segmenter import TimedUpAndGoSegmenter
from services.segmentation.walking_tests.segmenter import WALKING_TESTS, WalkingTestSegmenter

DEFAULTS = SegmentationParameters()


class Segmenter(Protocol):
    """What one kind of segmentation offers the node. Samples come in order; how they were batched decides nothing."""

    def take_motion(self, motion: SegmentMotion | None) -> int:
        """The motion of lone segments at the samples that come next. Returns how many of its samples are unusable."""

    def take(self, batch: Batch) -> list[Output]:
        """What these samples lead to."""

    def finish(self) -> list[Output]:
        """What still waited."""

    def snapshot(self) -> State:
        """Everything that changes."""

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""


def segmenters(description: SessionDescription, parameters: SegmentationParameters) -> dict[str, Segmenter]:
    """Those that the task of a session needs, by name."""
    if description.task is Task.KNEE_FLEXION:
        # No gait beside it: a shank that is stretched out and drawn back looks like a swing.
        return {"repetitions": RepetitionSegmenter()}
    if description.task in FOLLOWED:
        return {"exercises": ExerciseSegmenter(description.task)}
    if description.task in WALKING_TESTS:
        return {"walking_test": WalkingTestSegmenter(description, parameters)}
    found: dict[str, Segmenter] = {"gait": GaitSegmenter(description, parameters)}
    if description.task is Task.TIMED_UP_AND_GO:
        found["timed_up_and_go"] = TimedUpAndGoSegmenter(description)
    return found


class SegmentationNode:
    """One session: what each segmenter finds, in the order of the segmenters."""

    outputs: tuple[Signal, ...] = (GAIT_EVENT, STRIDE, TASK_PHASE, REPETITION)

    def __init__(self, description: SessionDescription, parameters: SegmentationParameters = DEFAULTS) -> None:
        with_motion, with_centres = bool(session_lone_segments(description)), uses_camera(description)
        self.streams: tuple[Stream, ...] = (
            JOINTS_FROM, RHYTHM_FROM, *[MOTION_FROM] * with_motion, *[CENTRES_FROM] * with_centres
        )  # fmt: skip
        self._intake = Intake()
        self._pairing = Pairing(with_motion=with_motion, with_centres=with_centres)
        self._segmenters = segmenters(description, parameters)

    def step(self, message: Message) -> list[Output]:
        """Take a message of any of the streams."""
        payload = message.payload
        if isinstance(payload, JointState) and payload.captured_ns:
            complete = self._pairing.add_joints(payload)
        elif isinstance(payload, Rhythm) and payload.captured_ns:
            complete = self._pairing.add_rhythm(payload)
        elif isinstance(payload, SegmentMotion) and payload.captured_ns:
            complete = self._pairing.add_motion(payload)
        elif isinstance(payload, JointCentres) and payload.captured_ns:
            complete = self._pairing.add_centres(payload)
        else:
            return []
        return [output for together in complete for output in self._take(together)]

    def finish(self) -> list[Output]:
        """What still waited."""
        outputs = [output for together in self._pairing.flush() for output in self._take(together)]
        return outputs + [output for segmenter in self._segmenters.values() for output in segmenter.finish()]

    def _take(self, together: Together) -> list[Output]:
        refused = [segmenter.take_motion(together.motion) for segmenter in self._segmenters.values()]
        self._intake.refuse_motion(max(refused))
        batch = self._intake.take(together.joints, together.rhythm, together.centres)
        if batch is None:
            return []
        outputs = [output for segmenter in self._segmenters.values() for output in segmenter.take(batch)]
        # Each segmenter looks at the whole batch in turn; by time, their outputs mix as if samples came one by one.
        return sorted(outputs, key=lambda output: output.captured_ns)

    def rejections(self) -> list[Rejection]:
        """Samples that were not used."""
        return self._intake.rejections()

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "pairing": self._pairing.snapshot(),
            "intake": self._intake.snapshot(),
            "segmenters": {name: segmenter.snapshot() for name, segmenter in self._segmenters.items()},
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        self._pairing.restore(state["pairing"])
        self._intake.restore(state["intake"])
        for name, segmenter in self._segmenters.items():
            segmenter.restore(state["segmenters"][name])


def build(description: SessionDescription) -> Node:
    """The node with default parameters."""
    return SegmentationNode(description)
