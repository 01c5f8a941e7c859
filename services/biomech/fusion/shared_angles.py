"""The angles of pelvis, hips and knees that inertial sensors and a camera both tell.

While both are there, each teaches the other: offsets of both, of which only the difference is seen and each takes its
share by how large it is known to be; and the camera's manner in this person's movement. When the inertial sensors are
gone, the camera goes on through that; when the camera is gone, the inertial sensors go on with their offset.

The manner is q = c0 + c1 z + c2 dz/dt of what the camera tells (z): an offset, a scale and a delay. While the rhythm
is locked there is a second one with the harmonics of its phase beside z: what the camera makes of a stride is the same
in every stride, and so is most of the stride itself. The likelier one is used. All angles are independent.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.fusion.manner import Manner, wrapped
from services.biomech.fusion.parameters import SHARED, FusionParameters

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

N = len(SHARED)


class Told(NamedTuple):
    """What one source says at an instant."""

    position: Array  # (11,) rad
    velocity: Array  # (11,) rad/s
    std: Array  # (11,) rad
    valid: Flags  # (11,)


class Turn(NamedTuple):
    """Where in the stride that is; None is used where no rhythm is locked."""

    phase: float  # rad
    rate: float  # rad/s


class SharedAngles:
    """Feed `compare` with instants at which both speak; ask `from_inertial` or `from_camera` for the estimate."""

    def __init__(self, parameters: FusionParameters | None = None) -> None:
        p = self._p = parameters or FusionParameters()
        self.offset = np.zeros((N, 2))
        """(11, 2) rad: of the inertial sensors, of the camera."""
        self._offset_P = np.zeros((N, 2, 2))
        self._offset_P[:, 0, 0], self._offset_P[:, 1, 1] = p.inertial_offset**2, p.camera_offset**2
        plain = np.stack([p.camera_offset, np.full(N, p.scale_std), np.full(N, p.delay_std)], axis=1)
        orders = np.repeat(np.arange(1.0, p.harmonics + 1.0), 2)
        stride = np.outer(p.stride_noise * p.camera_noise, 1.0 / orders)
        self.manner = self._manner(plain)
        self.rhythmic_manner = self._manner(np.concatenate([plain, stride], axis=1))

    def _manner(self, spread: Array) -> Manner:
        mean = np.zeros_like(spread)
        mean[:, 1] = 1.0
        return Manner(mean, spread, self._p.camera_noise, self._p.manner_memory_s, self._p.residual_memory_s)

    def compare(self, dt_s: float, inertial: Told, camera: Told, turn: Turn | None = None) -> None:
        """Learn from both at the same instant, dt_s after the last comparison."""
        p, both = self._p, inertial.valid & camera.valid
        dt_s = min(max(dt_s, 1e-3), p.camera_noise_s)
        variance = p.camera_noise**2 * p.camera_noise_s / dt_s
        within_stride = p.camera_noise**2 * p.manner_noise_s / dt_s
        self._forget_offsets(dt_s)
        difference = np.where(both, wrapped(camera.position - inertial.position), 0.0)
        self._learn_offsets(difference, variance, both)
        q = inertial.position - self.offset[:, 0]
        self.manner.learn(dt_s, _terms(camera), q, within_stride, both)
        if turn is not None:
            self.rhythmic_manner.learn(dt_s, self._stride_terms(camera, turn), q, within_stride, both)

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

    def from_inertial(self, inertial: Told) -> Told:
        """What the inertial sensors say, without their offset."""
        own = np.maximum(inertial.std**2 - self._p.inertial_offset**2, 0.0)
        std = np.sqrt(self._offset_P[:, 0, 0] + own)
        # Before anything was compared the offset's own spread says no more than the estimator itself.
        return inertial._replace(position=inertial.position - self.offset[:, 0], std=np.minimum(std, inertial.std))

    def from_camera(self, camera: Told, turn: Turn | None = None) -> Told:
        """What the camera says, through its manner."""
        terms = _terms(camera)
        position, variance = self.manner.value(terms), self.manner.variance(terms)
        velocity = self.manner.coefficients[:, 1] * camera.velocity
        if turn is not None:
            terms = self._stride_terms(camera, turn)
            likelier = self.rhythmic_manner.variance(terms) < variance
            position = np.where(likelier, self.rhythmic_manner.value(terms), position)
            velocity = np.where(likelier, self._stride_velocity(camera, turn), velocity)
            variance = np.minimum(variance, self.rhythmic_manner.variance(terms))
        return Told(position, velocity, np.sqrt(variance), camera.valid)

    def _harmonics(self, turn: Turn) -> tuple[Array, Array]:
        """Cosines and sines of the phase, (2 harmonics,), and their derivatives by time."""
        orders = np.arange(1, self._p.harmonics + 1)
        cosines, sines = np.cos(orders * turn.phase), np.sin(orders * turn.phase)
        values = np.stack([cosines, sines], axis=1).ravel()
        rates = np.stack([-orders * turn.rate * sines, orders * turn.rate * cosines], axis=1).ravel()
        return values, rates

    def _stride_terms(self, camera: Told, turn: Turn) -> Array:
        values, _ = self._harmonics(turn)
        return np.concatenate([_terms(camera), np.broadcast_to(values, (N, len(values)))], axis=1)

    def _stride_velocity(self, camera: Told, turn: Turn) -> Array:
        _, rates = self._harmonics(turn)
        coefficients = self.rhythmic_manner.coefficients
        return np.asarray(coefficients[:, 1] * camera.velocity + coefficients[:, 3:] @ rates)

    def snapshot(self) -> dict[str, dict[str, Array]]:
        """Everything that changes."""
        return {
            "offset": {"mean": self.offset, "P": self._offset_P},
            "manner": self.manner.snapshot(),
            "rhythmic_manner": self.rhythmic_manner.snapshot(),
        }

    def restore(self, state: dict[str, dict[str, Array]]) -> None:
        """Inverse of `snapshot`."""
        self.offset, self._offset_P = state["offset"]["mean"], state["offset"]["P"]
        self.manner.restore(state["manner"])
        self.rhythmic_manner.restore(state["rhythmic_manner"])


def _terms(camera: Told) -> Array:
    """(11, 3)."""
    return np.stack([np.ones(N), camera.position, camera.velocity], axis=1)
