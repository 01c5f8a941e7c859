"""Extended Kalman filter of the lower body on gyroscopes and accelerometers (Joukov eq. 10-15, 22).

State: position, velocity and acceleration of every joint. The kernels hold the mathematics; this class holds the
arrays between steps and the choices of the measurement model.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import LOWER_BODY, Segment
from services.biomech.companions import CompanionModel, companion_tables
from services.biomech.kernels.bundle import advance, tie
from services.biomech.kernels.fixed import LANES, width_of
from services.biomech.kernels.soundness import is_sound
from services.biomech.kernels.tables import (
    Body,
    Columns,
    Companions,
    Motion,
    Noise,
    Options,
    Sensors,
    Update,
    empty_motion,
)
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]

REMEMBERED = ("x", "jerk", "evidence", "weight", "estimate")
"""Tables of the companions that outlive a step."""

FASTEST_JOINT = 100.0
"""rad/s. The difference of two worn gyroscopes at the end of their range (35 rad/s) stays below."""

NO_BOUND = 1e6
"""Beyond any sample. Infinity would not do: kernels presume finite numbers."""

YAW_MODES = {"none": 0, "world": 1, "relative": 2}


@dataclass(frozen=True)
class MeasurementModel:
    """What the filter believes its sensors say.

    gyro_sees_position: keep d(gyro)/dq in the Jacobian, as Joukov does. Right for a perfect model; on recordings
        every gyro residual (soft tissue, impacts, hinge violation) is then read as orientation and the pose walks
        away (knee 14 against 1.0 deg on a drop landing). The predicted value stays exact either way.
    accel_sees_motion: predict the accelerometer from the whole motion with lever arms, as Joukov does; otherwise
        as a gravity sensor. Knee 3.3-3.7 against 2.9 deg on a recorded walk. Needs the pelvis translations.
    yaw: 'relative' measures the heading of each thigh against the pelvis as zero; 'world' measures pelvis and
        thighs against the world, as Joukov does, which fights every turn; 'none' lets the legs turn away.
    force_bound: a gravity sensor's specific force is shortened to this length. A blow of 10 g lasts some
        hundredths of a second and would tilt a segment by what half a second of standing corrects. Shortened, not
        left out: the flight before a landing pulls the other way. Chosen on the first 22 s of drop landings (knee
        there 0.94 without, 0.77 to 0.79 with 17 to 21) as the largest of those; below 20 walking without a standing
        is worse by 0.02. Without effect where `accel_sees_motion`.
    """

    gyro_sees_position: bool = False
    accel_sees_motion: bool = False
    yaw: Literal["none", "world", "relative"] = "relative"
    force_bound: float = 21.0  # m/s^2


@dataclass(frozen=True)
class NoiseModel:
    """Standard deviations; only gyro_std against accel_std matters for angles: tilt time constant
    = accel_std / (9.81 gyro_std) = 2.4 s."""

    gyro_std: float = 0.05  # rad/s per sample at 100 Hz
    accel_std: float = 1.2  # m/s^2 per sample at 100 Hz; chosen on sit-to-stand and the first 22 s of drop landings
    jerk_density: float = 300.0  # rad^2/s^5, angles indifferent from 1e3 to 1e6, see README
    translation_density: float = 300.0  # m^2/s^5, random walk of the pelvis acceleration
    impact_rate: float = 5.0  # rad/s of a gyroscope's innovation; walking at 100 Hz stays below 4.7, landings reach 17
    impact_deviations: float = 30.0  # of the innovation at an impact that the widened jerk leaves
    yaw_std: float = 0.3  # rad per sample at 100 Hz
    soft_knee_std: float = 0.1  # rad per sample at 100 Hz
    start_position_std: float = 0.32  # rad
    start_velocity_std: float = 0.32  # rad/s
    start_acceleration_std: float = 3.2  # rad/s^2


class LowerBodyEkf:
    """The filter of one session. `x` (3, n), `P` (N, N) and what `companions` remember are its whole state.

    `estimate` (3, n) is what is believed: x, where there are no companions.
    """

    def __init__(
        self,
        model: LowerBodyModel,
        mounts: Sequence[SensorMount],
        gyro_bias: Array,
        measurement: MeasurementModel = MeasurementModel(),
        noise: NoiseModel = NoiseModel(),
        companions: CompanionModel | None = None,
    ) -> None:
        if measurement.accel_sees_motion and not model.translations:
            raise ValueError("accel_sees_motion needs a model with translations")
        self.model = model
        self.noise = noise
        self.bias = np.ascontiguousarray(gyro_bias, dtype=np.float64)
        self.body = model.body
        self.sensors = model.sensors(mounts)
        self.options = _options(model, measurement)
        self.columns = _columns(model, self.sensors, measurement)
        n, S = len(model.dofs), len(mounts)
        N = 3 * (n - model.first_rotation) + model.first_rotation
        self.x = np.zeros((3, n))
        # All models share one row length: for each the compiler would need another minute.
        width = width_of(max(N, 3 * len(LOWER_BODY)))
        M = LANES * len(width)
        self.padded_covariance = np.zeros((N, M))
        self.P = self.padded_covariance[:, :N]
        self.P[:] = np.diag(self._start_variance(N))
        rotations = n - model.first_rotation
        self._variances = self.padded_covariance.reshape(-1)[: 2 * rotations * (M + 1) : M + 1]
        self._motion = empty_motion(n)
        self._update = Update(
            np.zeros((S, 6, M)), np.zeros((S, 6)), np.zeros((6, M)), np.zeros(6), np.zeros(6),
            np.zeros(M), np.zeros((6, M)), np.zeros((6, 6)), np.zeros(6), width,
        )  # fmt: skip
        variances = _noise(model, S, noise)
        self.companions = companion_tables(
            model, mounts, companions or CompanionModel(), noise.jerk_density, noise.gyro_std, width
        )
        self.estimate = self.companions.estimate
        self._tables = (
            self.body, self.sensors, self.columns, self.options, variances, self._motion, self._update, self.companions
        )  # fmt: skip
        self._bundle = tie(self.x, self.padded_covariance, self.bias, *self._tables)

    def advance(self, dt_s: float, samples: Array, fresh: NDArray[np.bool_], jerk: Array, rest: Array) -> None:
        """Predict over dt_s >= 0 and fuse.

        samples (S, 6) rad/s and m/s^2 in the sensor frames, finite where `fresh` (S,); jerk (n,) rad/s^3;
        rest (3, n) variance at 100 Hz of "this joint's position/velocity/acceleration is zero", 0 for none.
        """
        advance(self._bundle, dt_s, jerk, samples, fresh, rest)

    def tables(self) -> tuple[Body, Sensors, Columns, Options, Noise, Motion, Update, Companions]:
        """The kernels' tables and scratch, in the order in which `step` takes them."""
        return self._tables

    def innovations(self) -> Array:
        """(1 + C, S, 6) newest sample minus its prediction, rad/s and m/s^2: of `x`, then of each companion.

        Where a sensor had no sample, the innovation of its last one.
        """
        return np.concatenate([self._update.innovation[None], self.companions.innovation])

    def settle(self) -> None:
        """After a time without samples: keep the pose, forget how it moved and how sure it was."""
        self.x[1:] = 0.0
        self.estimate[:] = self.x
        self.companions.x[:] = self.x
        self.companions.jerk[:] = 0.0
        self.companions.evidence[:] = 0.0
        self.P[:] = np.diag(self._start_variance(len(self.P)))

    def pack_companions(self) -> State:
        """What companions remember, as JSON values."""
        return {name: pack_array(getattr(self.companions, name)) for name in REMEMBERED}

    def unpack_companions(self, state: State) -> None:
        """Inverse of `pack_companions`."""
        for name in REMEMBERED:
            array = getattr(self.companions, name)
            array[...] = unpack_array(state[name]).reshape(array.shape)

    def is_sound(self) -> bool:
        """Finite throughout, and no joint faster than anything that moves. Translations drift: no sensor sees them."""
        first = self.model.first_rotation
        return bool(is_sound(self.x, self.companions.x, self._variances, first, FASTEST_JOINT))

    def start_over(self) -> None:
        """Upright and at rest, as at the start."""
        self.x[0] = 0.0
        self.padded_covariance[:] = 0.0
        self.settle()

    def shift(self, way: Array) -> None:
        """Move the joints by way (n,), rad, whatever drives them."""
        self.x[0] += way
        self.companions.x[:, 0] += way
        self.estimate[0] += way

    def loosen(self, joints: Sequence[int]) -> None:
        """Make some joints as uncertain as at the start, so that the next samples may move them."""
        rotations = len(self.model.dofs) - self.model.first_rotation
        starts = (self.noise.start_position_std, self.noise.start_velocity_std, self.noise.start_acceleration_std)
        for joint in joints:
            for order, std in enumerate(starts):
                column = order * rotations + joint - self.model.first_rotation
                self.P[column, column] += std**2

    def deviations(self) -> Array:
        """(2, n) standard deviations of position, rad, and velocity, rad/s; 0 for translations."""
        deviations = np.sqrt(np.maximum(self._variances, 0.0)).reshape(2, -1)
        t = self.model.first_rotation
        return np.concatenate([np.zeros((2, t)), deviations], axis=1) if t else deviations

    def _start_variance(self, N: int) -> Array:
        r = len(self.model.dofs) - self.model.first_rotation
        noise = self.noise
        variance = np.full(N, noise.start_acceleration_std**2)
        variance[:r] = noise.start_position_std**2
        variance[r : 2 * r] = noise.start_velocity_std**2
        return variance


def _options(model: LowerBodyModel, measurement: MeasurementModel) -> Options:
    bodies = [model.last_joint(s) for s in (Segment.PELVIS, Segment.THIGH_RIGHT, Segment.THIGH_LEFT)]
    return Options(
        measurement.gyro_sees_position,
        measurement.accel_sees_motion,
        YAW_MODES[measurement.yaw],
        np.array(bodies, dtype=np.int64),
        NO_BOUND if measurement.accel_sees_motion else measurement.force_bound,
    )


def _noise(model: LowerBodyModel, sensors: int, noise: NoiseModel) -> Noise:
    jerk = np.full(len(model.dofs), noise.jerk_density)
    jerk[: model.first_rotation] = noise.translation_density
    sample = np.repeat([noise.gyro_std**2, noise.accel_std**2], 3)
    return Noise(jerk, np.tile(sample, (sensors, 1)), noise.yaw_std**2, noise.impact_rate, noise.impact_deviations)


def _columns(model: LowerBodyModel, sensors: Sensors, measurement: MeasurementModel) -> Columns:
    t, n = model.first_rotation, len(model.dofs)
    r = n - t
    gyro, accel = [], []
    for path, length in zip(sensors.path, sensors.path_length, strict=True):
        rotations = [int(j) - t for j in path[:length] if j >= t]
        velocity = [r + i for i in rotations]
        gyro.append((rotations if measurement.gyro_sees_position else []) + velocity)
        if measurement.accel_sees_motion:
            accelerations = [2 * r + i for i in rotations] + [3 * r + k for k in range(t)]
            accel.append(rotations + velocity + accelerations)
        else:
            accel.append(list(rotations))
    thighs = (Segment.PELVIS, Segment.THIGH_RIGHT, Segment.THIGH_LEFT)
    yaw = np.array([j - t for segment in thighs for j in model.joints_of(segment)], dtype=np.int64)
    N = 3 * r + t
    complete = N if measurement.accel_sees_motion else 2 * r
    gyro, accel = [_in_threes(row, N) for row in gyro], [_in_threes(row, N) for row in accel]
    return Columns(*_ragged(gyro), *_ragged(accel), yaw, complete)


def _in_threes(touched: list[int], N: int) -> list[int]:
    free = [column for column in range(N) if column not in touched]
    return touched + free[: -len(touched) % 3]


def _ragged(rows: list[list[int]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    table = np.zeros((len(rows), max((len(row) for row in rows), default=1)), dtype=np.int64)
    for target, row in zip(table, rows, strict=True):
        target[: len(row)] = row
    return table, np.array([len(row) for row in rows], dtype=np.int64)
