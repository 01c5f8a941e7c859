"""Walking on a treadmill before the camera: strides that optical laboratories recorded, on simulated bodies.

One stride of each recording is closed and repeated with variation. Angles are those of the recording but for constant
offsets, in which laboratories differ: pelvis and trunk move about the person's own standing posture, and hip flexion is
that of a thigh under an upright pelvis. Arms swing against the legs.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from services.bench.kinect.c3d_points import Points, read_points
from services.bench.kinect.motions import OPENSIM_COLUMNS, Trial, opencap, placed_trial
from services.biomech.whole_body.model import DOF
from services.ingest.data import find_data
from services.ingest.synthetic.whole_body.people import Person
from services.ingest.synthetic.whole_body.programme import RATE_HZ, hinged, natural_drift_deg

Array = NDArray[np.float64]

WALKING = 5
"""Number of the task behind those of the paper."""
STANDING_S = 3.0
STRIDES = 30
LEAST_STRIDE_S, MOST_STRIDE_S = 0.8, 1.6
ARM_SHARE, ELBOW_SHARE = 0.35, 0.4
"""As in services/ingest/synthetic/whole_body/walker.py."""
STEADY = ("hip_adduction", "hip_internal_rotation", "pelvis", "trunk")
"""Angles whose mean over the stride is taken off."""

_PLUG_IN_GAIT = {"hip_flexion": ("HipAngles", 0), "hip_adduction": ("HipAngles", 1),
                 "hip_internal_rotation": ("HipAngles", 2), "knee_flexion": ("KneeAngles", 0)}  # fmt: skip
_PELVIS = {"pelvis_tilt": 0, "pelvis_obliquity": 1, "pelvis_rotation": 2}


def _of_opencap() -> tuple[dict[str, Array], float]:
    columns = opencap("walking1")
    return {name: sign * columns[column] for name, (column, sign) in OPENSIM_COLUMNS.items()}, 100.0


def _of_c3d(folder: str, file: str) -> tuple[dict[str, Array], float]:
    """Plug-in Gait: pelvis of the right side, forward, right side up and turned to the left positive, as ours."""
    points: Points = read_points(Path(find_data(folder)) / file)
    found = {name: points.of("RPelvisAngles")[:, axis] for name, axis in _PELVIS.items()}
    for letter, side in (("R", "right"), ("L", "left")):
        found |= {f"{name}_{side}": points.of(letter + point)[:, axis] for name, (point, axis) in _PLUG_IN_GAIT.items()}
    return found, points.rate_hz


RECORDINGS: dict[str, Callable[[], tuple[dict[str, Array], float]]] = {
    "OpenCap walking1": _of_opencap,
    "Sint Maartenskliniek overground": lambda: _of_c3d("sintmaartens_c3d", "exampleOverground.c3d"),
    "biomechZoo HC030A05": lambda: _of_c3d("biomechzoo_c3d_gait", "HC030A05.c3d"),
}
"""Angles by name, deg, and their rate, Hz. Each raises MissingFile without its data."""


@cache
def stride(recording: str) -> tuple[Array, float]:
    """(m, 22) deg over one closed stride, away from standing, and how long it took, s.

    What is cut out ends in nearly the posture in which it begins; the rest of the gap is spread over it.
    """
    angles, rate_hz = RECORDINGS[recording]()
    best = _closest_to_closed(angles, rate_hz)
    table = np.zeros((best.stop - best.start, len(DOF)))
    upright = angles["pelvis_tilt"][best].mean()
    for name, values in angles.items():
        part = values[best]
        closed = part - np.linspace(0.0, 1.0, len(part)) * (part[-1] - part[0])
        if name.startswith("hip_flexion"):
            closed -= upright
        table[:, DOF[name]] = closed - closed.mean() if name.startswith(STEADY) else closed
    for side, other in (("right", "left"), ("left", "right")):
        swing = ARM_SHARE * (table[:, DOF[f"hip_flexion_{other}"]] - table[:, DOF[f"hip_flexion_{side}"]])
        table[:, DOF[f"shoulder_flexion_{side}"]] = swing
        table[:, DOF[f"elbow_flexion_{side}"]] = ELBOW_SHARE * np.maximum(swing, 0.0)
    return table, (len(table) - 1) / rate_hz


def _closest_to_closed(angles: dict[str, Array], rate_hz: float) -> slice:
    """The part as long as a stride whose last posture is nearest to its first. Raises ValueError if there is none."""
    table = np.column_stack(list(angles.values()))
    best, least = slice(0, 0), np.inf
    for frames in range(int(LEAST_STRIDE_S * rate_hz), min(int(MOST_STRIDE_S * rate_hz), len(table) - 1) + 1):
        gaps = np.abs(table[frames:] - table[:-frames]).sum(axis=1)
        if not np.isfinite(gaps).any():
            continue
        first = int(np.nanargmin(gaps))
        if gaps[first] < least and np.isfinite(table[first : first + frames + 1]).all():
            best, least = slice(first, first + frames + 1), gaps[first]
    if not np.isfinite(least):
        raise ValueError("no whole stride in the recording")
    return best


def walking_angles(who: Person, recording: str, rng: np.random.Generator) -> tuple[Array, Array]:
    """Angles (n, 22) rad and the number of the stride (n,), 0 in none.

    Standing, then strides of the person's own pace, each a little different, then standing.
    """
    table, lasts_s = stride(recording)
    period_s = lasts_s * rng.uniform(0.9, 1.15) * (1.0 + 0.03 * rng.normal(size=STRIDES))
    times_s = np.concatenate([[0.0], np.cumsum(period_s)])
    time_s = np.arange(0.0, times_s[-1], 1.0 / RATE_HZ)
    done = np.interp(time_s, times_s, np.arange(STRIDES + 1))
    size = np.interp(done, np.arange(STRIDES + 1) + 0.5, 1.0 + 0.04 * rng.normal(size=STRIDES + 1))
    edge = np.clip(np.minimum(done, STRIDES - done), 0.0, 1.0)
    size *= edge**2 * (3.0 - 2.0 * edge)
    phase = np.linspace(0.0, 1.0, len(table))
    away = np.column_stack([np.interp(done % 1.0, phase, column) for column in table.T]) * size[:, None]
    still = np.zeros((int(STANDING_S * RATE_HZ), len(DOF)))
    away = np.concatenate([still, away, still[: int(RATE_HZ)]])
    number = np.concatenate([np.zeros(len(still)), np.floor(done) + 1.0, np.zeros(int(RATE_HZ))])
    return np.radians(hinged(who.rest_deg + away + natural_drift_deg(rng, len(away)))), number


def walk_trial(who: Person, recording: str) -> Trial:
    """A person's walk with the strides of a recording, always the same. Raises MissingFile without it."""
    rng = np.random.default_rng([who.number, WALKING, list(RECORDINGS).index(recording)])
    trial = placed_trial(who, WALKING, walking_angles(who, recording, rng), rng, lowest=True)
    # On a treadmill the feet go back with the belt, so the body stays.
    off = trial.q[:, [0, 2]] - trial.q[:1, [0, 2]]
    trial.q[:, [0, 2]] -= off
    trial.centres[:, :, [0, 2]] -= off[:, None, :]
    return trial
