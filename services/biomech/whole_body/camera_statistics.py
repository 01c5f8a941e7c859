"""What the camera's noise is, from recordings: against a reference, or from what must be still or of one length."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from services.biomech.whole_body.model import CENTRE_NAMES, previous_centres
from services.biomech.whole_body.start import States

Array = NDArray[np.float64]

MOVEMENT_HZ = 1.0
"""Below it lies what a filter takes for movement; noise there counts in full."""
OUTLIER_FRAMES = 5
"""Of the running median that takes out single frames far off."""
MAD_TO_STD = 1.4826


def measurement_variance(seen: Array, reference: Array, state: States) -> tuple[Array, Array]:
    """Mean (3,) m and variance (3,) m^2 per axis of tracked centres (t, 15, 3) against a reference (section 3.4).

    The variance holds constant offsets as well as noise, so a filter with bias states needs less.
    """
    error = (seen - reference)[(state == 2) & np.isfinite(seen).all(axis=2)]
    return error.mean(axis=0), error.var(axis=0)


def still_variance(centres: Array, state: States) -> Array:
    """(15, 3) m^2 of white noise per centre and axis, from a part (t, 15, 3) in which the person stands still.

    Second differences know no sway: for white noise their variance is six times its own. Robust against outliers; NaN
    for a centre with fewer than five runs of three tracked frames.
    """
    seen = np.where((state == 2)[..., None], centres, np.nan)
    bend = seen[2:] - 2.0 * seen[1:-1] + seen[:-2]
    variance = np.full(bend.shape[1:], np.nan)
    for m in range(bend.shape[1]):
        known = bend[np.isfinite(bend[:, m]).all(axis=1), m]
        if len(known) >= 5:
            variance[m] = (MAD_TO_STD * np.median(np.abs(known), axis=0)) ** 2 / 6.0
    return variance


def along_bones(centres: Array, state: States, rate_hz: float, below_hz: float = MOVEMENT_HZ) -> float:
    """`CameraNoise.along`: variance, in squared bones, of white noise that is as strong below a frequency as what the
    lengths of bones seen in (t, 15, 3) do there.

    Bones have one length, so whatever else is seen is the camera's, also in movement. Median over the bones.

    Raises:
        ValueError: no bone is tracked in half of the frames, or there are fewer than 2 s.
    """
    if len(centres) < 2.0 * rate_hz:
        raise ValueError(f"the wander of bones needs 2 s, not {len(centres)} frames at {rate_hz:g} Hz")
    frequency = np.fft.rfftfreq(len(centres), 1.0 / rate_hz)
    slow = (frequency > 0.0) & (frequency <= below_hz)
    shares = []
    for centre, before in previous_centres().items():
        pair = [CENTRE_NAMES.index(centre), CENTRE_NAMES.index(before)]
        tracked = (state[:, pair] == 2).all(axis=1) & np.isfinite(centres[:, pair]).all(axis=(1, 2))
        if tracked.mean() < 0.5:
            continue
        at = np.flatnonzero(tracked)
        length = np.linalg.norm(centres[at, pair[0]] - centres[at, pair[1]], axis=1)
        even = median_filter(np.interp(np.arange(len(centres)), at, length), OUTLIER_FRAMES, mode="nearest")
        power = np.abs(np.fft.rfft(even - even.mean())[slow]) ** 2 / len(even)
        shares.append(power.mean() / np.median(length) ** 2)
    if not shares:
        raise ValueError("no bone is tracked in half of the frames")
    return float(np.median(shares))
