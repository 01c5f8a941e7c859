"""One session with inertial sensors and a depth camera: both estimators run, one body comes out."""

from collections.abc import Iterable

from schemas.health import Rejection
from schemas.kinematics import Calibration, JointCentres, JointState, LivePose, SegmentMotion
from schemas.payload import Payload
from schemas.quality import DataQuality
from schemas.rhythm import Rhythm
from schemas.session import SessionDescription
from schemas.signals import CALIBRATION, IMU, JOINT_CENTRES, JOINT_STATE, LIVE_POSE, RHYTHM, SEGMENT_MOTION
from schemas.standing import StandingMark
from services.estimation.body.node import BodyNode
from services.estimation.estimates import OUTPUTS
from services.estimation.fusion.fuser import Fuser
from services.estimation.fusion.merge import MessageMerge
from services.estimation.fusion.picture import FusedPicture, joined_calibration
from services.estimation.fusion.quality import FusedQuality
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.parameters import EstimationParameters
from services.flow.message import Message, Output, Stream
from services.flow.node import State

LATENESS_NS = 100_000_000
"""How long either source is waited for; a depth camera is 60 to 90 ms behind what it sees."""
BESIDE_JOINTS = (RHYTHM, SEGMENT_MOTION)
"""Sent with the joint states of whichever estimator leads."""


class FusionNode:
    """The inertial estimator leads while it speaks, the camera's otherwise; what they say of each other is learned.

    Messages of both are taken in the order of captured time. An operator's mark is told to both.
    """

    outputs = OUTPUTS

    def __init__(self, description: SessionDescription) -> None:
        alone = {"hubs": description.hubs, "cameras": [], "estimator": "rhythmic_ekf"}
        self._inertial = LowerBodyNode(description.model_copy(update=alone))
        seen = {"hubs": [], "cameras": description.cameras, "estimator": "body_cekf"}
        self._camera = BodyNode(description.model_copy(update=seen))
        self._merge = MessageMerge((*self._inertial.streams, *self._camera.streams), LATENESS_NS)
        self._fuser = Fuser()
        self._picture = FusedPicture(description)
        self._quality = FusedQuality(EstimationParameters().quality)
        self._calibrations: dict[str, Calibration] = {}
        self._untold: dict[str, list[StandingMark]] = {"inertial": [], "camera": []}

    @property
    def streams(self) -> tuple[Stream, ...]:
        """One per hub and per camera."""
        return (*self._inertial.streams, *self._camera.streams)

    def step(self, message: Message) -> list[Output]:
        """Take one message of any sensor."""
        return [output for ready in self._merge.accept(message) for output in self._take(ready)]

    def finish(self) -> list[Output]:
        """Take what waited."""
        outputs = [output for ready in self._merge.finish() for output in self._take(ready)]
        outputs += self._heard("inertial", self._inertial.finish())
        outputs += self._heard("camera", self._camera.finish())
        return outputs + self._quality.finish()

    def rejections(self) -> list[Rejection]:
        """Of both."""
        return self._inertial.rejections() + self._camera.rejections()

    def _take(self, message: Message) -> list[Output]:
        if message.stream.signal is IMU:
            return self._heard("inertial", self._inertial.step(self._marked(message, "inertial", "camera")))
        return self._heard("camera", self._camera.step(self._marked(message, "camera", "inertial")))

    def _marked(self, message: Message, to: str, other: str) -> Message:
        """With the marks that came with the other source's messages."""
        marks = getattr(message.payload, "marks", [])
        self._untold[other] += marks
        if not self._untold[to] or message.payload is None:
            return message
        given, self._untold[to] = self._untold[to], []
        payload = message.payload.model_copy(update={"marks": [*marks, *given]})
        return Message(message.stream, message.envelope, payload)

    def _heard(self, source: str, told: Iterable[Output]) -> list[Output]:
        """What an estimator put out, fused with what the other one says."""
        take = {"inertial": self._fuser.take_inertial, "camera": self._fuser.take_camera}[source]
        outputs: list[Output] = []
        told = list(told)
        rhythms = {tuple(each.payload.captured_ns): each.payload for each in told if isinstance(each.payload, Rhythm)}
        leads, before_ns, heard = False, self._fuser.last_ns, 0
        for output in told:
            payload = output.payload
            if isinstance(payload, JointState):
                before_ns = self._fuser.last_ns
                fused = take(payload, rhythms.get(tuple(payload.captured_ns)))
                leads = fused is not None
                outputs += self._fused(fused)
            elif isinstance(payload, JointCentres):
                self._picture.place(payload)
            elif isinstance(payload, DataQuality):
                self._quality.hear(outputs[heard:])
                heard = len(outputs)
                outputs += self._quality.take(source, payload)
            elif output.signal in BESIDE_JOINTS:
                outputs += [Output(output.signal, output.captured_ns, _since(payload, before_ns))] if leads else []
            else:
                outputs += self._beside(source, output)
        self._quality.hear(outputs[heard:])
        return outputs

    def _fused(self, joints: JointState | None) -> list[Output]:
        if joints is None:
            return []
        newest_ns = joints.captured_ns[-1]
        centres = self._picture.centres(joints)
        outputs = [Output(JOINT_STATE, newest_ns, joints), Output(JOINT_CENTRES, newest_ns, centres)]
        pose = self._picture.drawn(joints, centres)
        return outputs if pose is None else [*outputs, Output(LIVE_POSE, newest_ns, pose)]

    def _beside(self, source: str, output: Output) -> list[Output]:
        """What is neither fused nor sent with the joint states of one of them alone."""
        payload = output.payload
        if isinstance(payload, LivePose):
            waiting = self._picture.hear(source, payload)
            return [] if waiting is None else [Output(LIVE_POSE, output.captured_ns, waiting)]
        if isinstance(payload, Calibration):
            self._calibrations[source] = payload
            if source == "camera":
                self._picture.lengths = payload.lengths
            return [Output(CALIBRATION, output.captured_ns, joined_calibration(self._calibrations))]
        # The learned rhythm of whoever knows it better.
        return [output] if source == "inertial" or "inertial" not in self._calibrations else []

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "inertial": self._inertial.snapshot(),
            "camera": self._camera.snapshot(),
            "merge": self._merge.snapshot(),
            "fuser": self._fuser.snapshot(),
            "picture": self._picture.snapshot(),
            "calibrations": {name: each.model_dump(mode="json") for name, each in self._calibrations.items()},
            "quality": self._quality.snapshot(),
            "untold": {to: [mark.model_dump() for mark in marks] for to, marks in self._untold.items()},
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`, for a node built from the same description."""
        self._inertial.restore(state["inertial"])
        self._camera.restore(state["camera"])
        self._merge.restore(state["merge"])
        self._fuser.restore(state["fuser"])
        self._picture.restore(state["picture"])
        self._quality.restore(state["quality"])
        self._calibrations = {name: Calibration.model_validate(e) for name, e in state["calibrations"].items()}
        self._untold = {
            to: [StandingMark.model_validate(mark) for mark in marks] for to, marks in state["untold"].items()
        }


def _since(payload: Payload, after_ns: int) -> Payload:
    """The samples of a message later than a time; those before have been told by the other source."""
    assert isinstance(payload, Rhythm | SegmentMotion)
    times = payload.captured_ns
    first = next((k for k, captured_ns in enumerate(times) if captured_ns > after_ns), len(times))
    if first == 0:
        return payload
    if isinstance(payload, SegmentMotion):
        return payload.model_copy(update={"captured_ns": times[first:]})
    return Rhythm(
        captured_ns=times[first:],
        phase=payload.phase[first:],
        frequency=payload.frequency[first:],
        quality=payload.quality[first:],
        locked=payload.locked[first:],
    )
