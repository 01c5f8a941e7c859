"""What one sample of both sensors does, step by step (see `knee_axis.py`)."""

from math import pi

import numpy as np
from numpy.typing import NDArray

from services.biomech.two_sensor_knee.bending import faces_the_other_way, follow_posture, settle_sign
from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.flexion import (
    angle_deviation,
    follow_angle,
    settle_zero,
    take_standing,
    turn_from_sensor_axes,
)
from services.biomech.two_sensor_knee.heading import (
    RATES_HEADING_STD,
    begin_hinge,
    take_joint_heading,
    tie,
    tie_without_joint,
)
from services.biomech.two_sensor_knee.hinge_axis import begin_angle, follow_axis, improve_axes
from services.biomech.two_sensor_knee.joint_centre import IDLE, SOLVED, follow_joint
from services.biomech.two_sensor_knee.levelling import follow_level
from services.biomech.two_sensor_knee.memory import (
    SHANK,
    THIGH,
    Bench,
    FloatArray,
    Memory,
    Record,
)
from services.biomech.two_sensor_knee.slip import begin_again, has_slipped
from services.biomech.two_sensor_knee.turns import fill_relative, wrapped

CONTRADICTED = 2.0
"""Solutions of the joint in a row that contradict the heading, from which the angle is not valid."""


@compiled
def advance(memory: Memory, bench: Bench, rate: FloatArray, force: FloatArray, dt_s: float) -> None:
    """Take one sample of both sensors, rate (2, 3) rad/s and force (2, 3) m/s^2; leaves the reading in the bench.

    A sample that is not finite or beyond what a leg can do counts as missing: the reading is not valid and the next
    interval is longer. Intervals of 0 or less are no time and change nothing.
    """
    knee, parameters = memory.knee, bench.parameters
    memory.output[2] = 0.0
    interval_s = usable_interval(knee, rate, force, dt_s, parameters)
    if interval_s <= 0.0:
        return
    is_new = knee.known_s <= 0.0
    knee.known_s = max(knee.known_s - interval_s, 0.0)
    if interval_s > parameters.gap_s:
        bridge_gap(memory, interval_s, parameters.heading_drift)
        interval_s = dt_s if dt_s <= parameters.gap_s else parameters.joint_interval_s
    for s in range(2):
        follow_level(memory.levels[s], rate[s], force[s], interval_s, parameters, bench.R[s], is_new)
        for i in range(3):
            bench.rate[s, i] = rate[s, i] - memory.levels[s].bias[i]
    due = IDLE
    if is_new:
        due = learn_joint(memory, bench, force, interval_s)
    if knee.is_tied > 0.0:
        follow_hinge(memory, bench, due, is_new, interval_s)


@compiled
def learn_joint(memory: Memory, bench: Bench, force: FloatArray, dt_s: float) -> int:
    """Standing, the shared joint and the first tie; what is due, as `follow_joint` has it."""
    knee = memory.knee
    if knee.has_sample == 0.0:
        knee.has_sample = 1.0
        for s in range(2):
            for i in range(3):
                memory.rate_before[s, i] = bench.rate[s, i]
    take_standing(memory, bench)
    due = follow_joint(memory, bench, force, dt_s)
    if due == SOLVED:
        take_joint_heading(memory, bench)
    if knee.is_tied == 0.0:
        tie_without_joint(memory, bench, dt_s)
    return due


@compiled
def follow_hinge(memory: Memory, bench: Bench, due: int, is_new: bool, dt_s: float) -> None:
    """Heading, axis and angle of the sample, once the headings are tied.

    What changes slowly is looked at when it is `due`: axes on the grid of the joint, sign and zero at its solutions.
    """
    knee, parameters = memory.knee, bench.parameters
    if knee.has_angle > 0.0:
        tie(memory, bench, knee.axis_std, dt_s)
    fill_relative(bench.R[THIGH], bench.R[SHANK], knee.heading, bench.relative)
    for i in range(3):
        for k in range(3):
            bench.midway[i, k] = 0.5 * (bench.relative[i, k] + memory.relative[i, k])
            memory.relative[i, k] = bench.relative[i, k]
    is_moving = is_new and follow_axis(memory, bench, dt_s)
    if due != IDLE:
        improve_axes(memory, bench)
        if has_slipped(memory, bench, is_moving, parameters.joint_interval_s):
            begin_again(memory, bench)
            return
    if knee.has_angle == 0.0:
        if knee.moving_s < parameters.gathering_s:
            return
        begin_angle(memory, bench)
    follow_angle(memory, bench)
    if is_moving:
        follow_posture(memory, bench, dt_s)
    if due == SOLVED:
        settle(memory, parameters)
        if faces_the_other_way(memory):
            begin_hinge(memory, bench, wrapped(knee.heading + pi), RATES_HEADING_STD)
            knee.is_half_turn_open = 0.0
            return
    write_reading(memory, bench)


@compiled
def settle(memory: Memory, parameters: Record) -> None:
    """Say where the zero is and which way the knee bends."""
    if memory.posture.weight > 0.0:
        settle_zero(memory, parameters)
        settle_sign(memory, parameters)
    memory.knee.sensor_turn = turn_from_sensor_axes(memory.axes, memory.across)


@compiled
def write_reading(memory: Memory, bench: Bench) -> None:
    """OUTPUTS of the sample."""
    knee, parameters, output, axes, rate = memory.knee, bench.parameters, memory.output, memory.axes, bench.rate
    flexion_rate = 0.0
    for i in range(3):
        flexion_rate += axes[SHANK, i] * rate[SHANK, i] - axes[THIGH, i] * rate[THIGH, i]
    now = knee.angle + parameters.sample_delay_s * flexion_rate
    output[0] = wrapped(now - knee.zero)
    output[1] = angle_deviation(memory, bench, knee.axis_std)
    is_known = knee.axis_std < parameters.axis_to_believe and knee.is_sign_known > 0.0
    output[2] = 1.0 if is_known and knee.contradictions < CONTRADICTED else 0.0
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
        for i in range(3):
            level.force_fast[i], level.force[i] = 0.0, 0.0
    memory.knee.heading_variance += 1.0 + drift * drift * gap_s
    memory.knee.has_sample = 0.0


@compiled
def advance_many(
    memories: NDArray[np.void],
    benches: NDArray[np.void],
    rate: FloatArray,
    force: FloatArray,
    intervals_s: FloatArray,
    out: FloatArray,
) -> None:
    """`advance` over rate and force (n, 2, 3), intervals (n,); memories and benches (1,); out (n, 8) as OUTPUTS."""
    memory, bench = memories[0], benches[0]
    for i in range(rate.shape[0]):
        advance(memory, bench, rate[i], force[i], intervals_s[i])
        for k in range(out.shape[1]):
            out[i, k] = memory.output[k]
