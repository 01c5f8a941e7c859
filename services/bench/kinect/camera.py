"""What a Kinect v2 makes of joint centres: offsets, noise, wander, outliers, guesses, exchanged legs, drops."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre
from services.bench.kinect.motions import RATE_HZ, Trial
from services.biomech.whole_body.model import CENTRE_NAMES, previous_centres

Array = NDArray[np.float64]
States = NDArray[np.int64]

KINDS = ("clinic", "paper")
PAPER_VARIANCE = np.array([0.0019, 0.0050, 0.0009])
"""m^2 over depth, height and sideways (Colombel, section 3.4)."""
WHITE_STD = 0.010
WANDER_SHARE = 0.05
WANDER_TIME_S = 2.0
OUTLIER_RATE = 0.01 / 1.5
INFERRED_SHARE = {"knee": 0.03, "ankle": 0.12, "elbow": 0.03, "wrist": 0.05}
BURST_FRAMES = 7.0
SWAP_EVERY_S = 30.0
DROPPED = 0.02
LEG = [CENTRE_NAMES.index(JointCentre(name)) for name in ("hip_right", "knee_right", "ankle_right")]


class Seen(NamedTuple):
    """What the camera delivers."""

    centres: Array  # (n, 15, 3) m; NaN throughout in a dropped frame
    state: States  # (n, 15) 0 not tracked, 1 inferred, 2 tracked


def offset_std(kind: str) -> Array:
    """(3,) m, constant offset of a centre among people: depth, height, sideways."""
    if kind == "clinic":
        return np.full(3, 0.030)
    # What the paper reports is offsets and noise together; wander and outliers account for the part taken off.
    return np.asarray(np.sqrt(PAPER_VARIANCE - 0.00045))


def _offsets(person: int, kind: str, which: int) -> Array:
    """(15, 3) m. Those of `paper` are half the camera's own, mirrored between the sides, and half the person's."""
    own = np.random.default_rng([person, which, 6]).normal(size=(15, 3)) * offset_std(kind)
    if kind == "clinic":
        return own
    common = np.random.default_rng([which, 77]).normal(size=(15, 3)) * offset_std(kind)
    for right in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle"):
        a, b = (CENTRE_NAMES.index(JointCentre(f"{right}_{side}")) for side in ("right", "left"))
        common[b] = common[a] * [1.0, 1.0, -1.0]
    return np.asarray((own + common) * np.sqrt(0.5))


def see(trial: Trial, person: int, kind: str = "clinic") -> Seen:
    """The trial as seen; a person's offsets are the same in all tasks."""
    rng = np.random.default_rng([person, trial.task, 5])
    n = len(trial.centres)
    in_world, in_segment = (_offsets(person, kind, which) * np.sqrt(0.5) for which in (0, 1))
    centres = trial.centres + in_world + np.einsum("tmij,mj->tmi", trial.carriers, in_segment)
    state = np.full((n, 15), 2, dtype=np.int64)
    _wander(rng, trial, centres)
    centres += rng.normal(0.0, WHITE_STD, centres.shape)
    _infer(rng, centres, state)
    _scatter(rng, centres)
    _swap(rng, centres)
    dropped = rng.random(n) < DROPPED
    dropped[:5] = False
    centres[dropped], state[dropped] = np.nan, 0
    return Seen(centres, state)


def _wander(rng: np.random.Generator, trial: Trial, centres: Array) -> None:
    """Each centre slides along the bone that leads to it, slowly."""
    n, keep = len(centres), np.exp(-1.0 / (RATE_HZ * WANDER_TIME_S))
    track = np.zeros((n, 15))
    track[0] = rng.normal(size=15)
    for k in range(1, n):
        track[k] = keep * track[k - 1] + np.sqrt(1.0 - keep**2) * rng.normal(size=15)
    for centre, before in previous_centres().items():
        m = CENTRE_NAMES.index(centre)
        bone = trial.centres[:, m] - trial.centres[:, CENTRE_NAMES.index(before)]
        centres[:, m] += WANDER_SHARE * track[:, m : m + 1] * bone


def _infer(rng: np.random.Generator, centres: Array, state: States) -> None:
    """Bursts in which a centre half stays where it was."""
    n = len(centres)
    for m, centre in enumerate(CENTRE_NAMES):
        share = INFERRED_SHARE.get(centre.rpartition("_")[0], 0.0)
        k = 0
        while share > 0.0:
            k += int(rng.exponential((BURST_FRAMES - 1.0) * (1.0 - share) / share)) + 1
            if k >= n:
                break
            end = min(n, k + 1 + int(rng.geometric(1.0 / (BURST_FRAMES - 1.0))))
            last = centres[max(k - 1, 0), m]
            guess = last + 0.5 * (centres[k:end, m] - last) + rng.normal(0.0, 0.04, 3)
            centres[k:end, m] = guess + rng.normal(0.0, 0.02, (end - k, 3))
            state[k:end, m] = 1
            k = end


def _scatter(rng: np.random.Generator, centres: Array) -> None:
    """Single centres far off for one or two frames, still called tracked."""
    for m in range(15):
        for k in np.flatnonzero(rng.random(len(centres)) < OUTLIER_RATE):
            way = rng.normal(size=3)
            centres[k : k + rng.integers(1, 3), m] += way / np.linalg.norm(way) * rng.uniform(0.1, 0.5)


def _swap(rng: np.random.Generator, centres: Array) -> None:
    """Right and left leg exchanged for 3 to 10 frames."""
    k = int(rng.exponential(SWAP_EVERY_S * RATE_HZ)) + 60
    while k < len(centres):
        end = min(len(centres), k + int(rng.integers(3, 11)))
        for right in LEG:
            centres[k:end, [right, right + 3]] = centres[k:end, [right + 3, right]]
        k = end + int(rng.exponential(SWAP_EVERY_S * RATE_HZ)) + 60
