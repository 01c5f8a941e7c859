"""What `KneeAxis` remembers: records and arrays that compiled code works on in place.

Index 0 is the thigh's sensor, 1 the shank's. World: y up; horizontal vectors are complex numbers z + i x, so that a
turn by `a` about the up axis multiplies by exp(i a).
"""

from dataclasses import astuple, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.two_sensor_knee.parameters import KneeAxisParameters
from services.flow.node import State, pack_array, unpack_array

FloatArray = NDArray[np.float64]
Record = Any
"""One element of a structured array. Compiled code reads and writes its fields as attributes."""

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
    ]
)

POSTURE = np.dtype(
    [(name, np.float64) for name in ("weight", "angle", "height", "upright", "angle_height", "angle2", "height2")]
)
"""Running moments in motion: angle, height of the thigh's sensor over the shank's and, as `upright`, over the knee."""

PARAMETERS = np.dtype([(field.name, np.float64) for field in fields(KneeAxisParameters)])
OUTPUTS = (
    "flexion", "flexion_std", "is_valid", "flexion_rate", "axis_std", "flexion_from_sensor_axes", "is_sign_known",
    "datum",
)  # fmt: skip
"""Columns of a run: rad and rad/s; `datum` counts as `knee_axis.Datum`."""


class Memory(NamedTuple):
    """Everything that changes."""

    levels: NDArray[np.void]  # (2,) LEVEL
    knee: NDArray[np.void]  # (1,) KNEE
    posture: NDArray[np.void]  # (1,) POSTURE
    rate_before: FloatArray  # (2, 3) rad/s
    joint_fast: FloatArray  # (2, 3, 4) world: specific force, and the arm's effect, after the first low-pass
    joint: FloatArray  # (2, 3, 4) after the second
    vertical: FloatArray  # (8, 8) running products of the vertical row
    horizontal_real: FloatArray  # (8, 8) of the horizontal ones
    horizontal_imaginary: FloatArray  # (8, 8)
    arms: FloatArray  # (2, 3) m, sensor to knee, in the sensor
    scatter: FloatArray  # (2, 3, 3) rad^2/s of the relative rate
    axes: FloatArray  # (2, 3) flexion axis in each sensor
    across: FloatArray  # (2, 3) direction across the axis; both agree where the angle is 0
    standing: FloatArray  # (2, 3) the vertical in each sensor at the tallest rest
    relative: FloatArray  # (3, 3) R_thigh_from_shank at the last sample


class Bench(NamedTuple):
    """What follows from the parameters, and scratch room. Nothing here outlives a step."""

    parameters: NDArray[np.void]  # (1,) PARAMETERS
    rate: FloatArray  # (2, 3) rad/s, bias removed
    R: FloatArray  # (2, 3, 3) R_world_from_sensor
    relative: FloatArray  # (3, 3) R_thigh_from_shank
    midway: FloatArray  # (3, 3) the same in the middle of the interval, which the rates are the mean of
    normal: FloatArray  # (7, 7) scratch of the joint centre
    output: FloatArray  # (len(OUTPUTS),)


def allocate_memory(parameters: KneeAxisParameters) -> Memory:
    """A memory that has seen nothing."""
    levels = np.zeros(2, LEVEL)
    levels["quat"][:, 0] = 1.0
    for sensor in range(2):
        levels["bias_covariance"][sensor] = parameters.start_bias_std**2 * np.eye(3)
    shapes: dict[str, tuple[int, ...]] = {
        "rate_before": (2, 3), "joint_fast": (2, 3, 4), "joint": (2, 3, 4), "vertical": (8, 8),
        "horizontal_real": (8, 8), "horizontal_imaginary": (8, 8), "arms": (2, 3), "scatter": (2, 3, 3),
        "axes": (2, 3), "across": (2, 3), "standing": (2, 3),
        "relative": (3, 3),
    }  # fmt: skip
    arrays = {name: np.zeros(shape) for name, shape in shapes.items()}
    return Memory(levels=levels, knee=np.zeros(1, KNEE), posture=np.zeros(1, POSTURE), **arrays)


def prepare_bench(parameters: KneeAxisParameters) -> Bench:
    """Derive what the parameters fix."""
    return Bench(
        parameters=np.array([astuple(parameters)], PARAMETERS),
        rate=np.zeros((2, 3)),
        R=np.zeros((2, 3, 3)),
        relative=np.zeros((3, 3)),
        midway=np.zeros((3, 3)),
        normal=np.zeros((7, 7)),
        output=np.zeros(len(OUTPUTS)),
    )


def pack_memory(memory: Memory) -> State:
    """The memory as JSON values."""
    return {
        name: pack_array(array.view(np.float64) if array.dtype.names else array)
        for name, array in memory._asdict().items()
    }


def unpack_memory(state: State, memory: Memory) -> None:
    """Fill `memory` from what `pack_memory` gave.

    Raises:
        ValueError: the snapshot is of another kind of estimator.
    """
    for name, array in memory._asdict().items():
        saved = unpack_array(state[name])
        target = array.view(np.float64) if array.dtype.names else array
        if saved.shape != target.shape:
            raise ValueError(f"knee snapshot: {name} has shape {saved.shape}, this estimator needs {target.shape}")
        target[...] = saved
