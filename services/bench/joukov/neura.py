"""The recorded walk in the form of the published tables: hips and knees of one person against optical markers.

Truth: knee angle between the lines through the joint centres, hip angle between pelvis and thigh as measured; 10 Hz
zero-phase low-pass, differentiated twice. Every filter is given the one shift between the clocks of sensors and cameras
that suits the plain filter's positions at the default S best.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from schemas.vocabulary import Side
from services.bench.accuracy.neura_truth import collect_truth
from services.bench.accuracy.walk import STRAIGHT, WITH_TURN
from services.bench.joukov.marching import ESTIMATORS, PLACES, PLAIN, Setting, Tuning
from services.bench.joukov.recordings import (
    DEFAULT_S,
    FilterRun,
    Recording,
    calibrate,
    run_filter,
    sensors_on,
    with_noise,
)
from services.bench.joukov.regions import RegionErrors, prediction_errors, region_errors
from services.estimation.parameters import PUBLISHED, FilterParameters

FloatArray = NDArray[np.float64]

SPEC = "neura_s02_walk"
RATE_HZ = 100.0
CUTOFF_HZ = 10.0
SHIFTS = range(-3, 4)
"""Samples between the clocks, as in `ambula bench accuracy neura`."""
MODELS = {"gravity": FilterParameters(), "published": PUBLISHED}
"""As in `marching`, for worn sensors; the published one measures yaw against the pelvis, because the walk turns."""
GRID = 10.0 ** np.arange(2.0, 6.01, 0.5)


@dataclass(frozen=True)
class NeuraScore:
    """One filter on the straight parts of the walk."""

    errors: RegionErrors
    prediction: FloatArray
    """RMSE of the next sample, (2, 2): gyroscope rad/s and accelerometer m/s^2 by thigh and shank."""


@dataclass(frozen=True)
class NeuraStudy:
    """The scores and the shift that they were taken at."""

    scores: dict[Setting, NeuraScore]
    shift: int
    locked: float
    """Share of the scored time in which our rhythm is locked, at the default S."""


@lru_cache(maxsize=1)
def optical_states() -> FloatArray:
    """(3, frames, 4) rad, rad/s, rad/s^2 of JOINTS; NaN outside the walk."""
    truth = collect_truth(SPEC)
    angles = [*(truth.hip_segments[s] for s in (Side.RIGHT, Side.LEFT))]
    angles += [truth.knee_joint_centres[s] for s in (Side.RIGHT, Side.LEFT)]
    walked = slice(int(WITH_TURN[0]) - 20, int(WITH_TURN[-1]) + 21)
    table = np.radians(np.column_stack(angles))
    states = np.full((3, *table.shape), np.nan)
    sections = butter(2, CUTOFF_HZ, fs=RATE_HZ, output="sos")
    smooth = sosfiltfilt(sections, _bridged(table[walked]), axis=0)
    states[0, walked] = smooth
    states[1, walked] = np.gradient(smooth, 1.0 / RATE_HZ, axis=0)
    states[2, walked] = np.gradient(states[1, walked], 1.0 / RATE_HZ, axis=0)
    return states


def _bridged(table: FloatArray) -> FloatArray:
    """Gaps of the markers, straight across."""
    at = np.arange(len(table))
    columns = [np.interp(at, at[np.isfinite(c)], c[np.isfinite(c)]) for c in table.T]
    return np.column_stack(columns)


def study_neura(tuning: Tuning) -> NeuraStudy:
    """All filters on the walk; S comes from elsewhere."""
    recording = calibrate(SPEC)
    reference = _run(recording, Setting("gravity", PLAIN, DEFAULT_S))
    shift = min(SHIFTS, key=lambda samples: float(_errors(reference, samples).sd[0, 0].mean()))
    named = list(tuning.named.values())
    todo = [Setting("gravity", estimator, S) for estimator in ESTIMATORS for S in sorted({*GRID.tolist(), *named})]
    todo += [Setting("published", estimator, S) for estimator in ESTIMATORS for S in named]
    scores, locked = {}, 0.0
    for setting in todo:
        run = _run(recording, setting)
        frames = _frames(run)
        places = [sensors_on(recording, place) for place in PLACES]
        prediction = prediction_errors(run.surprise[frames[STRAIGHT + shift]], places)
        scores[setting] = NeuraScore(_errors(run, shift), prediction)
        if setting == Setting("gravity", ESTIMATORS[-1], DEFAULT_S):
            locked = float(np.mean(run.locked[frames[STRAIGHT + shift]]))
    return NeuraStudy(scores, shift, locked)


def _run(recording: Recording, setting: Setting) -> FilterRun:
    return run_filter(recording, setting.estimator, with_noise(MODELS[setting.model], setting.S))


def _frames(run: FilterRun) -> NDArray[np.int64]:
    """Row of the run by frame of the cameras, -1 where there is none."""
    frames = np.round(run.time_s * RATE_HZ).astype(np.int64)
    rows = np.full(int(frames[-1]) + 1, -1, dtype=np.int64)
    rows[frames] = np.arange(len(frames))
    return rows


def _errors(run: FilterRun, shift: int) -> RegionErrors:
    rows = _frames(run)[STRAIGHT + shift]
    return region_errors(run.state[:, rows], optical_states()[:, STRAIGHT])
