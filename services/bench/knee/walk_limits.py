"""What limits the recorded walk: the knee of two inclinations, each ours, drift-free, or the laboratory's.

Over a horizontal axis flexion is the difference of two inclinations, and needs no heading. Every inclination can so be
put in the place of another: what remains with both of the laboratory's is the truth's own definition.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress
from scipy.signal import butter, filtfilt
from scipy.spatial.transform import Rotation

from schemas.vocabulary import Side
from services.bench.accuracy.neura_truth import reference_channels
from services.bench.knee.recordings import KneeRecording, from_manifest
from services.bench.knee.scores import score
from services.bench.knee.worn_board import NEURA, PARAMETERS, STRAIGHT, WITH_TURN
from services.bench.report import Section, Table, number
from services.bench.scoreboard import Row, informative
from services.biomech.two_sensor_knee.knee_axis import KneeAxis

Array = NDArray[np.float64]

SPEC = NEURA["neura"]
STANDING, STANDING_AFTER = slice(200, 1000), slice(2250, 2480)
"""Samples of quiet standing before and after the walk."""
CUTOFF_HZ, LARGEST_LAG = 6.0, 4
WAYS = {
    "as published": ("", ""),
    "inclinations alone, no heading": ("ours", "ours"),
    "without drift: gyroscopes between two standings": ("drift-free", "drift-free"),
    "thigh of the laboratory": ("true", "ours"),
    "shank of the laboratory": ("ours", "true"),
    "both of the laboratory": ("true", "true"),
}
PARAGRAPHS = [
    "Second pass over the walk, ours against Plug-in-Gait, offset removed, best constant shift, mean of both sides. "
    "The hinge's heading gains half a degree over inclinations alone. 'Without drift' integrates the gyroscopes from "
    "one standing to the next and spreads what is left evenly: that is how the sensors turned, and it is no better "
    "than ours. Only the laboratory's thigh is: the thigh's sensor turns otherwise than the bone. 'Gain' is by how "
    "much the knee bends too far: the slope of the error over the flexion. Landings and sit-to-stand show none of it "
    "(0.4 and 0.9 %), so it is not corrected for. The laboratory's segments are carried to the sensors by their rates.",
]


class Walk(NamedTuple):
    """One leg: recording, published angle (n,), axes (2, 3) and ups (2, n, 3) in the sensors by origin."""

    recording: KneeRecording
    published: Array
    axes: Array
    ups: dict[str, Array]


def limits_section(progress: Progress) -> Section:
    """Rows and table. Raises MissingFile without the data."""
    walks = [_walk(side) for side in progress.track(Side, description="limits of the walk")]
    rows: list[Row] = []
    lines = []
    for way, (thigh, shank) in WAYS.items():
        angles = [_knee(walk, thigh, shank) if thigh else walk.published for walk in walks]
        straight, turning = (
            float(np.mean([_error_deg(a, w, frames) for a, w in zip(angles, walks, strict=True)]))
            for frames in (STRAIGHT, WITH_TURN)
        )
        gains = [_gain(a, w) for a, w in zip(angles, walks, strict=True)]
        rows.append(informative(f"limits of the walk: {way}, straight", straight, "deg"))
        rows.append(informative(f"limits of the walk: {way}, with turn", turning, "deg", detail=True))
        rows.append(informative(f"limits of the walk: {way}, gain", float(np.mean(gains)), "%", detail=True))
        lines.append([way, number(straight), number(turning), *(number(gain) for gain in gains)])
    head = ["knee from", "straight, deg", "with turn, deg", *(f"gain {side}, %" for side in Side)]
    return Section(
        "What limits the recorded walk", PARAGRAPHS, rows, [Table("Origin of each inclination", head, lines)]
    )


def _walk(side: Side) -> Walk:
    recording, channels = from_manifest(SPEC, side), reference_channels(SPEC)
    estimator, dt_s = KneeAxis(PARAMETERS), 1.0 / recording.rate_hz
    estimator.run(recording.rate, recording.force, dt_s)
    estimator.rewind(recording.rate, recording.force, dt_s)
    flexion, ups = np.empty(len(recording.rate)), np.empty((2, len(recording.rate), 3))
    for i, (rate, force) in enumerate(zip(recording.rate, recording.force, strict=True)):
        flexion[i] = estimator.step(rate, force, dt_s).flexion
        ups[:, i] = estimator.up
    true = [
        _up_of_segment(recording, s, channels, f"{name}_{side}", ups[s]) for s, name in enumerate(("thigh", "shank"))
    ]
    free = [_up_without_drift(recording, s) for s in range(2)]
    return Walk(recording, flexion, estimator.axes, {"ours": ups, "true": np.stack(true), "drift-free": np.stack(free)})


def _knee(walk: Walk, thigh: str, shank: str) -> Array:
    """Flexion (n,), rad, offset open: inclination of the thigh less that of the shank about the axis."""
    angles = []
    for s, origin in enumerate((thigh, shank)):
        axis, up = walk.axes[s], walk.ups[origin][s]
        across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        across /= np.linalg.norm(across)
        angles.append(np.unwrap(np.arctan2(up @ np.cross(axis, across), up @ across)))
    # The vertical turns in a sensor against the sensor's own turn.
    return np.asarray(angles[0] - angles[1])


def _up_without_drift(recording: KneeRecording, s: int) -> Array:
    """The vertical (n, 3) in sensor `s`: gyroscopes from standing to standing, the tilt that is left spread evenly."""
    rate = recording.rate[:, s] - recording.rate[STANDING, s].mean(axis=0)
    up = np.empty((len(rate), 3))
    up[: STANDING.stop] = _unit(recording.force[STANDING, s].mean(axis=0))
    turns = Rotation.from_rotvec(-rate / recording.rate_hz).as_matrix()
    for before, now in pairwise(range(STANDING.stop - 1, len(rate))):
        up[now] = turns[now] @ up[before]
    felt = _unit(recording.force[STANDING_AFTER, s].mean(axis=0))
    left, _ = Rotation.align_vectors(felt[None], _unit(up[STANDING_AFTER].mean(axis=0))[None])
    share = np.clip((np.arange(len(rate)) - STANDING.stop) / (STANDING_AFTER.start - STANDING.stop), 0.0, 1.0)
    return np.asarray(Rotation.from_rotvec(share[:, None] * left.as_rotvec()).apply(up))


def _up_of_segment(
    recording: KneeRecording, s: int, channels: dict[str, Array], segment: str, elsewhere: Array
) -> Array:
    """The vertical (n, 3) in sensor `s` if the laboratory's segment carried it; `elsewhere` where that is unseen."""
    quat = np.stack([channels[f"quat_world_from_{segment}_{part}"] for part in "wxyz"], axis=1)
    frames = np.flatnonzero(np.isfinite(quat).all(axis=1))
    frames = frames[(frames >= WITH_TURN[0]) & (frames <= WITH_TURN[-1])]
    world_from_segment = Rotation.from_quat(quat[frames], scalar_first=True)
    b, a = butter(2, CUTOFF_HZ / (0.5 * recording.rate_hz))
    true = (world_from_segment[:-1].inv() * world_from_segment[1:]).as_rotvec() * recording.rate_hz
    true = filtfilt(b, a, true, axis=0)
    rate = filtfilt(b, a, recording.rate[:, s] - recording.rate[STANDING, s].mean(axis=0), axis=0)
    fits = [
        (*Rotation.align_vectors(true, rate[frames[1:] + lag]), lag) for lag in range(-LARGEST_LAG, LARGEST_LAG + 1)
    ]
    segment_from_sensor, _, lag = min(fits, key=lambda fit: fit[1])
    up = elsewhere.copy()
    up[frames + lag] = (world_from_segment * segment_from_sensor).inv().apply([0.0, 1.0, 0.0])
    return up


def _error_deg(angle: Array, walk: Walk, frames: NDArray[np.int64]) -> float:
    asked = np.zeros(len(angle), dtype=np.bool_)
    asked[frames] = walk.recording.holds[frames]
    everywhere = np.ones(len(angle), dtype=np.bool_)
    return float(np.degrees(score(angle, walk.recording.flexion, asked, everywhere).shifted.zero_mean_rmse))


def _gain(angle: Array, walk: Walk) -> float:
    """% by which the straight walk bends too far."""
    true = walk.recording.flexion[STRAIGHT]
    centred = true - true.mean()
    return 100.0 * float((angle[STRAIGHT] - true) @ centred / (centred @ centred))


def _unit(direction: Array) -> Array:
    return np.asarray(direction / np.linalg.norm(direction))
