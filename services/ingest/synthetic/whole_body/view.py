"""What a camera delivers of a placed body: frames with times, faults, people who pass, and nobody for a while."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.session import CameraDescription
from schemas.vocabulary import CameraKind
from services.ingest.synthetic.block import SeenFrames
from services.ingest.synthetic.whole_body.body import Placed
from services.ingest.synthetic.whole_body.camera import CLINIC, INFERRED, NOT_TRACKED, Seen, see
from services.ingest.synthetic.whole_body.outline import JOINTS, others
from services.ingest.synthetic.whole_body.parameters import CameraParameters

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

CAMERA = "kinect"
"""Name of the camera, and of its stream."""
MOST_JITTER = 0.3
"""Share of a frame by which its time is off at most."""
PASSER_FROM_M, PASSER_TO_M = 1.5, -1.5
"""Sideways, where a passer enters and leaves the view."""
PASSER_HALF_WIDTH_M = 0.25


class Absence(NamedTuple):
    """When the person is out of view; never if it begins at 0."""

    at_s: float
    for_s: float

    def within(self, time_s: Array) -> NDArray[np.bool_]:
        """Which instants are within it."""
        return (self.at_s > 0.0) & (time_s >= self.at_s) & (time_s < self.at_s + self.for_s)


class Key(NamedTuple):
    """What decides everything random of a camera: the same camera errs alike on the same person."""

    seed: int
    person: int


def camera_description(parameters: CameraParameters) -> CameraDescription:
    """As it would be served live."""
    return CameraDescription(
        name=CAMERA, kind=CameraKind.KINECT_V2, rate_hz=parameters.frame_rate, joints=list(JOINTS),
        floor_m=-parameters.camera_height,
    )  # fmt: skip


def frame_times(parameters: CameraParameters, key: Key, duration_s: float) -> Array:
    """(n,) s, one for each frame whether it comes or not."""
    period_s = 1.0 / parameters.frame_rate
    numbers = np.arange(int(duration_s * parameters.frame_rate))
    off = np.random.default_rng([*key, 9]).normal(0.0, parameters.jitter, len(numbers))
    return np.asarray(np.maximum(numbers * period_s + np.clip(off, -MOST_JITTER * period_s, MOST_JITTER * period_s), 0))


def viewed(
    placed: Placed, dorsiflexion: Array, time_s: Array, parameters: CameraParameters, key: Key, absence: Absence
) -> SeenFrames:
    """The frames that come. `placed` in the room, dorsiflexion (n, 2) rad, both at time_s (n,).

    Who comes back into view is another body to the camera.
    """
    rng = np.random.default_rng([*key, 5])
    faults = replace(CLINIC, dropped=parameters.drops, swap_every_s=parameters.swap_every).scaled(parameters.noise)
    seen = see(placed, rng, (key.person, key.seed), faults, parameters.frame_rate)
    came = (seen.state != NOT_TRACKED).any(axis=1)
    position, state = _with_others(placed, dorsiflexion, seen, rng, faults.white_std)
    body, people = np.ones(len(time_s), dtype=np.int64), np.ones(len(time_s), dtype=np.int64)
    _pass(parameters, time_s, position, state, people)
    away = absence.within(time_s)
    state[away] = NOT_TRACKED
    people[away] -= 1
    if away.any():
        body[time_s >= absence.at_s] = 2
    body[away] = 0
    position[state == NOT_TRACKED] = np.nan
    captured_ns = np.round(time_s * 1e9).astype(np.int64)
    return SeenFrames(captured_ns[came], body[came], people[came], position[came], state[came])


def _with_others(
    placed: Placed, dorsiflexion: Array, seen: Seen, rng: np.random.Generator, white_std: float
) -> tuple[Array, Numbers]:
    """All joints: the others share the error and the state of the centre that they go with, and add their own."""
    extra = others(placed, dorsiflexion)
    position, state = np.zeros((len(seen.state), len(JOINTS), 3)), np.zeros((len(seen.state), len(JOINTS)), np.int64)
    centres = len(seen.state[0])
    position[:, :centres], state[:, :centres] = seen
    for j, other in enumerate(extra, start=centres):
        error = seen.centres[:, other.centre] - placed.centres[:, other.centre]
        position[:, j] = other.position + error + rng.normal(0.0, white_std, other.position.shape)
        state[:, j] = seen.state[:, other.centre]
    return position, state


def _pass(parameters: CameraParameters, time_s: Array, position: Array, state: Numbers, people: Numbers) -> None:
    """Somebody walks past in front of the person: what is behind them is guessed at their edges and lost within."""
    if not parameters.passer_at:
        return
    share = (time_s - parameters.passer_at) / parameters.passer_for
    passing = (share >= 0.0) & (share < 1.0)
    people += passing
    sideways = PASSER_FROM_M + (PASSER_TO_M - PASSER_FROM_M) * share
    off = np.abs(position[:, :, 2] - sideways[:, None])
    near = passing[:, None] & (off < PASSER_HALF_WIDTH_M + 0.05)
    state[near] = np.minimum(state[near], INFERRED)
    state[passing[:, None] & (off < PASSER_HALF_WIDTH_M)] = NOT_TRACKED
