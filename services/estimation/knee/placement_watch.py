"""Sensors worn otherwise than declared, named when the motion has shown it again and again.

Every half second in which the leg moves is a look; what a look shows clearly is a vote for or against. How sensors are
worn does not change with the posture, so a misplacement is named after `votes` votes for it with next to none against
in the last minute or so of motion: a raised leg looks like a swap, but not for long enough. It is withdrawn once more
speaks against it than for it. Where upward axes are declared, a leg that points up (swapped sensors, both upside down)
counts as nothing.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.session import Placement, SensorDescription
from schemas.vocabulary import Misplacement, Side
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters
from services.biomech.two_sensor_knee.placement import CLEAR_M, CLEAR_SHARE, leg_worn_on
from services.estimation.knee.estimator import Evidence
from services.estimation.knee.mounting import upward
from services.estimation.parameters import KneeParameters
from services.flow.node import State

Array = NDArray[np.float64]

SHORTEST_ARM = KneeAxisParameters().shortest_arm
"""m. Shorter arms were not seen well."""
UPSIDE_DOWN = (Misplacement.THIGH_UPSIDE_DOWN, Misplacement.SHANK_UPSIDE_DOWN)
WATCHED = (Misplacement.SWAPPED, *UPSIDE_DOWN, Misplacement.OTHER_LEG)


class PlacementWatch:
    """Of one leg; sensors thigh first."""

    def __init__(self, side: Side, sensors: Sequence[SensorDescription], parameters: KneeParameters) -> None:
        self._side = side
        self._parameters = parameters
        self._upward = [upward(sensor) for sensor in sensors]
        self._outward = [_outward(sensor) for sensor in sensors]
        self._for, self._against = dict.fromkeys(WATCHED, 0.0), dict.fromkeys(WATCHED, 0.0)
        self._seen: list[Misplacement] = []
        self._waited_s = 0.0
        self._has_moved = False

    @property
    def found(self) -> list[Misplacement]:
        """What is named, in the order of the vocabulary."""
        return list(self._seen)

    @property
    def suspects_swap(self) -> bool:
        """More looks have shown swapped sensors than the contrary."""
        return self._for[Misplacement.SWAPPED] > self._against[Misplacement.SWAPPED]

    def is_due(self, rate: float, dt_s: float) -> bool:
        """Whether this sample, dt_s after the one before, ends an interval in which the leg turned fast enough."""
        self._has_moved = self._has_moved or rate > self._parameters.moving_rate
        self._waited_s += dt_s
        if self._waited_s < self._parameters.look_s or not self._has_moved:
            return False
        self._waited_s, self._has_moved = 0.0, False
        return True

    def look(self, evidence: Evidence) -> None:
        """Take what the estimator knows now."""
        p = self._parameters
        kept = 1.0 - 1.0 / p.votes_remembered
        for kind, vote in self._shown(evidence).items():
            if vote == 0:
                continue
            self._for[kind] = kept * self._for[kind] + (vote > 0)
            self._against[kind] = kept * self._against[kind] + (vote < 0)
            # Half a vote less: the first ones are a little forgotten.
            is_shown = self._for[kind] >= p.votes - 0.5
            if is_shown and self._against[kind] <= p.contrary_votes * self._for[kind] and kind not in self._seen:
                self._seen = [each for each in WATCHED if each in (*self._seen, kind)]
            elif self._against[kind] > self._for[kind] and kind in self._seen:
                self._seen.remove(kind)

    def _shown(self, evidence: Evidence) -> dict[Misplacement, int]:
        """+1 shown, -1 shown not to be, 0 unclear."""
        swapped = _swap_vote(evidence)
        turned = [_turn_vote(up, wanted) for up, wanted in zip(evidence.up, self._upward, strict=True)]
        if swapped > 0 and all(vote > 0 for vote in turned):
            return {}
        shown = {Misplacement.SWAPPED: swapped, **dict(zip(UPSIDE_DOWN, turned, strict=True))}
        if swapped < 0:
            shown[Misplacement.OTHER_LEG] = self._leg_vote(evidence)
        return shown

    def _leg_vote(self, evidence: Evidence) -> int:
        if evidence.axes is None:
            return 0
        pairs = zip(evidence.axes, self._outward, strict=True)
        legs = {leg_worn_on(axis, outward) for axis, outward in pairs if outward is not None} - {None}
        if len(legs) != 1:
            return 0
        return -1 if self._side in legs else 1

    def snapshot(self) -> State:
        """Votes, and the interval under way."""
        return {
            "votes": [[self._for[kind], self._against[kind]] for kind in WATCHED],
            "seen": [kind.value for kind in self._seen],
            "waited_s": self._waited_s,
            "has_moved": self._has_moved,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._for = {kind: votes[0] for kind, votes in zip(WATCHED, state["votes"], strict=True)}
        self._against = {kind: votes[1] for kind, votes in zip(WATCHED, state["votes"], strict=True)}
        self._seen = [Misplacement(kind) for kind in state["seen"]]
        self._waited_s, self._has_moved = state["waited_s"], state["has_moved"]


def _swap_vote(evidence: Evidence) -> int:
    """The knee lies below the thigh's sensor and above the shank's. The arm of a segment that rests stays unknown, and
    short: then the other decides."""
    if evidence.arms is None:
        return 0
    above = np.sum(evidence.arms * evidence.up, axis=1) * [1.0, -1.0]
    long = np.linalg.norm(evidence.arms, axis=1) >= SHORTEST_ARM
    votes = {int(np.sign(each)) if abs(each) > CLEAR_M else 0 for each in above[long]}
    return votes.pop() if len(votes) == 1 else 0


def _turn_vote(up: Array, wanted: Array | None) -> int:
    if wanted is None:
        return 0
    share = float(up @ wanted)
    if abs(share) < CLEAR_SHARE:
        return 0
    return 1 if share < 0.0 else -1


def _outward(sensor: SensorDescription) -> Array | None:
    """Out of the outer side of the leg; None for a sensor that is not worn on a side."""
    outward = np.array(sensor.outward_axis, dtype=np.float64)
    if sensor.placement is Placement.LATERAL:
        return outward
    return -outward if sensor.placement is Placement.MEDIAL else None
