"""From what is known of each shared angle at an instant to one value, without a step when the source changes."""

from enum import IntEnum
from math import exp

import numpy as np
from numpy.typing import NDArray

from services.biomech.fusion.manner import wrapped
from services.biomech.fusion.parameters import SHARED
from services.biomech.fusion.shared_angles import Told
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]
N = len(SHARED)
ADJOINING_S = 0.05
"""Over a longer silence nobody knows how an angle went on, so there is nothing to join."""


class Leading(IntEnum):
    """Which source an angle is from."""

    NONE = 0
    INERTIAL = 1
    CAMERA = 2


class Blend:
    """Inertial where that is valid, the camera otherwise; a difference at the change fades within `joined_s`."""

    def __init__(self, joined_s: float) -> None:
        self._joined_s = joined_s
        self._leading = np.zeros(N, dtype=np.int64)
        self._step = np.zeros(N)
        self._position, self._velocity = np.zeros(N), np.zeros(N)
        self._captured_ns = 0

    def take(self, captured_ns: int, inertial: Told | None, camera: Told | None) -> Told:
        """The angles at an instant, not before the last one. What neither tells keeps its last value, not valid."""
        dt_s = (captured_ns - self._captured_ns) / 1e9
        leading = np.zeros(N, dtype=np.int64)
        raw = Told(self._position, np.zeros(N), np.full(N, np.pi), np.zeros(N, dtype=np.bool_))
        for source, told in ((Leading.CAMERA, camera), (Leading.INERTIAL, inertial)):
            if told is not None:
                leading[told.valid] = source
                raw = Told(*(np.where(told.valid, new, old) for new, old in zip(told, raw, strict=True)))
        changed = (leading != self._leading) & (leading > 0) & (self._leading > 0) & (dt_s <= ADJOINING_S)
        expected = self._position + self._velocity * dt_s
        self._step *= exp(-max(dt_s, 0.0) / self._joined_s)
        # A heading that is whole turns apart is the same one.
        self._step[changed] = wrapped(expected - raw.position)[changed]
        self._step[leading == 0] = 0.0
        if dt_s > ADJOINING_S:
            self._step[:] = 0.0
        self._step[(self._leading == 0) & (leading > 0)] = 0.0
        self._leading = leading
        self._position, self._velocity, self._captured_ns = raw.position + self._step, raw.velocity, captured_ns
        return raw._replace(position=self._position)

    @property
    def leading(self) -> NDArray[np.int64]:
        """(11,) where each angle came from last."""
        return self._leading

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "angles": pack_array(np.stack([self._step, self._position, self._velocity])),
            "leading": self._leading.tolist(),
            "captured_ns": self._captured_ns,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._step, self._position, self._velocity = (row.copy() for row in unpack_array(state["angles"]))
        self._leading = np.array(state["leading"], dtype=np.int64)
        self._captured_ns = state["captured_ns"]
