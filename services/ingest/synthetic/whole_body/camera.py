"""What a Kinect v2 makes of joint centres: offsets, noise, wander, outliers, guesses, exchanged legs."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre
from services.biomech.whole_body.model import CENTRE_NAMES, previous_centres
from services.ingest.synthetic.whole_body.body import Placed

Array = NDArray[np.float64]
States = NDArray[np.int64]

NOT_TRACKED, INFERRED, TRACKED = 0, 1, 2

PAPER_VARIANCE = np.array([0.0019, 0.0050, 0.0009])
"""m^2 over depth, height and sideways (Colombel, section 3.4)."""
WANDER_TIME_S = 2.0
INFERRED_SHARE = {"knee": 0.03, "ankle": 0.12, "elbow": 0.03, "wrist": 0.05}
"""Of frames."""
BURST_FRAMES = 7.0
SWAPS_FROM_FRAME = 60
LEG = [CENTRE_NAMES.index(JointCentre(name)) for name in ("hip_right", "knee_right", "ankle_right")]


class Seen(NamedTuple):
    """What the camera delivers."""

    centres: Array  # (n, 15, 3) m; NaN throughout in a dropped frame
    state: States  # (n, 15) 0 not tracked, 1 inferred, 2 tracked


@dataclass(frozen=True)
class Faults:
    """How much of what; all zero is a perfect camera. As they stand: those of a clinic."""

    offset_std: tuple[float, float, float] = (0.030, 0.030, 0.030)  # m: depth, height, sideways; constant by centre
    common_offsets: bool = False  # half of their variance is the camera's own and mirrored between the sides
    white_std: float = 0.010  # m per axis
    wander: float = 0.05  # share of its bone by which a centre slides along it
    outliers: float = 0.01 / 1.5  # per frame and centre
    guesses: float = 1.0  # times INFERRED_SHARE
    guess_std: float = 0.04  # m by which a burst of guesses is off
    swap_every_s: float = 30.0  # mean between exchanges of right and left leg; 0: never
    dropped: float = 0.02  # share of frames

    def scaled(self, share: float) -> "Faults":
        """All smaller, and rarer, by the same share; 0 is a perfect camera."""
        depth, height, sideways = self.offset_std
        return Faults(
            (share * depth, share * height, share * sideways),
            self.common_offsets,
            share * self.white_std,
            share * self.wander,
            share * self.outliers,
            share * self.guesses,
            share * self.guess_std,
            self.swap_every_s / share if share else 0.0,
            share * self.dropped,
        )


CLINIC = Faults()
AS_THE_PAPER_HAD = Faults(
    # What the paper reports is offsets and noise together; wander and outliers account for the part taken off.
    offset_std=(float(np.sqrt(0.0019 - 0.00045)), float(np.sqrt(0.0050 - 0.00045)), float(np.sqrt(0.0009 - 0.00045))),
    common_offsets=True,
)


def offsets(key: tuple[int, ...], faults: Faults, which: int) -> Array:
    """(15, 3) m, always the same for a key; `which` tells apart the part fixed in the room (0) and on the body (1)."""
    own = np.random.default_rng([*key, which, 6]).normal(size=(15, 3)) * faults.offset_std
    if not faults.common_offsets:
        return own
    common = np.random.default_rng([which, 77]).normal(size=(15, 3)) * faults.offset_std
    for right in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle"):
        a, b = (CENTRE_NAMES.index(JointCentre(f"{right}_{side}")) for side in ("right", "left"))
        common[b] = common[a] * [1.0, 1.0, -1.0]
    return np.asarray((own + common) * np.sqrt(0.5))


def see(placed: Placed, rng: np.random.Generator, offset_key: tuple[int, ...], faults: Faults, rate_hz: float) -> Seen:
    """Centres as seen at a frame rate; who has the same `offset_key` has the same offsets."""
    n = len(placed.centres)
    in_room, on_body = (offsets(offset_key, faults, which) * np.sqrt(0.5) for which in (0, 1))
    centres = placed.centres + in_room + np.einsum("tmij,mj->tmi", placed.carriers, on_body)
    state = np.full((n, 15), TRACKED, dtype=np.int64)
    _wander(rng, placed.centres, centres, faults.wander, rate_hz)
    centres += rng.normal(0.0, faults.white_std, centres.shape)
    _guess(rng, centres, state, faults)
    _scatter(rng, centres, faults.outliers)
    _swap(rng, centres, faults.swap_every_s * rate_hz)
    dropped = rng.random(n) < faults.dropped
    dropped[:5] = False
    centres[dropped], state[dropped] = np.nan, NOT_TRACKED
    return Seen(centres, state)


def _wander(rng: np.random.Generator, true: Array, centres: Array, share: float, rate_hz: float) -> None:
    """Each centre slides along the bone that leads to it, slowly."""
    n, keep = len(centres), np.exp(-1.0 / (rate_hz * WANDER_TIME_S))
    track = np.zeros((n, 15))
    track[0] = rng.normal(size=15)
    for k in range(1, n):
        track[k] = keep * track[k - 1] + np.sqrt(1.0 - keep**2) * rng.normal(size=15)
    for centre, before in previous_centres().items():
        m = CENTRE_NAMES.index(centre)
        bone = true[:, m] - true[:, CENTRE_NAMES.index(before)]
        centres[:, m] += share * track[:, m : m + 1] * bone


def _guess(rng: np.random.Generator, centres: Array, state: States, faults: Faults) -> None:
    """Bursts in which a centre half stays where it was."""
    n = len(centres)
    for m, centre in enumerate(CENTRE_NAMES):
        share = faults.guesses * INFERRED_SHARE.get(centre.rpartition("_")[0], 0.0)
        k = 0
        while share > 0.0:
            k += int(rng.exponential((BURST_FRAMES - 1.0) * (1.0 - share) / share)) + 1
            if k >= n:
                break
            end = min(n, k + 1 + int(rng.geometric(1.0 / (BURST_FRAMES - 1.0))))
            last = centres[max(k - 1, 0), m]
            guess = last + 0.5 * (centres[k:end, m] - last) + rng.normal(0.0, faults.guess_std, 3)
            centres[k:end, m] = guess + rng.normal(0.0, 0.5 * faults.guess_std, (end - k, 3))
            state[k:end, m] = INFERRED
            k = end


def _scatter(rng: np.random.Generator, centres: Array, rate: float) -> None:
    """Single centres far off for one or two frames, still called tracked."""
    for m in range(15):
        for k in np.flatnonzero(rng.random(len(centres)) < rate):
            way = rng.normal(size=3)
            centres[k : k + rng.integers(1, 3), m] += way / np.linalg.norm(way) * rng.uniform(0.1, 0.5)


def _swap(rng: np.random.Generator, centres: Array, every: float) -> None:
    """Right and left leg exchanged for 3 to 10 frames, every so many frames; 0: never."""
    if not every:
        return
    k = int(rng.exponential(every)) + SWAPS_FROM_FRAME
    while k < len(centres):
        end = min(len(centres), k + int(rng.integers(3, 11)))
        for right in LEG:
            centres[k:end, [right, right + 3]] = centres[k:end, [right + 3, right]]
        k = end + int(rng.exponential(every)) + SWAPS_FROM_FRAME
