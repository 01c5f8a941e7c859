"""Pieces of a simulated session, and what every simulated session can do."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from schemas.session import SessionDescription
from schemas.vocabulary import SkeletonJoint
from services.ingest.skeleton import RoomFrames
from services.ingest.tracks import ImuTrack, ReferenceTrack, SkeletonTrack


class SeenFrames(NamedTuple):
    """n frames of one camera, joints in the order of its description."""

    captured_ns: NDArray[np.int64]  # (n,) increasing
    body: NDArray[np.int64]  # (n,) number of the body that is followed, 0 for nobody
    people: NDArray[np.int64]  # (n,)
    position: NDArray[np.float64]  # (n, joints, 3) m, room; NaN where not tracked
    state: NDArray[np.int64]  # (n, joints) 0 not tracked, 1 inferred, 2 tracked

    def track(self, joints: Sequence[SkeletonJoint]) -> SkeletonTrack:
        """As every driver has it."""
        frames = RoomFrames(tuple(joints), self.position, self.state, 0, 0)
        return SkeletonTrack(
            self.captured_ns, [body or None for body in self.body.tolist()], self.people.tolist(), frames
        )

    def between(self, from_ns: int, to_ns: int) -> "SeenFrames":
        """Frames from the first instant on and before the second."""
        first, last = np.searchsorted(self.captured_ns, [from_ns, to_ns])
        part = slice(int(first), int(last))
        return SeenFrames(
            self.captured_ns[part], self.body[part], self.people[part], self.position[part], self.state[part]
        )


@dataclass(frozen=True)
class Block:
    """Consecutive samples of every sensor in the order of the description, and the truth of the same time."""

    sensors: list[ImuTrack]
    reference: ReferenceTrack
    skeleton: SeenFrames | None = None


class SimulatedSession(Protocol):
    """A person who does something. Deterministic: the same session, however often it is made."""

    reference_hz: float
    """Of the truth, and of the hub if there is one."""

    def description(self, session: str = "synthetic", started_unix_ns: int = 0) -> SessionDescription:
        """The session as it would be served live."""

    def samples(self) -> Iterator[Block]:
        """The session from its first sample to its last."""
