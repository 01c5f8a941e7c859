"""Corridor walks as joint states: what segmentation would see if the estimate were the truth."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from schemas.kinematics import JointState
from schemas.session import SessionDescription
from schemas.vocabulary import LOWER_BODY
from services.bench.gait.joint_walks import JointTrack
from services.bench.walking_tests.sessions import truth_of
from services.flow.message import Message
from services.ingest.synthetic.corridor import SyntheticSixMinutes, SyntheticTenMetres

_NAMES = [dof.name for dof in LOWER_BODY]


@dataclass(frozen=True)
class JointCorridor:
    """A synthetic test as segmentation would see it, with its truth."""

    truth: SyntheticSixMinutes | SyntheticTenMetres
    description: SessionDescription
    track: JointTrack

    def messages(self, batch: int = 25) -> list[Message]:
        """joint_state and rhythm in turn, `batch` samples each. No rhythm is locked."""
        worn = [mount.description.segment for mount in self.truth.mounts]
        found: list[Message] = []
        for message in self.track.messages(batch):
            if isinstance(message.payload, JointState):
                payload = message.payload.model_copy(update={"observed": worn})
                found.append(Message(message.stream, message.envelope, payload))
            else:
                found.append(message)
        return found


@lru_cache(maxsize=16)
def joint_corridor(what: str) -> JointCorridor:
    """The session of `synthetic:{what}`."""
    truth = truth_of(f"synthetic:{what}")
    time_s = np.arange(truth.sample_count) / truth.parameters.rate
    body = truth.body(time_s)
    position = np.column_stack([body.angles[name].value for name in _NAMES])
    velocity = np.column_stack([body.angles[name].rate for name in _NAMES])
    track = JointTrack(time_s, position, velocity, np.full(len(time_s), np.nan))
    return JointCorridor(truth, truth.description(), track)
