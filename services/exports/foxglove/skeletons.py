"""Which samples of a session are drawn, and where their joint centres and segments are."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from schemas.kinematics import JointCentres, JointState
from schemas.session import Anthropometry
from schemas.vocabulary import JointCentre
from services.exports.facts import freedoms_of
from services.exports.joint_positions import LEG_CENTRES, leg_poses, leg_track
from services.exports.motion import Array, Flags, Track
from services.exports.parameters import SKELETON_HZ

_TOGETHER = 256


class Skeleton(NamedTuple):
    """One instant: centres (m, 3) m with whether each is known; segments of a lower body, by name."""

    captured_ns: int
    names: tuple[JointCentre, ...]
    points: Array
    told: Flags
    segments: dict[str, tuple[Array, Array]]


class Thinned:
    """At most SKELETON_HZ instants of a second."""

    def __init__(self) -> None:
        self._next_ns: float = -np.inf

    def takes(self, captured_ns: int) -> bool:
        """True for the first sample of each thirtieth of a second."""
        if captured_ns < self._next_ns:
            return False
        # A third of a period early is in time, for a camera of that rate jitters.
        self._next_ns = captured_ns + 0.67e9 / SKELETON_HZ
        return True


class Skeletons:
    """Collects samples of a lower body, for many are posed at a time as quickly as one."""

    def __init__(self, anthropometry: Anthropometry) -> None:
        self._anthropometry = anthropometry
        self._thinned = Thinned()
        self._camera = False
        self._valid: list[bool] = []
        self._times: list[int] = []
        self._positions: list[list[float]] = []

    def take(self, payload: JointState | JointCentres) -> Iterator[Skeleton]:
        """Skeletons that are ready. Once a camera tells centres, angles are drawn no more."""
        if isinstance(payload, JointCentres):
            self._camera = True
            yield from self._seen(payload)
        elif payload.model == "lower_body" and not self._camera:
            if payload.valid != self._valid or len(self._times) >= _TOGETHER:
                yield from self.rest()
            self._valid = payload.valid
            for captured_ns, position in zip(payload.captured_ns, payload.position, strict=True):
                if self._thinned.takes(captured_ns):
                    self._times.append(captured_ns)
                    self._positions.append(position)

    def rest(self) -> Iterator[Skeleton]:
        """Those that were collected and not given yet."""
        if self._times:
            yield from _posed(self._times, np.array(self._positions), self._valid, self._anthropometry)
            self._times, self._positions = [], []

    def _seen(self, payload: JointCentres) -> Iterator[Skeleton]:
        for captured_ns, points in zip(payload.captured_ns, payload.position, strict=True):
            if self._thinned.takes(captured_ns):
                yield Skeleton(captured_ns, tuple(JointCentre), np.array(points), np.array(payload.seen), {})


def _posed(times: list[int], position: Array, valid: list[bool], anthropometry: Anthropometry) -> Iterator[Skeleton]:
    from services.biomech.bones import SEGMENTS
    from services.biomech.lower_body import LowerBodyModel

    names = [freedom.name for freedom in freedoms_of("lower_body")]
    told = frozenset(name for name, known in zip(names, valid, strict=True) if known)
    track = Track(np.array(times), position[..., None], np.tile(np.array(valid), (len(times), 1)))
    centres = leg_track(track, told, anthropometry)
    if not centres.valid[:, 1::3].any():
        return
    model = LowerBodyModel(anthropometry)
    rotation, origin = leg_poses(np.where(valid, position, 0.0), anthropometry)
    for i, captured_ns in enumerate(times):
        frames = {s.value: (rotation[i, j], origin[i, j]) for s in SEGMENTS for j in [model.last_joint(s)]}
        yield Skeleton(captured_ns, LEG_CENTRES, centres.value[i], centres.valid[i], frames)
