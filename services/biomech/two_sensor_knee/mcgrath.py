"""The self-finding axis as published: McGrath, Fineman and Stirling 2018, eq. 1-3, over a whole recording.

Orientations are an input (any filter, any common world); the published method needs both in one global frame.
"""

import numpy as np
from numpy.typing import NDArray

from services.biomech.rotations import normalised

Array = NDArray[np.float64]


def relative_rate(R_world_from_thigh: Array, R_world_from_shank: Array, thigh_rate: Array, shank_rate: Array) -> Array:
    """Angular velocity (n, 3), rad/s, of the shank's sensor against the thigh's, in the shank's sensor (eq. 1)."""
    R_shank_from_thigh = np.swapaxes(R_world_from_shank, 1, 2) @ R_world_from_thigh
    return np.asarray(shank_rate - np.einsum("nij,nj->ni", R_shank_from_thigh, thigh_rate))


def principal_axis(rates: Array) -> Array:
    """First principal component (3,) of rates (n, 3), about their mean as PCA has it; its sign is arbitrary."""
    centred = rates - rates.mean(axis=0)
    return np.asarray(np.linalg.eigh(centred.T @ centred)[1][:, 2])


def segment_frame(axis: Array) -> Array:
    """R_sensor_from_segment (3, 3): z along the axis, y = axis x (1, 0, 0), x = y x z (eq. 2).

    Raises:
        ValueError: the axis is the sensor's x axis; the published frame does not exist there.
    """
    z = normalised(axis)
    y = normalised(np.cross(z, [1.0, 0.0, 0.0]))
    return np.stack([np.cross(y, z), y, z], axis=1)


def flexion_angle(R_shank_from_thigh: Array, axis_in_thigh: Array, axis_in_shank: Array) -> Array:
    """First of the z-x-y Euler angles (n,), rad, of the shank's segment frame in the thigh's (eq. 3).

    With R = Rz(a) Rx(b) Ry(c): tan a = -R01 / R11.
    """
    R_thigh_from_shank = np.swapaxes(R_shank_from_thigh, 1, 2)
    R = segment_frame(axis_in_thigh).T @ R_thigh_from_shank @ segment_frame(axis_in_shank)
    return np.arctan2(-R[:, 0, 1], R[:, 1, 1])


def knee_flexion(
    R_world_from_thigh: Array, R_world_from_shank: Array, thigh_rate: Array, shank_rate: Array
) -> tuple[Array, Array]:
    """Knee angle (n,), rad, and axis (2, 3) in thigh's and shank's sensor, both up to a common sign.

    The axis is found in the shank (frame B of the paper) and carried to the thigh by the mean relative orientation.
    """
    R_shank_from_thigh = np.swapaxes(R_world_from_shank, 1, 2) @ R_world_from_thigh
    in_shank = principal_axis(relative_rate(R_world_from_thigh, R_world_from_shank, thigh_rate, shank_rate))
    in_thigh = normalised(np.einsum("nij,i->nj", R_shank_from_thigh, in_shank).mean(axis=0))
    return flexion_angle(R_shank_from_thigh, in_thigh, in_shank), np.stack([in_thigh, in_shank])
