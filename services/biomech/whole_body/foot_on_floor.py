"""Ankle dorsiflexion without a view of the foot: while a foot stands flat, the floor is its sole (Colombel et al. name
this as future work).

A foot is flat while its ankle is as high as it was in standing, and still. Then the foot points where it pointed, and
dorsiflexion is the shank's inclination in the foot's sagittal plane: 0 where shank and sole are at a right angle.
"""

from dataclasses import dataclass
from math import hypot, radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre, Side
from services.biomech.whole_body.model import CENTRE_NAMES, DOF
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

SIDES = (Side.RIGHT, Side.LEFT)
ANKLE_PLACES, KNEE_PLACES = (
    [CENTRE_NAMES.index(JointCentre(f"{joint}_{side}")) for side in SIDES] for joint in ("ankle", "knee")
)
SHANKS = [DOF[f"knee_flexion_{side}"] for side in SIDES]
"""Joint behind which a shank lies."""


@dataclass(frozen=True)
class FloorParameters:
    """When a foot is flat. Chosen on the simulated people that tune."""

    standing_s: float = 0.8  # s from a standing start on over which heights and directions are averaged
    near_m: float = 0.06  # from the standing height
    slow: float = 0.35  # m/s of the ankle
    smoothing_s: float = 0.15  # s, time constant of the low-pass over ankles before they are judged
    longest_step_s: float = 0.25  # s between frames; after more the ankles are looked at anew
    still_s: float = 0.15  # s for which both must hold
    ankle_height_m: float = 0.09  # of the joint centre over the floor, where only the camera's floor is known
    std: float = radians(4.0)  # rad of a shank's inclination between two centres
    direction_std: float = radians(12.0)  # rad; axial rotation of a straight leg is hardly seen
    largest: float = radians(55.0)  # rad either way; beyond, the foot is not flat


class Dorsiflexion(NamedTuple):
    """Right and left."""

    angle: Array  # (2,) rad
    std: Array  # (2,) rad
    valid: Flags  # (2,)


class FlatFeet:
    """Of one person. `floor_m` is the floor's height in the room where the camera knows it."""

    def __init__(self, floor_m: float | None, parameters: FloorParameters = FloorParameters()) -> None:
        self._parameters, self._floor_m = parameters, floor_m
        self.begin(standing=False)

    def begin(self, *, standing: bool) -> None:
        """A new start of the filter: from a standing posture, which tells heights and directions, or from any."""
        self._learn_s = self._parameters.standing_s if standing else 0.0
        self._learnt = 0
        self._height: Array | None = None
        if not standing and self._floor_m is not None:
            self._height = np.full(2, self._floor_m + self._parameters.ankle_height_m)
        self._direction = np.zeros((2, 3))
        self._still_s = np.zeros(2)
        self._smoothed: Array | None = None

    def step(self, dt_s: float, centres: Array, rotations: Array, seen: Flags) -> Dorsiflexion:
        """One instant: estimated centres (15, 3) m, rotations (22, 3, 3) R_room_from_segment, centres seen (15,)."""
        forward = _level(rotations[SHANKS][:, :, 0])
        ankles, speed = self._smooth(dt_s, centres[ANKLE_PLACES])
        self._learn(dt_s, ankles, forward)
        if self._height is None:
            return Dorsiflexion(np.zeros(2), np.zeros(2), np.zeros(2, dtype=np.bool_))
        p = self._parameters
        near = (np.abs(ankles[:, 1] - self._height) <= p.near_m) & (speed <= p.slow)
        self._still_s = np.where(near, self._still_s + dt_s, 0.0)
        # A foot that has left its place may come down turned.
        lifted = np.abs(ankles[:, 1] - self._height) > p.near_m
        self._direction[lifted] = 0.0
        unknown = (self._direction == 0.0).all(axis=1) & near
        self._direction[unknown] = forward[unknown]
        angle, std = self._angle(centres[KNEE_PLACES] - centres[ANKLE_PLACES])
        shown = seen[ANKLE_PLACES] & seen[KNEE_PLACES] & (self._still_s >= p.still_s) & (np.abs(angle) <= p.largest)
        return Dorsiflexion(angle, std, shown)

    def _smooth(self, dt_s: float, ankles: Array) -> tuple[Array, Array]:
        """(2, 3) m low-passed, and how fast that moves, m/s: single estimates jump by more than a standing foot."""
        if self._smoothed is None or dt_s <= 0.0 or dt_s > self._parameters.longest_step_s:
            self._smoothed = ankles.copy()
            return self._smoothed, np.zeros(2)
        step = (ankles - self._smoothed) * (dt_s / (dt_s + self._parameters.smoothing_s))
        self._smoothed = self._smoothed + step
        return self._smoothed, _lengths(step) / dt_s

    def _learn(self, dt_s: float, ankles: Array, forward: Array) -> None:
        """Means over the standing second."""
        if self._learn_s <= 0.0:
            return
        self._learn_s -= dt_s
        self._learnt += 1
        before = np.zeros(2) if self._height is None else self._height
        self._height = before + (ankles[:, 1] - before) / self._learnt
        self._direction = _level(self._direction + forward / self._learnt)
        self._still_s = np.full(2, self._parameters.still_s)

    def _angle(self, shanks: Array) -> tuple[Array, Array]:
        """(2,) rad inclination of shanks (2, 3), ankle to knee, along the feet; and its deviation."""
        ahead = (shanks * self._direction).sum(axis=1)
        aside = shanks[:, 2] * self._direction[:, 0] - shanks[:, 0] * self._direction[:, 2]
        angle = np.arctan2(ahead, shanks[:, 1])
        # Of a direction that is wrong by d, the lean aside adds to that ahead by its sine.
        from_direction = np.abs(np.arctan2(aside, shanks[:, 1])) * self._parameters.direction_std
        return angle, np.array([hypot(self._parameters.std, each) for each in from_direction])

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "learn_s": self._learn_s,
            "learnt": self._learnt,
            "height": None if self._height is None else pack_array(self._height),
            "direction": pack_array(self._direction),
            "still_s": pack_array(self._still_s),
            "smoothed": None if self._smoothed is None else pack_array(self._smoothed),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._learn_s, self._learnt = state["learn_s"], state["learnt"]
        self._height = None if state["height"] is None else unpack_array(state["height"])
        self._direction, self._still_s = unpack_array(state["direction"]), unpack_array(state["still_s"])
        self._smoothed = None if state["smoothed"] is None else unpack_array(state["smoothed"])


def _lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt((vectors**2).sum(axis=-1)))


def _level(vectors: Array) -> Array:
    """(n, 3) made horizontal and of unit length; zero where they are vertical."""
    flat = vectors * np.array([1.0, 0.0, 1.0])
    length = _lengths(flat)[:, None]
    return np.asarray(np.where(length > 1e-6, flat / np.maximum(length, 1e-6), 0.0))
