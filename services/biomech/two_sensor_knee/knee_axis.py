"""Knee flexion from two sensors that nobody calibrated: our form of McGrath's self-finding axis.

Steps of one sample, in the order of `advance`:

1. bounds and gaps of the input                      this file
2. orientation of each sensor, bias, rest            levelling.py
3. the knee as shared point: heading, arms           joint_centre.py
4. axis by principal components, with forgetting     hinge_axis.py
5. heading held by the hinge                         heading.py
6. angle, sign, zero, uncertainty                    flexion.py
"""

from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.flexion import (
    angle_deviation,
    angle_of_verticals,
    follow_angle,
    settle,
    take_standing,
)
from services.biomech.two_sensor_knee.heading import take_joint_heading, tie, tie_without_joint
from services.biomech.two_sensor_knee.hinge_axis import begin_angle, follow_axis, improve_axes
from services.biomech.two_sensor_knee.joint_centre import IDLE, SOLVED, follow_joint
from services.biomech.two_sensor_knee.levelling import follow_level
from services.biomech.two_sensor_knee.memory import (
    OUTPUTS,
    SHANK,
    THIGH,
    Bench,
    FloatArray,
    Memory,
    Record,
    allocate_memory,
    pack_memory,
    prepare_bench,
    unpack_memory,
)
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters
from services.biomech.two_sensor_knee.turns import fill_relative, wrapped
from services.flow.node import State


class Datum(StrEnum):
    """What 0 means."""

    START = "start"  # the pose in which the axis was first seen
    STANDING = "standing"  # quiet standing
    SET = "set"  # the pose that was declared


DATUMS = (Datum.START, Datum.STANDING, Datum.SET)


class KneeReading(NamedTuple):
    """Flexion of one sample, rad and rad/s; positive when the knee bends."""

    flexion: float
    flexion_std: float
    is_valid: bool
    flexion_rate: float
    axis_std: float  # rad
    is_sign_known: bool
    datum: Datum


@compiled
def advance(memory: Memory, bench: Bench, rate: FloatArray, force: FloatArray, dt_s: float) -> None:
    """Take one sample of both sensors, rate (2, 3) rad/s and force (2, 3) m/s^2; leaves the reading in the bench.

    A sample that is not finite or beyond what a leg can do counts as missing: the reading is not valid and the next
    interval is longer. Intervals of 0 or less are no time and change nothing.
    """
    knee, parameters = memory.knee[0], bench.parameters[0]
    bench.output[2] = 0.0
    interval_s = usable_interval(knee, rate, force, dt_s, parameters)
    if interval_s <= 0.0:
        return
    if interval_s > parameters.gap_s:
        bridge_gap(memory, interval_s, parameters.heading_drift)
        interval_s = dt_s if dt_s <= parameters.gap_s else parameters.joint_interval_s
    for s in range(2):
        follow_level(memory.levels[s], rate[s], force[s], interval_s, parameters, bench.R[s])
        for i in range(3):
            bench.rate[s, i] = rate[s, i] - memory.levels[s].bias[i]
    if knee.has_sample == 0.0:
        knee.has_sample = 1.0
        for s in range(2):
            for i in range(3):
                memory.rate_before[s, i] = bench.rate[s, i]
    take_standing(memory, bench)
    due = follow_joint(memory, bench, force, interval_s)
    if due == SOLVED:
        take_joint_heading(memory, bench)
    if knee.is_tied == 0.0:
        tie_without_joint(memory, bench, interval_s)
    if knee.is_tied > 0.0:
        follow_hinge(memory, bench, due, interval_s)


@compiled
def follow_hinge(memory: Memory, bench: Bench, due: int, dt_s: float) -> None:
    """Heading, axis and angle of the sample, once the headings are tied.

    What changes slowly is looked at when it is `due`: axes on the grid of the joint, sign and zero at its solutions.
    """
    knee, parameters, output = memory.knee[0], bench.parameters[0], bench.output
    if knee.has_angle > 0.0:
        tie(memory, bench, knee.axis_std, dt_s)
    fill_relative(bench.R[THIGH], bench.R[SHANK], knee.heading, bench.relative)
    for i in range(3):
        for k in range(3):
            bench.midway[i, k] = 0.5 * (bench.relative[i, k] + memory.relative[i, k])
            memory.relative[i, k] = bench.relative[i, k]
    is_moving = follow_axis(memory, bench, dt_s)
    if due != IDLE:
        improve_axes(memory, bench)
    if knee.has_angle == 0.0:
        if knee.moving_s < parameters.gathering_s:
            return
        begin_angle(memory, bench)
    follow_angle(memory, bench, is_moving, dt_s)
    if due == SOLVED:
        settle(memory, parameters)
    axes, rate = memory.axes, bench.rate
    flexion_rate = 0.0
    for i in range(3):
        flexion_rate += axes[SHANK, i] * rate[SHANK, i] - axes[THIGH, i] * rate[THIGH, i]
    now = knee.angle + parameters.sample_delay_s * flexion_rate
    output[0] = wrapped(now - knee.zero)
    output[1] = angle_deviation(memory, bench, knee.axis_std)
    output[2] = 1.0 if knee.axis_std < parameters.axis_to_believe and knee.is_sign_known > 0.0 else 0.0
    output[3] = flexion_rate
    output[4] = knee.axis_std
    output[5] = wrapped(now + knee.sensor_turn)
    output[6] = knee.is_sign_known
    output[7] = 2.0 if knee.is_zero_set > 0.0 else knee.is_standing


@compiled
def usable_interval(knee: Record, rate: FloatArray, force: FloatArray, dt_s: float, parameters: Record) -> float:
    """s since the last sample that was used; 0 when this one cannot be."""
    if not dt_s > 0.0:
        return 0.0
    interval_s = dt_s + knee.unused_s
    for s in range(2):
        for i in range(3):
            # Not a number fails both comparisons.
            if not (abs(rate[s, i]) < parameters.largest_rate and abs(force[s, i]) < parameters.largest_force):
                knee.unused_s = interval_s
                return 0.0
    knee.unused_s = 0.0
    return float(interval_s)


@compiled
def bridge_gap(memory: Memory, gap_s: float, drift: float) -> None:
    """Level both sensors anew; biases, axes and arms outlive the gap, the heading is soon told by the axis."""
    for s in range(2):
        level = memory.levels[s]
        level.elapsed_s, level.rest_s = 0.0, 0.0
        level.force_fast[:] = 0.0
        level.force[:] = 0.0
    memory.knee[0].heading_variance += 1.0 + drift * drift * gap_s
    memory.knee[0].has_sample = 0.0


@compiled
def advance_many(
    memory: Memory, bench: Bench, rate: FloatArray, force: FloatArray, dt_s: float, out: FloatArray
) -> None:
    """`advance` over rate and force (n, 2, 3); out (n, 8) as OUTPUTS."""
    for i in range(rate.shape[0]):
        advance(memory, bench, rate[i], force[i], dt_s)
        for k in range(out.shape[1]):
            out[i, k] = bench.output[k]


class KneeAxis:
    """Knee flexion of one leg (see the head of this file).

    Sensor 0 is worn on the thigh, sensor 1 on the shank, each in any orientation. Intervals between samples may vary.
    """

    def __init__(self, parameters: KneeAxisParameters = KneeAxisParameters()) -> None:  # noqa: B008 (frozen)
        self.parameters = parameters
        self._memory = allocate_memory(parameters)
        self._bench = prepare_bench(parameters)
        self._reading = np.zeros((1, len(OUTPUTS)))

    def step(self, rate: NDArray[np.float64], force: NDArray[np.float64], dt_s: float) -> KneeReading:
        """Take one sample: rate (2, 3) rad/s, specific force (2, 3) m/s^2, dt_s after the sample before."""
        # The same compiled code as for many: what is compiled apart need not agree to the last bit.
        rates, forces = _plain(rate)[None], _plain(force)[None]
        advance_many(self._memory, self._bench, rates, forces, float(dt_s), self._reading)
        return self.reading()

    def run(self, rate: NDArray[np.float64], force: NDArray[np.float64], dt_s: float) -> NDArray[np.float64]:
        """Take evenly spaced samples, rate and force (n, 2, 3); OUTPUTS of each as (n, 8)."""
        out = np.zeros((rate.shape[0], len(OUTPUTS)))
        advance_many(self._memory, self._bench, _plain(rate), _plain(force), float(dt_s), out)
        if len(out):
            self._reading = out[-1:].copy()
        return out

    def reading(self) -> KneeReading:
        """The reading of the last sample."""
        flexion, std, is_valid, rate, axis_std, _, is_sign_known, datum = self._reading[0].tolist()
        return KneeReading(flexion, std, is_valid > 0.0, rate, axis_std, is_sign_known > 0.0, DATUMS[int(datum)])

    def declare_zero(self) -> None:
        """The pose of the last sample is 0 from now on."""
        knee = self._memory.knee[0]
        knee["zero"], knee["is_zero_set"] = knee["angle"], 1.0
        self._reading[0, OUTPUTS.index("datum")] = DATUMS.index(Datum.SET)

    def declare_standing(self, up: NDArray[np.float64]) -> None:
        """0 is where both verticals, up (2, 3) in the frame of each sensor, are one; nothing before there is an angle.

        Unlike `declare_zero` it may be told of a pose long ago, and again when the axes have become better.
        """
        knee = self._memory.knee[0]
        if knee["has_angle"] == 0.0:
            return
        standing = angle_of_verticals(_plain(up), self._memory.axes, self._memory.across)
        knee["zero"] = knee["angle"] + wrapped(standing - knee["angle"])
        knee["is_zero_set"] = 1.0
        self._reading[0, OUTPUTS.index("datum")] = DATUMS.index(Datum.SET)

    @property
    def has_angle(self) -> bool:
        """Whether the reading is of the last sample: the axis has been found, however well."""
        return bool(self._memory.knee[0]["has_angle"] > 0.0)

    @property
    def is_joint_known(self) -> bool:
        """Whether the arms can be believed: enough of the knee's motion was seen, and both sensors agree on it."""
        knee, parameters = self._memory.knee[0], self.parameters
        has_moved = knee["joint_moving_s"] >= parameters.joint_motion_s
        return bool(has_moved and knee["joint_coherence"] >= parameters.joint_coherence)

    @property
    def axes(self) -> NDArray[np.float64]:
        """Flexion axis in the frame of each sensor, (2, 3); zeros before any motion."""
        return self._memory.axes.copy()

    @property
    def arms(self) -> NDArray[np.float64]:
        """From each sensor to the knee, m, in the frame of the sensor, (2, 3); zeros before any motion."""
        return self._memory.arms.copy()

    @property
    def up(self) -> NDArray[np.float64]:
        """The vertical in the frame of each sensor, (2, 3), at the last sample."""
        return self._bench.R[:, 1, :].copy()

    @property
    def standing(self) -> NDArray[np.float64]:
        """The vertical in the frame of each sensor at the tallest rest, (2, 3); zeros without one."""
        return self._memory.standing.copy()

    @property
    def gyro_bias(self) -> NDArray[np.float64]:
        """Of each sensor, (2, 3) rad/s."""
        return np.array(self._memory.levels["bias"])

    @property
    def R_thigh_from_shank(self) -> NDArray[np.float64]:
        """Relative orientation of the sensors at the last sample, (3, 3); zeros before the headings are tied."""
        return self._memory.relative.copy()

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        return pack_memory(self._memory)

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        unpack_memory(state, self._memory)


def _plain(samples: NDArray[np.float64]) -> NDArray[np.float64]:
    """The one layout that is compiled for: another would be compiled for half a minute."""
    return np.ascontiguousarray(samples, dtype=np.float64)
