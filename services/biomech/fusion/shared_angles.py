"""The angles of pelvis, hips and knees that inertial sensors and a camera both tell.

While both are there, each teaches the other: offsets of both, of which only the difference is seen and each takes its
share by how large it is known to be; and the camera's manner in this person's movement, q = c0 + c1 z + c2 dz/dt of
what it tells (z): an offset, a scale and a delay. When the inertial sensors are gone, the camera goes on through
that; when the camera is gone, the inertial sensors go on with their offset. All angles are independent of each other.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.fusion.parameters import SHARED, FusionParameters

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

N = len(SHARED)
START_RESIDUAL = 1.5
"""Of the camera's noise: what its manner leaves before it is known."""


class Told(NamedTuple):
    """What one source says at an instant."""

    position: Array  # (11,) rad
    velocity: Array  # (11,) rad/s
    std: Array  # (11,) rad
    valid: Flags  # (11,)


class SharedAngles:
    """Feed `compare` with instants at which both speak; ask `from_inertial` or `from_camera` for the estimate."""

    def __init__(self, parameters: FusionParameters | None = None) -> None:
        p = self._p = parameters or FusionParameters()
        self.offset = np.zeros((N, 2))
        """(11, 2) rad: of the inertial sensors, of the camera."""
        self._offset_P = np.zeros((N, 2, 2))
        self._offset_P[:, 0, 0], self._offset_P[:, 1, 1] = p.inertial_offset**2, p.camera_offset**2
        self.manner = np.tile([0.0, 1.0, 0.0], (N, 1))
        """(11, 3): rad, 1, s."""
        self._manner_P = self._manner_start()
        self._residual = (START_RESIDUAL * p.camera_noise) ** 2

    def _manner_start(self) -> Array:
        p = self._p
        spread = np.stack([p.camera_offset, np.full(N, p.scale_std), np.full(N, p.delay_std)], axis=1)
        return np.asarray(spread[:, :, None] ** 2 * np.eye(3))

    def compare(self, dt_s: float, inertial: Told, camera: Told) -> None:
        """Learn from both at the same instant, dt_s after the last comparison."""
        p, both = self._p, inertial.valid & camera.valid
        dt_s = min(max(dt_s, 1e-3), p.camera_noise_s)
        variance = p.camera_noise**2 * p.camera_noise_s / dt_s
        self._forget_offsets(dt_s)
        difference = camera.position - inertial.position
        self._learn_offsets(np.where(both, _wrapped(difference), 0.0), variance, both)
        self._manner_P += self._manner_start() * (2.0 * dt_s / p.manner_memory_s) ** 2
        self._learn_manner(dt_s, inertial.position - self.offset[:, 0], camera, variance, both)

    def _forget_offsets(self, dt_s: float) -> None:
        p = self._p
        keep = np.exp(-dt_s / np.array([p.inertial_memory_s, p.camera_memory_s]))
        spread = np.stack([p.inertial_offset, p.camera_offset], axis=1) ** 2
        self.offset *= keep
        self._offset_P *= keep[:, None] * keep
        self._offset_P[:, [0, 1], [0, 1]] += spread * (1.0 - keep**2)

    def _learn_offsets(self, difference: Array, variance: Array, both: Flags) -> None:
        h = np.array([-1.0, 1.0])
        Ph = self._offset_P @ h
        gain = np.where(both, 1.0, 0.0)[:, None] * Ph / (Ph @ h + variance)[:, None]
        self.offset += gain * (difference - self.offset @ h)[:, None]
        self._offset_P -= gain[:, :, None] * Ph[:, None, :]

    def _learn_manner(self, dt_s: float, q: Array, camera: Told, variance: Array, both: Flags) -> None:
        terms = _terms(camera)
        Ph = np.einsum("nij,nj->ni", self._manner_P, terms)
        gain = np.where(both, 1.0, 0.0)[:, None] * Ph / (np.einsum("ni,ni->n", Ph, terms) + variance)[:, None]
        missed = np.where(both, _wrapped(q - np.einsum("ni,ni->n", self.manner, terms)), 0.0)
        self.manner += gain * missed[:, None]
        self._manner_P -= gain[:, :, None] * Ph[:, None, :]
        share = np.where(both, min(1.0, dt_s / self._p.residual_memory_s), 0.0)
        self._residual += share * (missed**2 - self._residual)

    def from_inertial(self, inertial: Told) -> Told:
        """What the inertial sensors say, without their offset."""
        own = np.maximum(inertial.std**2 - self._p.inertial_offset**2, 0.0)
        std = np.sqrt(self._offset_P[:, 0, 0] + own)
        # Before anything was compared the offset's own spread says no more than the estimator itself.
        return inertial._replace(position=inertial.position - self.offset[:, 0], std=np.minimum(std, inertial.std))

    def from_camera(self, camera: Told) -> Told:
        """What the camera says, without its manner."""
        terms = _terms(camera)
        position = np.einsum("ni,ni->n", self.manner, terms)
        known = np.einsum("ni,nij,nj->n", terms, self._manner_P, terms)
        return Told(position, self.manner[:, 1] * camera.velocity, np.sqrt(known + self._residual), camera.valid)

    def snapshot(self) -> dict[str, Array]:
        """Everything that changes."""
        return {
            "offset": self.offset, "offset_P": self._offset_P, "manner": self.manner, "manner_P": self._manner_P,
            "residual": self._residual,
        }  # fmt: skip

    def restore(self, state: dict[str, Array]) -> None:
        """Inverse of `snapshot`."""
        self.offset, self._offset_P = state["offset"], state["offset_P"]
        self.manner, self._manner_P = state["manner"], state["manner_P"]
        self._residual = state["residual"]


def _terms(camera: Told) -> Array:
    """(11, 3)."""
    return np.stack([np.ones(N), camera.position, camera.velocity], axis=1)


def _wrapped(angle: Array) -> Array:
    """The same angles in (-pi, pi]: a heading may be whole turns apart."""
    return np.asarray(np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi)
