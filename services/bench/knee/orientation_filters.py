"""Orientation of one sensor without magnetometer by kept libraries: world z up, heading from the start."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
Filter = Callable[[Array, Array, float], Array]

GRAVITY = 9.81


def by_vqf(rate: Array, force: Array, rate_hz: float) -> Array:
    """R_world_from_sensor (n, 3, 3) by VQF (Laidig and Seel 2023), 6D, from rate and force (n, 3)."""
    from vqf import VQF

    found = VQF(1.0 / rate_hz).updateBatch(np.ascontiguousarray(rate), np.ascontiguousarray(force))
    return _matrices(found["quat6D"])


def by_madgwick(rate: Array, force: Array, rate_hz: float) -> Array:
    """The same by `ahrs.filters.Madgwick` with its own gain."""
    from ahrs.filters import Madgwick

    return _matrices(Madgwick(gyr=rate, acc=force, frequency=rate_hz).Q)


def by_mahony(rate: Array, force: Array, rate_hz: float) -> Array:
    """The same by `ahrs.filters.Mahony` with its own gains."""
    from ahrs.filters import Mahony

    return _matrices(Mahony(gyr=rate, acc=force, frequency=rate_hz).Q)


def by_imufusion(rate: Array, force: Array, rate_hz: float) -> Array:
    """The same by `imufusion` with its own settings, its correction of the gyroscope's bias included."""
    import imufusion

    settings, bias_settings = imufusion.AhrsSettings(), imufusion.BiasSettings()
    settings.sample_rate = bias_settings.sample_rate = rate_hz
    ahrs, bias = imufusion.Ahrs(), imufusion.Bias()
    ahrs.set_settings(settings)
    bias.set_settings(bias_settings)
    quats = np.empty((len(rate), 4))
    for k, (degrees, shares) in enumerate(zip(np.degrees(rate), force / GRAVITY, strict=True)):
        ahrs.update_no_magnetometer(bias.update(degrees), shares)
        quats[k] = ahrs.get_quaternion()
    return _matrices(quats)


FILTERS: dict[str, tuple[Filter, str]] = {
    "VQF": (by_vqf, "vqf"),
    "Madgwick (ahrs)": (by_madgwick, "ahrs"),
    "Mahony (ahrs)": (by_mahony, "ahrs"),
    "imufusion": (by_imufusion, "imufusion"),
}
"""By name: the filter and the library it needs."""


def _matrices(quats: Array) -> Array:
    return np.asarray(Rotation.from_quat(np.asarray(quats), scalar_first=True).as_matrix())
