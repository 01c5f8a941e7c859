"""Multibody kinematics optimisation: the model fitted to each frame, within bounds (Begon et al. 2018).

The reference method over a whole recording, and what sets posture and lengths of the first frames (Colombel,
section 3.4).
"""

from dataclasses import dataclass
from math import radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, filtfilt

from services.biomech.whole_body.kernels.fit import fit
from services.biomech.whole_body.kernels.tables import COORDINATES, SEEN, WORK, Bounds, table
from services.biomech.whole_body.model import CENTRE_NAMES, MODEL, WholeBodyModel
from services.biomech.whole_body.parameters import (
    LENGTH_RANGE,
    LIMITS_DEG,
    REST_DEG,
    lengths_of,
    per_angle,
)
from services.biomech.whole_body.start import States, heading, measured_lengths, median_centres, stature_told_by

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FitParameters:
    """How centres are weighed against what is known of bodies."""

    centre_std: float = 0.03
    """m."""
    inferred: float = 25.0
    """Factor on the variance of an inferred centre."""
    rest_spread: float = 10.0
    """Spread of a first posture, in spreads of the rest posture: it may be any."""
    length_spread: float = 0.06
    """Share by which lengths differ from those of the stature."""
    step_std: float = radians(60.0)
    """rad. What centres do not show stays near the frame before."""
    cutoff_hz: float = 4.0
    """Hz of the zero-phase low-pass over the centres of a recording; 0 for none."""
    most_steps: int = 20
    first_fits: int = 20
    """Fits of a recording's first frame, each from the one before: it has no frame before to be drawn to."""


DEFAULT = FitParameters()


class Fit(NamedTuple):
    """One fitted frame."""

    q: Array  # (25,) m and rad
    lengths: Array  # (12,) m
    rms: float  # m, of the centres there were


def fit_frame(
    centres: Array, state: States, stature: float | None = None,
    parameters: FitParameters = DEFAULT, model: WholeBodyModel = MODEL,
) -> Fit:  # fmt: skip
    """Posture and lengths at once, from one set of centres (15, 3) or, better, the median of several frames.

    Raises:
        ValueError: there is no centre at all.
    """
    if not _there(centres, state).any():
        raise ValueError("no joint centre is there: a first fit needs at least one frame with the body in view")
    measured = measured_lengths(model, np.where(_there(centres, state)[:, None], centres, np.nan))
    lengths = lengths_of(stature if stature is not None else stature_told_by(measured))
    rest, spread = per_angle(REST_DEG).T
    value = np.concatenate([np.zeros(3), rest, lengths])
    turned = heading(centres)
    value[3] = turned if np.isfinite(turned) else 0.0
    value[:3] = np.nanmedian(
        np.where(_there(centres, state)[:, None], centres - model.centres(value[:COORDINATES], lengths), np.nan), axis=0
    )
    stiffness = np.zeros(SEEN)
    stiffness[3:COORDINATES] = (parameters.rest_spread * spread) ** -2
    stiffness[COORDINATES:] = (parameters.length_spread * lengths) ** -2
    bounds = _bounds(value[3], lengths)
    return _fit(value.copy(), SEEN, centres, state, value, stiffness, bounds, parameters, model)


def fit_recording(
    centres: Array, state: States, rate_hz: float, stature: float | None = None,
    parameters: FitParameters = DEFAULT, model: WholeBodyModel = MODEL,
) -> tuple[Array, Array]:  # fmt: skip
    """q (t, 25) and lengths (12,) of frames (t, 15, 3) with state (t, 15).

    Lengths are the medians over the recording; of a bone that was never seen, the first fit's. Frames without a
    centre are bridged before the low-pass.
    """
    first = fit_frame(median_centres(centres, state), np.full(len(CENTRE_NAMES), 2), stature, parameters, model)
    measured = np.array([measured_lengths(model, frame) for frame in np.where(state[:, :, None] > 0, centres, np.nan)])
    with np.errstate(all="ignore"):
        seen = np.isfinite(measured).any(axis=0)
        lengths = np.where(seen, np.nanmedian(np.where(seen, measured, 0.0), axis=0), first.lengths)
    smooth = smoothed(centres, state, rate_hz, parameters.cutoff_hz)
    q, found = np.zeros((len(centres), COORDINATES)), first.q
    free = _free_lengths(_bounds(first.q[3], lengths))
    stiffness = np.concatenate([np.zeros(3), np.full(COORDINATES - 3, parameters.step_std**-2), np.zeros(12)])
    for k, frame in enumerate(smooth):
        for _ in range(1 if k else parameters.first_fits):
            u = np.concatenate([found, lengths])
            found = _fit(u, COORDINATES, frame, state[k], u.copy(), stiffness, free, parameters, model).q
        q[k] = found
    return q, lengths


def smoothed(centres: Array, state: States, rate_hz: float, cutoff_hz: float) -> Array:
    """(t, 15, 3) with gaps bridged, low-passed without delay."""
    result = np.zeros_like(centres)
    time = np.arange(len(centres), dtype=np.float64)
    for m in range(centres.shape[1]):
        there = (state[:, m] > 0) & np.isfinite(centres[:, m]).all(axis=1)
        if there.any():
            for i in range(3):
                result[:, m, i] = np.interp(time, time[there], centres[there, m, i])
    enough = len(centres) > 15
    if cutoff_hz > 0.0 and enough:
        result = filtfilt(*butter(2, cutoff_hz / (rate_hz / 2.0)), result, axis=0)
    return np.ascontiguousarray(result)


def _there(centres: Array, state: States) -> NDArray[np.bool_]:
    return np.asarray((state > 0) & np.isfinite(centres).all(axis=1))


def _bounds(turned: float, lengths: Array) -> Bounds:
    low, high = per_angle(LIMITS_DEG).T.copy()
    low[0] += turned
    high[0] += turned
    low = np.concatenate([low, (1.0 - LENGTH_RANGE) * lengths])
    high = np.concatenate([high, (1.0 + LENGTH_RANGE) * lengths])
    return Bounds(low, high)


def _free_lengths(bounds: Bounds) -> Bounds:
    """The bounds of the angles alone."""
    angles = COORDINATES - 3
    return Bounds(bounds.low[:angles].copy(), bounds.high[:angles].copy())


def _fit(
    u: Array, free: int, centres: Array, state: States, value: Array, stiffness: Array, bounds: Bounds,
    parameters: FitParameters, model: WholeBodyModel,
) -> Fit:  # fmt: skip
    there = _there(centres, state)
    weight = np.where(there, parameters.centre_std**-2, 0.0)
    weight[state == 1] /= parameters.inferred
    angles = slice(3, COORDINATES)
    u[angles] = np.clip(u[angles], bounds.low[: COORDINATES - 3], bounds.high[: COORDINATES - 3])
    seen, work = np.where(there[:, None], centres, 0.0), table(WORK)
    fit(u, free, seen, weight, value, stiffness, parameters.most_steps, *bounds, model.body, work)
    rms = float(np.sqrt(np.mean(work["innovation"][0][there] ** 2))) if there.any() else 0.0
    return Fit(u[:COORDINATES].copy(), u[COORDINATES:].copy(), rms)
