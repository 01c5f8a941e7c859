"""Kept libraries on the same samples, where they are installed (`pip install .[peers]`)."""

import contextlib
import importlib.util
import io
import time
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.bench.knee.hinge_peer import heading_between, tie_headings
from services.bench.knee.orientation_filters import FILTERS
from services.bench.knee.recordings import KneeRecording
from services.biomech.two_sensor_knee.mcgrath import knee_flexion, segment_frame

Array = NDArray[np.float64]

START = 100
"""Sample at which headings are made equal once where an orientation in one common world is known."""


class PeerResult(NamedTuple):
    """A peer's angle (n,), rad in McGrath's datum up to sign, its axis, and its processor time."""

    angle: Array
    axes: Array  # (2, 3)
    seconds_per_sample: float


def missing(*libraries: str) -> str | None:
    """Why a peer cannot run here; None when all libraries are installed."""
    absent = [name for name in libraries if importlib.util.find_spec(name) is None]
    return f"not installed: {', '.join(absent)}" if absent else None


def orientations(recording: KneeRecording, by: str = "VQF") -> tuple[Array, Array]:
    """R_world_from_sensor (n, 3, 3) of thigh and shank by one of FILTERS; world z up."""
    filtered, _ = FILTERS[by]
    thigh, shank = (filtered(recording.rate[:, s], recording.force[:, s], recording.rate_hz) for s in range(2))
    return thigh, shank


def mcgrath(recording: KneeRecording) -> PeerResult:
    """The published method on VQF orientations; nothing ties the headings."""
    begin = time.thread_time()
    thigh, shank = orientations(recording)
    angle, axes = knee_flexion(thigh, shank, recording.rate[:, 0], recording.rate[:, 1])
    return PeerResult(angle, axes, (time.thread_time() - begin) / len(angle))


def mcgrath_as_measured(recording: KneeRecording) -> PeerResult:
    """The published method on orientations in one common world that came with the recording.

    Raises:
        ValueError: the recording has none.
    """
    if recording.orientations is None:
        raise ValueError(f"{recording.name} has no orientations of its own")
    begin = time.thread_time()
    angle, axes = knee_flexion(*recording.orientations, recording.rate[:, 0], recording.rate[:, 1])
    return PeerResult(angle, axes, (time.thread_time() - begin) / len(angle))


def olsson_axis(recording: KneeRecording) -> Array:
    """Axis (2, 3) by `qmt.jointAxisEstHingeOlsson`, of both senses as the library gives them."""
    from qmt import jointAxisEstHingeOlsson

    arrays = [np.ascontiguousarray(a[:, s]) for a in (recording.force, recording.rate) for s in range(2)]
    # It prints each iteration, and divides by the rate of a sensor at rest.
    with contextlib.redirect_stdout(io.StringIO()), np.errstate(invalid="ignore", divide="ignore"):
        first, second = jointAxisEstHingeOlsson(*arrays)
    return np.stack([np.ravel(first), np.ravel(second)])


def with_hinge(recording: KneeRecording, by: str = "VQF", *, is_told: bool = True) -> PeerResult:
    """One of FILTERS; axis by principal components and heading by the hinge over the whole recording.

    Where orientations came with the recording they tell the heading once, at the start, if it `is_told`.
    """
    begin = time.thread_time()
    thigh, shank = orientations(recording, by)
    start = None
    if is_told and recording.orientations is not None:
        start = heading_between(thigh[START], shank[START], *(known[START] for known in recording.orientations))
    relative, axes = tie_headings(thigh, shank, recording.rate, recording.rate_hz, start)
    return PeerResult(_twist(relative, axes), axes, (time.thread_time() - begin) / len(thigh))


def qmt_heading(recording: KneeRecording) -> PeerResult:
    """VQF, Olsson's axis over the whole recording, `qmt.headingCorrection` along it."""
    from qmt import headingCorrection

    begin = time.thread_time()
    thigh, shank = orientations(recording)
    axes = olsson_axis(recording)
    quats = [Rotation.from_matrix(R).as_quat(scalar_first=True) for R in (thigh, shank)]
    times = np.arange(len(thigh)) / recording.rate_hz
    with contextlib.redirect_stdout(io.StringIO()):
        corrected = headingCorrection(
            recording.rate[:, 0].copy(), recording.rate[:, 1].copy(), quats[0], quats[1], times, axes[1], None
        )[0]
    relative = np.swapaxes(thigh, 1, 2) @ Rotation.from_quat(corrected, scalar_first=True).as_matrix()
    return PeerResult(_twist(relative, axes), axes, (time.thread_time() - begin) / len(thigh))


def dfjimu_mekf(recording: KneeRecording) -> PeerResult:
    """`dfjimu.mekf_acc`, lever arms estimated; it gives orientations, the axis is the principal one of its own."""
    from dfjimu import mekf_acc

    begin = time.thread_time()
    arrays = [np.ascontiguousarray(a[:, s]) for a in (recording.rate, recording.force) for s in range(2)]
    with contextlib.redirect_stdout(io.StringIO()):
        first, second = mekf_acc(*arrays, Fs=recording.rate_hz, q_init=np.array([1.0, 0.0, 0.0, 0.0]))
    thigh, shank = (Rotation.from_quat(q, scalar_first=True).as_matrix() for q in (first, second))
    _, axes = knee_flexion(thigh, shank, recording.rate[:, 0], recording.rate[:, 1])
    relative = np.swapaxes(thigh, 1, 2) @ shank
    return PeerResult(_twist(relative, axes), axes, (time.thread_time() - begin) / len(thigh))


def _twist(R_thigh_from_shank: Array, axes: Array) -> Array:
    R = segment_frame(axes[0]).T @ R_thigh_from_shank @ segment_frame(axes[1])
    return np.arctan2(R[:, 1, 0] - R[:, 0, 1], R[:, 0, 0] + R[:, 1, 1])


METHODS: dict[str, tuple[tuple[str, ...], Callable[[KneeRecording], PeerResult]]] = {
    "McGrath": ((), mcgrath_as_measured),
    "McGrath on VQF": (("vqf",), mcgrath),
    "VQF + hinge, heading not told": (("vqf",), partial(with_hinge, is_told=False)),
    **{f"{name} + hinge": ((library,), partial(with_hinge, by=name)) for name, (_, library) in FILTERS.items()},
    "VQF, Olsson axis, qmt heading": (("vqf", "qmt"), qmt_heading),
    "dfjimu MEKF": (("dfjimu",), dfjimu_mekf),
}
"""By name: the libraries it needs, and what runs it."""
LITERAL = "McGrath"
