"""Walks as joint states: what segmentation would see if the estimate were the truth."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import JointState
from schemas.payload import Payload
from schemas.rhythm import Rhythm
from schemas.session import SessionDescription
from schemas.signals import JOINT_STATE, RHYTHM
from schemas.vocabulary import LOWER_BODY, Side
from services.biomech.bones import SEGMENTS
from services.flow.message import Envelope, Message, Stream
from services.ingest.synthetic.gait import WalkingBody
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.walk import SyntheticWalk

Array = NDArray[np.float64]

JOINTS = Stream(JOINT_STATE, "estimation")
RHYTHMS = Stream(RHYTHM, "estimation")


@dataclass(frozen=True)
class JointTrack:
    """Joint coordinates over time; `phase` is NaN where the rhythm is not locked."""

    time_s: Array  # (n,)
    position: Array  # (n, 15) rad
    velocity: Array  # (n, 15) rad/s
    phase: Array  # (n,) rad
    position_std: float = 0.03  # rad

    def messages(self, batch: int = 5, valid: tuple[bool, ...] = (True,) * len(LOWER_BODY)) -> list[Message]:
        """joint_state and rhythm in turn, `batch` samples each."""
        found: list[Message] = []
        captured_ns = np.round(self.time_s * 1e9).astype(np.int64).tolist()
        for number, first in enumerate(range(0, len(captured_ns), batch)):
            span = slice(first, first + batch)
            envelope = Envelope(0, number, captured_ns[span][-1])
            found.append(Message(JOINTS, envelope, self._joints(captured_ns[span], span, valid)))
            found.append(Message(RHYTHMS, envelope, self._rhythm(captured_ns[span], span)))
        return found

    def _joints(self, captured_ns: list[int], span: slice, valid: tuple[bool, ...]) -> Payload:
        shape = (len(captured_ns), len(LOWER_BODY))
        return JointState(
            model="lower_body",
            captured_ns=captured_ns,
            position=self.position[span].tolist(),
            velocity=self.velocity[span].tolist(),
            acceleration=np.zeros(shape).tolist(),
            position_std=np.full(shape, self.position_std).tolist(),
            velocity_std=np.zeros(shape).tolist(),
            valid=list(valid),
            observed=list(SEGMENTS) if all(valid) else [],
        )

    def _rhythm(self, captured_ns: list[int], span: slice) -> Payload:
        locked = np.isfinite(self.phase[span])
        return Rhythm(
            captured_ns=captured_ns,
            phase=np.where(locked, self.phase[span], 0.0).tolist(),
            frequency=[0.0] * len(captured_ns),
            quality=locked.astype(float).tolist(),
            locked=locked.tolist(),
        )


@dataclass(frozen=True)
class JointWalk:
    """A synthetic walk as segmentation would see it, with its truth."""

    description: SessionDescription
    track: JointTrack
    body: WalkingBody

    def contacts_s(self, side: Side) -> Array:
        """Times of true initial contacts, s."""
        return self._edges(side, +1)

    def toe_offs_s(self, side: Side) -> Array:
        """Times of true toe-offs, s."""
        return self._edges(side, -1)

    def _edges(self, side: Side, sign: int) -> Array:
        found: Array = self.track.time_s[1:][np.diff(self.body.contact[side]) * sign > 0]
        return found


@lru_cache(maxsize=16)
def joint_walk(query: str) -> JointWalk:
    """The walk of `synthetic:walk?{query}`. The rhythm counts as locked from 3 s after the standing on."""
    parameters = WalkParameters.parse(query)
    walk = SyntheticWalk(parameters)
    time_s = np.arange(walk.sample_count) / parameters.rate
    body = walk.body(time_s)
    phase = 2 * np.pi * walk.strides(time_s).phase.value
    locked = time_s > parameters.standing + 3.0
    track = JointTrack(
        time_s,
        np.column_stack([body.angles[dof.name].value for dof in LOWER_BODY]),
        np.column_stack([body.angles[dof.name].rate for dof in LOWER_BODY]),
        np.where(locked, phase, np.nan),
    )
    return JointWalk(walk.description(), track, body)
