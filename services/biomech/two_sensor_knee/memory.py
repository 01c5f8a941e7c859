"""What `KneeAxis` remembers: records and arrays that compiled code works on in place.

Index 0 is the thigh's sensor, 1 the shank's. World: y up; horizontal vectors are complex numbers z + i x, so that a
turn by `a` about the up axis multiplies by exp(i a).
"""

from dataclasses import astuple, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.biomech.two_sensor_knee.parameters import KneeAxisParameters
from services.flow.node import State, pack_array, unpack_array

FloatArray = NDArray[np.float64]
Record = Any
"""One element of a structured array. Compiled code reads and writes its fields as attributes, and passes it on as one
address: arrays by themselves would be taken apart at each call."""
Memory = Bench = Record
"""Of dtype MEMORY and BENCH."""

THIGH, SHANK = 0, 1

LEVEL = np.dtype(
    [
        ("quat", np.float64, 4),  # world from sensor
        ("force_fast", np.float64, 3),  # m/s^2 in the world, after the first low-pass
        ("force", np.float64, 3),  # after the second
        ("bias", np.float64, 3),  # rad/s in the sensor
        ("bias_covariance", np.float64, (3, 3)),
        ("rows_fast", np.float64, (2, 3)),  # rows x and z of R_world_from_sensor, low-passed like the force
        ("rows", np.float64, (2, 3)),
        ("removed_fast", np.float64, 2),  # rad/s, horizontal part of the removed bias, low-passed like the force
        ("removed", np.float64, 2),
        ("tilted_fast", np.float64, 2),  # rad/s, turn by the force of the instant, low-passed like the force
        ("tilted", np.float64, 2),
        ("calm_rate", np.float64, 3),  # rad/s, what rest is measured against
        ("calm_force", np.float64, 3),  # m/s^2
        ("elapsed_s", np.float64),  # since levelling began
        ("rest_s", np.float64),
    ]
)

KNEE = np.dtype(
    [
        ("heading", np.float64),  # rad, world of the shank's sensor to that of the thigh's
        ("heading_variance", np.float64),
        ("is_tied", np.float64),
        ("joint_heading", np.float64),  # rad, told by the shared joint
        ("joint_coherence", np.float64),
        ("joint_power", np.float64),  # (m/s^2)^2
        ("joint_moving_s", np.float64),
        ("contradictions", np.float64),
        ("is_half_turn_open", np.float64),  # the headings were tied by the rates: the shank may face the other way
        ("since_products_s", np.float64),
        ("since_solution_s", np.float64),
        ("moving_s", np.float64),  # of relative motion in the scatter
        ("axis_std", np.float64),  # rad
        ("has_angle", np.float64),
        ("angle", np.float64),  # rad, unwrapped, from the pose at which the headings were tied
        ("zero", np.float64),  # rad, the datum in terms of `angle`
        ("sensor_turn", np.float64),  # rad, from `angle` to McGrath's datum
        ("standing_angle", np.float64),  # rad, of the tallest rest in terms of `angle`
        ("is_zero_set", np.float64),
        ("has_standing", np.float64),  # a rest is remembered
        ("is_standing", np.float64),  # and it was standing
        ("untied_moving_s", np.float64),  # of motion without a tie
        ("rates_real", np.float64),  # direction of both horizontal rates, squared: see heading.py
        ("rates_imaginary", np.float64),
        ("is_sign_known", np.float64),
        ("unused_s", np.float64),  # time of samples that could not be used
        ("has_sample", np.float64),
        ("known_s", np.float64),  # ahead, that were seen before: nothing is learned from them
    ]
)

POSTURE = np.dtype(
    [
        (name, np.float64)
        for name in ("weight", "angle", "height", "upright", "angle_height", "angle2", "angle3", "height2")
    ]
)
"""Running moments in motion: angle, height of the thigh's sensor over the shank's and, as `upright`, over the knee."""

SLIP = np.dtype(
    [
        ("scatter", np.float64, (2, 3, 3)),  # rad^2/s of the relative rate in the last seconds of motion
        ("axes", np.float64, (2, 3)),  # its first components
        ("moving_s", np.float64),  # of motion in it
        ("arms", np.float64, (2, 3)),  # m, as they were when the axis had settled
        ("has_arms", np.float64),
        ("suspected_s", np.float64),  # of motion in which axis or arms differed
        ("count", np.float64),  # of slips
    ]
)
"""What tells a sensor that has slipped."""

PARAMETERS = np.dtype([(field.name, np.float64) for field in fields(KneeAxisParameters)])
OUTPUTS = (
    "flexion", "flexion_std", "is_valid", "flexion_rate", "axis_std", "flexion_from_sensor_axes", "is_sign_known",
    "datum",
)  # fmt: skip
"""Columns of a run: rad and rad/s; `datum` counts as `knee_axis.Datum`."""


MEMORY = np.dtype(
    [
        ("levels", LEVEL, 2),
        ("knee", KNEE),
        ("posture", POSTURE),
        ("slip", SLIP),
        ("rate_before", np.float64, (2, 3)),  # rad/s
        ("joint_fast", np.float64, (2, 3, 4)),  # world: specific force, and the arm's effect, after the first low-pass
        ("joint", np.float64, (2, 3, 4)),  # after the second
        ("vertical", np.float64, (8, 8)),  # running products of the vertical row
        ("horizontal_real", np.float64, (8, 8)),  # of the horizontal ones
        ("horizontal_imaginary", np.float64, (8, 8)),
        ("arms", np.float64, (2, 3)),  # m, sensor to knee, in the sensor
        ("scatter", np.float64, (2, 3, 3)),  # rad^2/s of the relative rate
        ("axes", np.float64, (2, 3)),  # flexion axis in each sensor
        ("across", np.float64, (2, 3)),  # direction across the axis; both agree where the angle is 0
        ("leftward", np.float64, (2, 3)),  # declared direction of the person's left in each sensor; 0: not declared
        ("upward", np.float64, (2, 3)),  # declared direction up the segment; 0: not declared
        ("standing", np.float64, (2, 3)),  # the vertical in each sensor at the tallest rest
        ("relative", np.float64, (3, 3)),  # R_thigh_from_shank at the last sample
        ("output", np.float64, len(OUTPUTS)),  # of the last sample
    ]
)
"""Everything that changes."""

BENCH = np.dtype(
    [
        ("parameters", PARAMETERS),
        ("rate", np.float64, (2, 3)),  # rad/s, bias removed
        ("R", np.float64, (2, 3, 3)),  # R_world_from_sensor
        ("relative", np.float64, (3, 3)),  # R_thigh_from_shank
        ("midway", np.float64, (3, 3)),  # the same in the middle of the interval, which the rates are the mean of
        ("normal", np.float64, (7, 7)),  # scratch of the joint centre
    ]
)
"""What follows from the parameters, and scratch room. Nothing here outlives a step."""


def allocate_memory(parameters: KneeAxisParameters) -> NDArray[np.void]:
    """A memory (1,) MEMORY that has seen nothing."""
    memory = np.zeros(1, MEMORY)
    levels = memory["levels"][0]
    levels["quat"][:, 0] = 1.0
    levels["bias_covariance"][:] = parameters.start_bias_std**2 * np.eye(3)
    return memory


def prepare_bench(parameters: KneeAxisParameters) -> NDArray[np.void]:
    """Derive what the parameters fix, as (1,) BENCH."""
    bench = np.zeros(1, BENCH)
    bench["parameters"] = np.array([astuple(parameters)], PARAMETERS)
    return bench


def pack_memory(memory: NDArray[np.void]) -> State:
    """The memory as JSON values."""
    return {name: pack_array(_plain(memory, name)) for name in MEMORY.names or ()}


def unpack_memory(state: State, memory: NDArray[np.void]) -> None:
    """Fill `memory` from what `pack_memory` gave.

    Raises:
        ValueError: the snapshot is of another kind of estimator.
    """
    for name in MEMORY.names or ():
        saved, target = unpack_array(state[name]), _plain(memory, name)
        if saved.shape != target.shape:
            raise ValueError(f"knee snapshot: {name} has shape {saved.shape}, this estimator needs {target.shape}")
        target[...] = saved


def _plain(memory: NDArray[np.void], name: str) -> FloatArray:
    """One field of the memory as a view of numbers."""
    field = memory[0][name]
    return np.atleast_1d(field).view(np.float64) if field.dtype.names else field
