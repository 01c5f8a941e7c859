"""The same filter as a textbook writes it: dense matrices, all measurements at once, rows from Pinocchio.

It is what the compiled filter is compared with, in results and in time.

    x = F x + G j,  P = F P F' + Q,  S = H P H' + R,  K = P H' inv(S),  x = x + K (z - h(x)),  P = (I - K H) P
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Segment
from services.biomech.kernels.step import NOMINAL_DT_S
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.biomech.lower_body_ekf import MeasurementModel, NoiseModel
from services.biomech.pinocchio_model import PinocchioBody

Array = NDArray[np.float64]

YAWED = (Segment.PELVIS, Segment.THIGH_RIGHT, Segment.THIGH_LEFT)


class TextbookEkf:
    """State x (3 n,) and covariance P (3 n, 3 n), positions first; every sensor has a sample in every step.

    Unlike in the compiled filter, position and velocity of the pelvis are part of the covariance.
    """

    def __init__(
        self,
        model: LowerBodyModel,
        mounts: Sequence[SensorMount],
        measurement: MeasurementModel,
        noise: NoiseModel,
    ) -> None:
        self.body = PinocchioBody(model, mounts)
        self.measurement, self.noise = measurement, noise
        self.n, self.t = len(model.dofs), model.first_rotation
        self.soft = model.soft
        self._soft_rows = np.eye(3 * self.n)[self.soft]
        self._transitions: dict[float, tuple[Array, Array, Array, Array]] = {}
        self.x = np.zeros(3 * self.n)
        starts = (noise.start_position_std, noise.start_velocity_std, noise.start_acceleration_std)
        self.P = np.diag(np.repeat(np.square(starts), self.n))

    def advance(self, dt_s: float, samples: Array, jerk: Array) -> None:
        """Predict over dt_s > 0 and fuse samples (S, 6) of all sensors; jerk (n,)."""
        F, g, Q_turning, Q_moving = self._transition(dt_s)
        self.x = F @ self.x + np.kron(g, jerk)
        z, H, R = self._measurement(samples, dt_s)
        self.P = F @ self.P @ F.T + self._density(z[: samples.size], dt_s) * Q_turning + Q_moving
        S = H @ self.P @ H.T + R
        K = self.P @ H.T @ np.linalg.inv(S)
        self.x = self.x + K @ z
        self.P = (np.eye(3 * self.n) - K @ H) @ self.P
        self.P = 0.5 * (self.P + self.P.T)

    def _density(self, innovations: Array, dt_s: float) -> float:
        """Density of the jerk, rad^2/s^5: wider where a gyroscope is farther off than any movement explains."""
        largest = np.linalg.norm(innovations.reshape(-1, 2, 3)[:, 0], axis=1).max()
        if largest <= self.noise.impact_rate:
            return self.noise.jerk_density
        return max(self.noise.jerk_density, float(2.0 * largest / self.noise.impact_deviations) ** 2 / dt_s**3)

    def _transition(self, dt_s: float) -> tuple[Array, Array, Array, Array]:
        """F (3 n, 3 n), g (3,), Q (3 n, 3 n) for rotations of unit density, and Q for translations.

        Kept for the next step of the same length.
        """
        if dt_s not in self._transitions:
            self._transitions[dt_s] = self._new_transition(dt_s)
        return self._transitions[dt_s]

    def _new_transition(self, dt_s: float) -> tuple[Array, Array, Array, Array]:
        one, h = np.eye(self.n), dt_s * dt_s / 2.0
        zero = np.zeros_like(one)
        F = np.block([[one, dt_s * one, h * one], [zero, one, dt_s * one], [zero, zero, one]])
        g = np.array([dt_s**3 / 6.0, h, dt_s])
        is_rotation = np.arange(self.n) >= self.t
        turning = np.kron(np.outer(g, g) / dt_s, np.diag(1.0 * is_rotation))
        moving = np.zeros_like(turning)
        moving[2 * self.n :, 2 * self.n :] = np.diag(~is_rotation * self.noise.translation_density * dt_s)
        return np.asarray(F), g, np.asarray(turning), moving

    def _measurement(self, samples: Array, dt_s: float) -> tuple[Array, Array, Array]:
        """Innovations, Jacobian and noise covariance of all rows."""
        x, wide = self.x.reshape(3, self.n), NOMINAL_DT_S / dt_s
        expected = self._sample_rows(x)
        yaws = self._yaw_rows(x[0])
        z = [self._believed(sample) - value for sample, (value, _) in zip(samples, expected, strict=True)]
        H = [rows.reshape(6, -1) for _, rows in expected] + [row[None] for _, row in yaws] + [self._soft_rows]
        variances = np.concatenate(
            [
                np.tile([self.noise.gyro_std**2] * 3 + [self.noise.accel_std**2] * 3, len(samples)),
                np.full(len(yaws), self.noise.yaw_std**2 * wide),
                np.full(len(self.soft), self.noise.soft_knee_std**2 * wide),
            ]
        )
        innovations = [*z, np.array([yaw for yaw, _ in yaws]), -x[0, self.soft]]
        return np.concatenate(innovations), np.concatenate(H), np.diag(variances)

    def _believed(self, sample: Array) -> Array:
        """The sample (6,) with its specific force shortened to what a gravity sensor is believed."""
        length = float(np.linalg.norm(sample[3:]))
        if self.measurement.accel_sees_motion or length <= self.measurement.force_bound:
            return sample
        return np.concatenate([sample[:3], sample[3:] * (self.measurement.force_bound / length)])

    def _sample_rows(self, x: Array) -> list[tuple[Array, Array]]:
        """Expected sample (6,) and rows (6, 3, n) of each sensor."""
        sensors = range(len(self.body.sensor_frames))
        self.body.differentiate(x)
        result = [self.body.differentiated_sample(s) for s in sensors]
        if not self.measurement.accel_sees_motion:
            self.body.differentiate(np.stack([x[0], np.zeros(self.n), np.zeros(self.n)]))
            for s, (expected, rows) in enumerate(result):
                at_rest, rest_rows = self.body.differentiated_sample(s)
                expected[3:], rows[3:] = at_rest[3:], 0.0
                rows[3:, 0] = rest_rows[3:, 0]
        if not self.measurement.gyro_sees_position:
            for _, rows in result:
                rows[:3, 0] = 0.0
        return result

    def _yaw_rows(self, position: Array) -> list[tuple[float, Array]]:
        headings = [self.body.yaw(segment, position) for segment in YAWED]
        if self.measurement.yaw == "world":
            pairs = headings
        elif self.measurement.yaw == "relative":
            pelvis, pelvis_row = headings[0]
            pairs = [(yaw - pelvis, row - pelvis_row) for yaw, row in headings[1:]]
        else:
            pairs = []
        wide = np.zeros(2 * self.n)
        return [(float((np.pi - yaw) % (2 * np.pi) - np.pi), np.concatenate([row, wide])) for yaw, row in pairs]
