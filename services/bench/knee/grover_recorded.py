"""Recorded motion as the published band would have seen it: 20 Hz, in the plane across the flexion axis."""

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Side
from services.bench.knee.grover_scores import LITERAL, largest_difference, planar
from services.bench.knee.recordings import KneeRecording, from_manifest, weygers
from services.bench.knee.scores import run_knee
from services.biomech.two_sensor_knee.grover import PlanarSample
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

Array = NDArray[np.float64]

WALK, ROUNDS = "neura_s02_walk", 3
"""25 s from standing to standing, the longest recorded walk with thigh and shank, and how often it is played: the
biases need 50 s."""


def recorded() -> dict[str, KneeRecording]:
    """Recordings of both segments that last, or are played, for more than 51 s, by what moves.

    Raises MissingFile without the data.
    """
    walks = {f"walking, neura {side}, played {ROUNDS} times": played_walk(side) for side in Side}
    landings = {"drop landings, fan": from_manifest("fan_knee_drop_landing_left", Side.LEFT)}
    return walks | landings | {f"hinge by hand, weygers {trial}": weygers(trial) for trial in ("02", "05")}


def recorded_difference(recording: KneeRecording) -> float:
    """Largest difference, rad, of both filters, seen across the axis that `KneeAxis` finds in the recording."""
    return largest_difference(seen_in_plane(recording))


def seen_in_plane(recording: KneeRecording) -> list[PlanarSample]:
    """Samples at the paper's rate."""
    _, estimator = run_knee(recording, KneeAxisParameters())
    rate, force = (mean_of_intervals(part, recording.rate_hz, LITERAL.rate_hz) for part in recording[2:4])
    return planar(rate, force, estimator.axes, estimator.up)


def mean_of_intervals(values: Array, from_hz: float, to_hz: float) -> Array:
    """Samples (n, ...) as means over longer intervals, as a sensor's own low-pass would give them at a lower rate."""
    edges = np.arange(int(len(values) * to_hz / from_hz) + 1) * from_hz / to_hz
    summed = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
    below = np.minimum(edges.astype(int), len(values) - 1)
    share = (edges - below).reshape(-1, *(1,) * (values.ndim - 1))
    return np.asarray(np.diff(summed[below] + share * (summed[below + 1] - summed[below]), axis=0) * to_hz / from_hz)


def played_walk(side: Side) -> KneeRecording:
    """The recorded walk, ROUNDS times. Raises MissingFile without the data."""
    walk = from_manifest(WALK, side)
    rate, force = (np.tile(part, (ROUNDS, 1, 1)) for part in walk[2:4])
    flexion, holds = np.tile(walk.flexion, ROUNDS), np.tile(walk.holds, ROUNDS)
    return walk._replace(rate=rate, force=force, flexion=flexion, holds=holds, orientations=None)
