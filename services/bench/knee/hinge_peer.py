"""Any orientation filter made into a knee: axis by principal components, heading by the hinge, in turns. Offline.

What the literature offers for two sensors without magnetometer (McGrath 2018 for the axis, Laidig 2017 for the
heading), with the whole recording in hand: the strongest opponent that can be put together from kept parts.
"""

import numpy as np
from numpy.typing import NDArray

from services.biomech.rotations import normalised

Array = NDArray[np.float64]

HEADINGS = np.radians(np.arange(0.0, 360.0, 5.0))
NEAR_START = np.radians(np.arange(-40.0, 41.0, 5.0))
FINE = np.radians(np.arange(-4.0, 5.0, 1.0))
ROUNDS = 5
SMOOTH_S = 10.0
"""s over which the heading is averaged."""


def tie_headings(
    thigh: Array, shank: Array, rate: Array, rate_hz: float, start: float | None = None
) -> tuple[Array, Array]:
    """R_thigh_from_shank (n, 3, 3) and axes (2, 3), from R_world_from_sensor (n, 3, 3) of both, each with its own
    heading and z up, and rates (n, 2, 3).

    The heading begins where the principal component is clearest, near `start` (rad, of the turn that gives the shank
    the thigh's heading) where one is given: in walking there are two such headings.
    """
    in_world = np.einsum("snij,nsj->sni", np.stack([thigh, shank]), rate)
    coarse = HEADINGS if start is None else start + NEAR_START
    best = float(max(coarse, key=lambda heading: _share(thigh, in_world, np.full(1, heading))))
    best = float(max(best + FINE, key=lambda heading: _share(thigh, in_world, np.full(1, heading))))
    heading = np.full(len(rate), best)
    axes = np.zeros((2, 3))
    for _ in range(ROUNDS):
        axes = _axes(thigh, shank, in_world, heading)
        heading = _heading(thigh @ axes[0], shank @ axes[1], int(SMOOTH_S * rate_hz))
    return np.swapaxes(thigh, 1, 2) @ _about_vertical(heading) @ shank, axes


def heading_between(thigh: Array, shank: Array, thigh_known: Array, shank_known: Array) -> float:
    """Turn about the vertical, rad, that gives the shank the thigh's heading, from orientations (3, 3) of one instant
    beside those in one common world."""
    turn = thigh @ thigh_known.T @ shank_known @ shank.T
    return float(np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]))


def _relative_rate(in_world: Array, heading: Array) -> Array:
    """Rate (n, 3) of the shank against the thigh in the thigh's world."""
    turned = np.einsum("nij,nj->ni", np.broadcast_to(_about_vertical(heading), (in_world.shape[1], 3, 3)), in_world[1])
    return np.asarray(turned - in_world[0])


def _share(thigh: Array, in_world: Array, heading: Array) -> float:
    """Of the relative rate's scatter, seen from the thigh, along one line."""
    relative = np.einsum("nji,nj->ni", thigh, _relative_rate(in_world, heading))
    scatter = np.linalg.eigvalsh(relative.T @ relative)
    return float(scatter[2] / scatter.sum())


def _axes(thigh: Array, shank: Array, in_world: Array, heading: Array) -> Array:
    """Principal components of the relative rate in both sensors, of equal sense."""
    relative = _relative_rate(in_world, heading)
    back = np.einsum("nji,nj->ni", _about_vertical(heading), relative)
    axes = []
    for sensor, rates in ((thigh, relative), (shank, back)):
        seen = np.einsum("nji,nj->ni", sensor, rates)
        axes.append(np.linalg.eigh(seen.T @ seen)[1][:, 2])
    carried = np.einsum("nij,nj->ni", _about_vertical(heading), shank @ axes[1])
    along = float(np.sum((thigh @ axes[0]) * carried))
    return np.stack([axes[0], normalised(axes[1]) * (1.0 if along >= 0.0 else -1.0)])


def _heading(first: Array, second: Array, window: int) -> Array:
    """Turn (n,) about the vertical that lays the second axis' horizontal part on the first's, averaged."""
    product = (first[:, 0] + 1j * first[:, 1]) * np.conj(second[:, 0] + 1j * second[:, 1])
    summed = np.concatenate([[0.0], np.cumsum(product)])
    frames = np.arange(len(product))
    begin, end = np.maximum(frames - window // 2, 0), np.minimum(frames + window // 2 + 1, len(product))
    return np.asarray(np.angle(summed[end] - summed[begin]))


def _about_vertical(heading: Array) -> Array:
    """(n, 3, 3)"""
    R = np.zeros((len(heading), 3, 3))
    R[:, 0, 0] = R[:, 1, 1] = np.cos(heading)
    R[:, 1, 0] = np.sin(heading)
    R[:, 0, 1] = -R[:, 1, 0]
    R[:, 2, 2] = 1.0
    return R
