"""Tunables of the whole body, and what is known of people before any is seen.

Sources: [C] Colombel et al. 2020; [K] found on simulated Kinect v2 recordings of one tuning person, see README;
[P] body proportions and standing postures of adults, as in that simulation.
"""

from dataclasses import dataclass, field
from math import radians

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import WHOLE_BODY
from services.biomech.whole_body.kernels.tables import COORDINATES
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, LENGTH_NAMES, PARTNERS

Array = NDArray[np.float64]

NOMINAL_DT_S = 1.0 / 30.0

LIMITS_DEG = {
    "pelvis_rotation": (-90.0, 90.0), "pelvis_tilt": (-45.0, 100.0), "pelvis_obliquity": (-45.0, 45.0),
    "hip_flexion": (-30.0, 130.0), "hip_adduction": (-45.0, 30.0), "hip_internal_rotation": (-45.0, 45.0),
    "knee_flexion": (0.0, 150.0), "trunk_flexion": (-35.0, 80.0), "clavicle_elevation": (-15.0, 35.0),
    "shoulder_flexion": (-60.0, 170.0), "shoulder_adduction": (-130.0, 30.0),
    "shoulder_internal_rotation": (-80.0, 80.0), "elbow_flexion": (0.0, 145.0),
}  # fmt: skip
"""Physiological range of each angle, [P]. That of pelvis_rotation is against the heading at the start."""

REST_DEG = {
    "pelvis_rotation": (0.0, 10.0), "pelvis_tilt": (3.0, 6.0), "pelvis_obliquity": (0.0, 3.0),
    "hip_flexion": (3.0, 6.0), "hip_adduction": (-5.0, 4.0), "hip_internal_rotation": (-3.0, 8.0),
    "knee_flexion": (4.0, 4.0), "trunk_flexion": (3.0, 5.0), "clavicle_elevation": (0.0, 4.0),
    "shoulder_flexion": (0.0, 7.0), "shoulder_adduction": (-10.0, 5.0), "shoulder_internal_rotation": (5.0, 11.0),
    "elbow_flexion": (12.0, 6.0),
}  # fmt: skip
"""Standing at ease: mean and spread among people, [P]."""

STATURE_SHARE = {
    "half_pelvis": 0.048, "thigh": 0.245, "shank": 0.246, "trunk": 0.290, "clavicle": 0.098, "upper_arm": 0.172,
    "forearm": 0.150,
}  # fmt: skip
"""Length / stature, [P]."""

MEAN_STATURE = 1.74
"""m."""

LENGTH_RANGE = 0.2
"""Lengths stay within this share of where they started. [C]"""


def unsided(name: str) -> str:
    """Name of an angle or a length without its side."""
    return name.removesuffix("_right").removesuffix("_left")


def per_angle(table: dict[str, tuple[float, float]]) -> Array:
    """(22, 2) rad: both values of the table for each angle."""
    return np.radians([table[unsided(dof.name)] for dof in WHOLE_BODY])


def lengths_of(stature: float) -> Array:
    """(12,) m, mean lengths of people of that stature."""
    return stature * np.array([STATURE_SHARE[unsided(name)] for name in LENGTH_NAMES])


def length_covariance(lengths: Array, spread: float) -> Array:
    """(12, 12) m^2: each length varies by `spread` of itself; of that, 98 % are common to both sides."""
    covariance = np.diag((spread * lengths) ** 2)
    for right, left in PARTNERS:
        covariance[right, left] = covariance[left, right] = 0.98 * spread**2 * lengths[right] * lengths[left]
    return covariance


@dataclass(frozen=True)
class CameraNoise:
    """What the camera is believed."""

    variance: float = 8e-4
    """m^2 per axis of a tracked centre. Above the white noise: offsets are not all constant. [K]"""
    along: float = 0.1
    """More along the bone that leads to a centre, in squares of that bone: centres slide along bones for seconds,
    which white noise of the same size would not say. [K]"""
    inferred: float = 25.0
    """Factor on the variance of an inferred centre. [K]"""
    stretch: float = 0.06
    """m. A bone seen longer or shorter by this much doubles the variance of both its ends, more by the square;
    0: never. [K]"""
    gate: float = 6.0
    """Squared innovation of a centre, in variances, from which its variance grows by the square. Leaving it out
    altogether is worse. [K]"""
    swap_scale: float = 0.05
    """m."""
    swap_most: float = 25.0
    """Squared misfit, in scales, that one axis adds at most."""
    swap_share: float = 0.5
    """Legs are exchanged back if that leaves less than this share of the misfit; 0: never."""

    def per_centre(self) -> tuple[Array, Array]:
        """(15,) m^2 per axis, and squares of the bone along it."""
        return np.full(len(CENTRE_NAMES), self.variance), np.full(len(CENTRE_NAMES), self.along)


@dataclass(frozen=True)
class ProcessNoise:
    """White jerk, rad^2/s^5 and m^2/s^5, in the 11 groups of the paper: 4 of the legs, 4 of the arms, 2 of the base, 1
    of the trunk; both sides share. `held`: a jerk constant over each frame, rad^2/s^6 (eq. 6). [K]
    """

    hip_flexion: float = 2000.0
    hip_adduction: float = 60.0
    hip_rotation: float = 30.0
    knee: float = 5000.0
    clavicle: float = 5.0
    shoulder: float = 20.0
    shoulder_rotation: float = 2.0
    elbow: float = 20.0
    base_translation: float = 60.0
    base_rotation: float = 20.0
    trunk: float = 10.0
    held: bool = False

    def densities(self) -> Array:
        """(25,) of each coordinate."""
        return np.asarray(self.groups()[GROUP])

    def groups(self) -> Array:
        """(11,)."""
        return np.array([getattr(self, name) for name in GROUPS])

    @classmethod
    def of_groups(cls, values: Array, *, held: bool = False) -> "ProcessNoise":
        """From the 11 values, in the order of GROUPS."""
        return cls(**dict(zip(GROUPS, map(float, values), strict=True)), held=held)


GROUPS = (
    "hip_flexion", "hip_adduction", "hip_rotation", "knee", "clavicle", "shoulder", "shoulder_rotation", "elbow",
    "base_translation", "base_rotation", "trunk",
)  # fmt: skip
"""The 11 parameters that are tuned."""

_GROUP_OF = {
    "pelvis_rotation": "base_rotation", "pelvis_tilt": "base_rotation", "pelvis_obliquity": "base_rotation",
    "hip_flexion": "hip_flexion", "hip_adduction": "hip_adduction", "hip_internal_rotation": "hip_rotation",
    "knee_flexion": "knee", "trunk_flexion": "trunk", "clavicle_elevation": "clavicle",
    "shoulder_flexion": "shoulder", "shoulder_adduction": "shoulder",
    "shoulder_internal_rotation": "shoulder_rotation", "elbow_flexion": "elbow",
}  # fmt: skip

GROUP = np.array(
    [GROUPS.index("base_translation")] * 3 + [GROUPS.index(_GROUP_OF[unsided(dof.name)]) for dof in WHOLE_BODY]
)
"""(25,) group of each coordinate."""


@dataclass(frozen=True)
class SoftPriors:
    """Angles that centres hardly show are drawn to the rest posture at every frame."""

    spread_deg: dict[str, float] = field(
        default_factory=lambda: {
            "hip_internal_rotation": 10.0, "shoulder_internal_rotation": 12.0, "hip_adduction": 10.0,
            "trunk_flexion": 15.0, "clavicle_elevation": 8.0, "pelvis_tilt": 12.0,
        }
    )  # fmt: skip
    """Spread of such an angle in movement. [K]"""
    weight: float = 30.0
    """Variance of one frame's prior at 30 Hz, in squares of the spread. [K]"""

    def columns(self) -> NDArray[np.int64]:
        """Coordinates concerned."""
        names = [name for name in DOF if unsided(name) in self.spread_deg]
        return np.array([3 + DOF[name] for name in names], dtype=np.int64)

    def variances(self) -> Array:
        """rad^2, per frame at 30 Hz."""
        names = [name for name in DOF if unsided(name) in self.spread_deg]
        return self.weight * np.array([radians(self.spread_deg[unsided(name)]) ** 2 for name in names])


NO_PRIORS = SoftPriors(spread_deg={})


@dataclass(frozen=True)
class StartNoise:
    """How sure the start is."""

    position_std: float = 0.05
    """m of the base."""
    base_velocity_std: float = 0.1
    """m/s."""
    angular_velocity_std: float = 0.3
    """rad/s."""
    base_acceleration_std: float = 1.0
    """m/s^2."""
    angular_acceleration_std: float = 3.0
    """rad/s^2."""
    length_spread: float = 0.03
    """Share by which lengths differ from those of the stature."""
    bias_std: tuple[float, float, float] = (0.03, 0.03, 0.03)
    """m: depth, height, sideways. Constant offset of a centre."""

    def rate_variances(self) -> tuple[Array, Array]:
        """(25,) variance of the velocities and of the accelerations."""
        velocity = np.full(COORDINATES, self.angular_velocity_std**2)
        acceleration = np.full(COORDINATES, self.angular_acceleration_std**2)
        velocity[:3], acceleration[:3] = self.base_velocity_std**2, self.base_acceleration_std**2
        return velocity, acceleration


START_NOISE = StartNoise()
