"""Tunables of the fusion, and what is known of the errors of both sources before they are compared.

Sources: [I] errors of the inertial estimator on walks with optical truth; [C] of the camera's on simulated Kinect v2
recordings, see the README of whole_body; [F] chosen on simulated walkers with seeds below 100.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import LOWER_BODY, WHOLE_BODY

Array = NDArray[np.float64]

SHARED = tuple(dof.name for dof in WHOLE_BODY if dof.name in {each.name for each in LOWER_BODY})
"""Angles that both sources tell, in the order of WHOLE_BODY."""

INERTIAL_OFFSET_DEG = {
    "pelvis_rotation": 90.0, "pelvis_tilt": 1.0, "pelvis_obliquity": 1.0,
    "hip_flexion": 1.0, "hip_adduction": 1.0, "hip_internal_rotation": 3.0, "knee_flexion": 1.0,
}  # fmt: skip
"""What a camera can know better. The zero of both sources is the same standing, taken for the posture of people: how
far this person's is from that is in both, and no difference shows it. What differs is nearly all the camera's. Nothing
tells inertial sensors where the camera is, so their heading is any; axial rotation drifts a little."""

CAMERA_OFFSET_DEG = {
    "pelvis_rotation": 4.0, "pelvis_tilt": 8.0, "pelvis_obliquity": 3.0,
    "hip_flexion": 10.0, "hip_adduction": 5.0, "hip_internal_rotation": 8.0, "knee_flexion": 10.0,
}  # fmt: skip
"""Standard deviation of what the camera adds to that, in walking; [C]."""

CAMERA_NOISE_DEG = {
    "pelvis_rotation": 5.0, "pelvis_tilt": 4.0, "pelvis_obliquity": 2.0,
    "hip_flexion": 4.0, "hip_adduction": 3.0, "hip_internal_rotation": 6.0, "knee_flexion": 5.0,
}  # fmt: skip
"""What the camera's error does beside its offset, [C]."""


def per_shared(table: dict[str, float]) -> Array:
    """(11,) rad: the value of the table for each shared angle."""
    return np.radians([table[name.removesuffix("_right").removesuffix("_left")] for name in SHARED])


@dataclass(frozen=True)
class FusionParameters:
    """How offsets and the camera's manner are learned."""

    inertial_offset: Array = field(default_factory=lambda: per_shared(INERTIAL_OFFSET_DEG))
    """(11,) rad."""
    camera_offset: Array = field(default_factory=lambda: per_shared(CAMERA_OFFSET_DEG))
    """(11,) rad."""
    camera_noise: Array = field(default_factory=lambda: per_shared(CAMERA_NOISE_DEG))
    """(11,) rad."""
    camera_noise_s: float = 0.5
    """s for which an error of the camera stays the same: so many frames tell as much as one. [F]"""
    manner_noise_s: float = 0.03
    """The same for the manner, whose terms change within a stride, as much of the error does. [F]"""
    inertial_memory_s: float = 300.0
    """s after which an offset of the inertial sensors is another. [I]"""
    camera_memory_s: float = 120.0
    """s, of the camera. [F]"""
    scale_std: float = 0.15
    """Spread of what the camera makes of 1 rad; a filter that is behind a quick movement makes less. [F]"""
    delay_std: float = 0.06
    """s by which the camera is late; latency of a Kinect is 60 to 90 ms, and its filter adds or takes some."""
    manner_memory_s: float = 60.0
    """s after which the camera's manner is another: the person has moved elsewhere. [F]"""
    harmonics: int = 4
    """Of the stride that the camera's manner may have; two leave 1 deg more at the knee, six gain 0.2 deg. [F]"""
    stride_noise: float = 4.0
    """Spread of the first harmonic's coefficients, in the camera's noise; others are smaller by their order. [F]"""
    residual_memory_s: float = 20.0
    """s over which it is averaged how well the camera's manner is known."""
    joined_s: float = 0.3
    """s in which a change from one source to the other fades."""
