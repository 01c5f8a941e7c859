"""Joint angles of legs whose hips and ankles are known."""

from typing import NamedTuple

import numpy as np

from schemas.vocabulary import Side
from services.ingest.synthetic.jets import Array
from services.ingest.synthetic.patients.footfalls import LATERAL
from services.ingest.synthetic.patients.pelvis_path import LegLengths, PelvisPath, hips


class LegAngles(NamedTuple):
    """(n,) rad; the knee is a hinge."""

    hip_flexion: Array
    hip_adduction: Array
    knee_flexion: Array


class OutOfReach(ValueError):
    """An ankle is further from its hip than the leg is long."""


def leg_angles(path: PelvisPath, side: Side, ankle: Array, internal: Array, body: LegLengths) -> LegAngles:
    """Of one leg, given its hip's internal rotation (n,) rad.

    With v the ankle seen from the hip in the pelvis's axes and u the ankle seen from the hip of a leg that only its
    knee bends, Rz(flexion) Rx(adduction) w = v, w = Ry(internal) u. The first two rotations leave v's z to the
    adduction alone: w_y sin a + w_z cos a = v_z; what remains is a turn in the x-y plane. Raises OutOfReach.
    """
    outward = LATERAL[side]
    v = _into_pelvis(path, ankle - path.position - hips(path, side, body.hip_width))
    a, b = body.thigh, body.shank
    cosine = (np.sum(v**2, axis=1) - a * a - b * b) / (2 * a * b)
    # While standing straight it is 1, to within rounding.
    if cosine.max() > 1.0 + 1e-9:
        raise OutOfReach(f"an ankle is out of reach: the cosine of the knee is {cosine.max():.6f}")
    knee = np.arccos(np.clip(cosine, -1.0, 1.0))
    ux, uy = -b * np.sin(knee), -a - b * np.cos(knee)
    turn = internal * outward
    wx, wy, wz = ux * np.cos(turn), uy, -ux * np.sin(turn)
    radius = np.hypot(wy, wz)
    # wy < 0: of both solutions the one with the leg hanging down.
    about_x = np.arctan2(wz, -wy) - np.arcsin(np.clip(v[:, 2] / radius, -1.0, 1.0))
    down = np.cos(about_x) * wy - np.sin(about_x) * wz
    flexion = np.arctan2(v[:, 1], v[:, 0]) - np.arctan2(down, wx)
    return LegAngles((flexion + np.pi) % (2 * np.pi) - np.pi, outward * about_x, knee)


def _into_pelvis(path: PelvisPath, vectors: Array) -> Array:
    """R' v with R = Ry(rotation) Rz(-tilt) Rx(-obliquity)."""
    x, y, z = vectors.T
    cos, sin = np.cos(path.rotation), np.sin(path.rotation)
    x, z = cos * x - sin * z, sin * x + cos * z
    cos, sin = np.cos(path.tilt), np.sin(path.tilt)
    x, y = cos * x - sin * y, sin * x + cos * y
    cos, sin = np.cos(path.obliquity), np.sin(path.obliquity)
    y, z = cos * y - sin * z, sin * y + cos * z
    return np.column_stack([x, y, z])
