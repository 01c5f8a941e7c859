"""Tuning without a reference: the best settings foretell best where a centre is that the filter does not see.

The likelihood of innovations (`tuning.surprise`) takes the noise for white. A camera's is not: the likeliest filter
follows the noise, and is among the worst. A centre hidden for a third of a second has noise that the others do not
share, so whatever its colour, its distance from the foretold place is least, on average, where the posture is right.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.camera_statistics import along_bones, still_variance
from services.biomech.whole_body.constrained_ekf import OURS, FilterSettings, WholeBodyEkf
from services.biomech.whole_body.descent import Judge, descend
from services.biomech.whole_body.kernels.tables import SEEN
from services.biomech.whole_body.model import CENTRE_NAMES
from services.biomech.whole_body.parameters import ProcessNoise
from services.biomech.whole_body.tuning import Recording

Array = NDArray[np.float64]

LANES = (
    ("hip_right", "hip_left", "knee_right", "knee_left"),
    ("spine_mid", "spine_shoulder", "shoulder_right", "shoulder_left", "elbow_right", "elbow_left"),
)
"""One of each is hidden at a time: what has neighbours on both sides. Where a free end is, nothing else tells."""
HIDDEN_S, UNTRIED_S = 1.0 / 3.0, 0.1
"""How long a centre is hidden, and how long of it passes before it counts: what was seen last is forgotten then."""
FAR = 0.15
"""m. Farther off is as bad: such frames are the camera's."""
SKIPPED_S = 2.0
NEUTRAL = 100.0
"""White jerk from which a search starts, the same for every group."""


def hidden(frames: int, rate_hz: float, seed: int = 0) -> NDArray[np.bool_]:
    """(frames, 15) what is hidden when, drawn by seed; nothing for the first 2 s."""
    mask = np.zeros((frames, len(CENTRE_NAMES)), dtype=bool)
    length = max(1, round(HIDDEN_S * rate_hz))
    for i, lane in enumerate(LANES):
        generator, turn = np.random.default_rng([seed, i]), list[int]()
        for first in range(int(SKIPPED_S * rate_hz), frames - length + 1, length):
            turn = turn or [int(k) for k in generator.permutation(len(lane))]
            mask[first : first + length, CENTRE_NAMES.index(lane[turn.pop()])] = True
    return mask


def misfit(recording: Recording, settings: FilterSettings, seed: int = 0) -> float:
    """Mean squared distance, m^2, of hidden tracked centres from where the filter foretells them.

    Raises:
        ValueError: nothing could be hidden: the recording is too short, or nothing in it is tracked.
    """
    ekf = WholeBodyEkf(recording.start, settings)
    mask = hidden(len(recording.centres), recording.rate_hz, seed)
    untried, squares = round(UNTRIED_S * recording.rate_hz), list[float]()
    since = np.zeros(len(CENTRE_NAMES), dtype=np.int64)
    for k, (centres, state) in enumerate(zip(recording.centres, recording.state, strict=True)):
        ekf.advance(1.0 / recording.rate_hz if k else 0.0, centres, np.where(mask[k], 0, state))
        since = np.where(mask[k], since + 1, 0)
        tried = np.flatnonzero((since > untried) & (state == 2) & np.isfinite(centres).all(axis=1))
        if len(tried):
            off = np.square((foretold(ekf) - centres)[tried]).sum(axis=1)
            squares += np.where(np.isfinite(off), np.minimum(off, FAR**2), FAR**2).tolist()
    if not squares:
        raise ValueError(f"no tracked centre could be hidden in {len(mask)} frames; 2 s come before the first")
    return float(np.mean(squares))


def foretold(ekf: WholeBodyEkf) -> Array:
    """(15, 3) m, where the filter expects the camera to see centres: offsets included."""
    places = ekf.model.centres(ekf.q, ekf.lengths)
    return places + ekf.x[SEEN : ekf.velocity].reshape(-1, 3) if ekf.biased else places


def from_still_part(recording: Recording, still: int, settings: FilterSettings = OURS) -> FilterSettings:
    """Camera noise from data, R of section 3.4 without a reference; the process neutral.

    `still`: frames at the beginning in which the person stands. White noise is that of the still part, noise along
    bones that of the whole recording.
    """
    part = slice(0, still)
    white = float(np.nanmedian(still_variance(recording.centres[part], recording.state[part])))
    along = along_bones(recording.centres, recording.state, recording.rate_hz)
    process = ProcessNoise.of_groups(np.full(11, NEUTRAL))
    return replace(settings, camera=replace(settings.camera, variance=white, along=along), process=process)


def tuned_by_hidden_centres(
    recordings: Sequence[Recording], start: FilterSettings, sweeps: int = 3, factor: float = 8.0,
    judge: Judge | None = None, on_step: Callable[[], None] = lambda: None,
) -> FilterSettings:  # fmt: skip
    """Camera variance and process noise that foretell hidden centres best, from a neutral start, without a reference.

    `judge` may value several settings at once, in other processes, by `log_misfit` of all recordings.
    """
    value = judge or (lambda batch: [log_misfit(recordings, one) for one in batch])
    return descend(value, start, sweeps, factor, 1e-3, on_step)


def log_misfit(recordings: Sequence[Recording], settings: FilterSettings, seeds: Sequence[int] = (0, 1)) -> float:
    """Mean log of the misfit, so that every recording weighs the same."""
    return float(np.mean([np.log(misfit(one, settings, seed)) for one in recordings for seed in seeds]))
