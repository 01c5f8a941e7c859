"""Timed up and go as joint states: what segmentation would see if the estimate were the truth."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import JointState, SegmentMotion, SegmentSamples
from schemas.session import SessionDescription
from schemas.signals import SEGMENT_MOTION
from schemas.vocabulary import LOWER_BODY, Segment, Side
from services.bench.gait.joint_walks import JOINTS, JointTrack
from services.flow.message import Message, Stream
from services.ingest.synthetic.gait import WalkingBody
from services.ingest.synthetic.parameters import TugParameters
from services.ingest.synthetic.rigid import rotation_about
from services.ingest.synthetic.tug import SyntheticTug
from services.ingest.synthetic.tug_plan import TruePhase

Array = NDArray[np.float64]

MOTIONS = Stream(SEGMENT_MOTION, "estimation")
_LEGS = {1: Side.LEFT, 2: Side.RIGHT}
_NAMES = [dof.name for dof in LOWER_BODY]


@dataclass(frozen=True)
class JointTug:
    """A synthetic test as segmentation would see it, with its truth."""

    description: SessionDescription
    phases: tuple[TruePhase, ...]
    time_s: Array
    position: Array  # (n, 15) rad
    velocity: Array  # (n, 15) rad/s
    valid: tuple[bool, ...]
    observed: list[Segment]
    pelvis: tuple[Array, Array] | None  # (n, 3) m/s^2 and rad/s in the heading frame, where it alone is worn

    def messages(self, batch: int = 5) -> list[Message]:
        """joint_state, rhythm and, for a lone pelvis, its motion in turn, `batch` samples each. No rhythm is locked."""
        track = JointTrack(self.time_s, self.position, self.velocity, np.full(len(self.time_s), np.nan))
        found: list[Message] = []
        first = 0
        for message in track.messages(batch, self.valid):
            if isinstance(message.payload, JointState):
                payload = message.payload.model_copy(update={"observed": self.observed})
                found.append(Message(JOINTS, message.envelope, payload))
                count = len(payload.captured_ns)
                if self.pelvis is not None:
                    motion = self._motion(payload.captured_ns, slice(first, first + count), self.pelvis)
                    found.append(Message(MOTIONS, message.envelope, motion))
                first += count
            else:
                found.append(message)
        return found

    @staticmethod
    def _motion(captured_ns: list[int], span: slice, pelvis: tuple[Array, Array]) -> SegmentMotion:
        acceleration, rate = pelvis
        samples = SegmentSamples(
            segment=Segment.PELVIS,
            captured_ns=captured_ns,
            acceleration=acceleration[span].tolist(),
            angular_velocity=rate[span].tolist(),
        )
        return SegmentMotion(captured_ns=captured_ns, segments=[samples])


@lru_cache(maxsize=16)
def joint_tug(query: str) -> JointTug:
    """The session of `synthetic:tug?{query}`, seen as its sensors would let it be seen."""
    session = SyntheticTug(TugParameters.parse(query))
    time_s = np.arange(session.sample_count) / session.parameters.rate
    body = session.body(time_s)
    position = np.column_stack([body.angles[name].value for name in _NAMES])
    velocity = np.column_stack([body.angles[name].rate for name in _NAMES])
    worn = session.parameters.worn
    valid, observed, pelvis = (
        (True,) * len(_NAMES),
        [Segment(mount.description.segment) for mount in session.mounts],
        None,
    )
    if worn in _LEGS:
        valid = tuple(name == f"knee_flexion_{_LEGS[worn]}" for name in _NAMES)
        position, velocity = (_of_one_leg(table, _LEGS[worn]) for table in (position, velocity))
    elif worn:
        valid = tuple(name.startswith("pelvis") for name in _NAMES)
        pelvis = _in_heading(body, position[:, 0])
        position, velocity = (table * np.array(valid) for table in (position, velocity))
    return JointTug(session.description(), session.phases, time_s, position, velocity, valid, observed, pelvis)


def _of_one_leg(table: Array, side: Side) -> Array:
    """The pelvis upright, the thigh's inclination in the hip: how a session of one leg tells it."""
    made = np.zeros_like(table)
    tilt, rotation = _NAMES.index("pelvis_tilt"), _NAMES.index("pelvis_rotation")
    hip, knee = _NAMES.index(f"hip_flexion_{side}"), _NAMES.index(f"knee_flexion_{side}")
    made[:, rotation], made[:, knee] = table[:, rotation], table[:, knee]
    made[:, hip] = table[:, hip] - table[:, tilt]
    return made


def _in_heading(body: WalkingBody, heading: Array) -> tuple[Array, Array]:
    R_world_from_heading = rotation_about((0.0, 1.0, 0.0), heading)
    pelvis = body.segments[Segment.PELVIS]
    vectors = (pelvis.origin.acceleration, pelvis.angular_velocity)
    acceleration, rate = (np.einsum("nji,nj->ni", R_world_from_heading, vector) for vector in vectors)
    return np.asarray(acceleration), np.asarray(rate)
