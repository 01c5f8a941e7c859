"""Tuning of the process noise: from frequency content, against a reference, and by the likelihood of innovations.

The first two are those of Colombel et al. (section 3.4). The last needs no laboratory, which the paper names as what
its method lacks; `hidden_centres.py` does that better. Nothing here draws on the person who is scored: callers choose
whose recordings tune.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from services.biomech.whole_body.constrained_ekf import OURS, FilterSettings, WholeBodyEkf
from services.biomech.whole_body.descent import Judge, descend
from services.biomech.whole_body.kernels.tables import COORDINATES
from services.biomech.whole_body.parameters import GROUP, GROUPS, ProcessNoise
from services.biomech.whole_body.start import Start, States

Array = NDArray[np.float64]

LEAST, MOST = 1e-3, 1e2
"""Bounds of eq. 8 on the variance of the held jerk, rad^2/s^6."""


class Recording(NamedTuple):
    """What a filter is run over, and what it should say."""

    centres: Array  # (t, 15, 3) m
    state: States  # (t, 15)
    start: Start
    angles: Array | None = None  # (t, 22) rad of a reference
    rate_hz: float = 30.0


def replay(recording: Recording, settings: FilterSettings = OURS) -> tuple[Array, WholeBodyEkf]:
    """Angles (t, 22) rad of the filter over a recording, and the filter as it ends."""
    ekf = WholeBodyEkf(recording.start, settings)
    angles = np.zeros((len(recording.centres), COORDINATES - 3))
    for k, (centres, state) in enumerate(zip(recording.centres, recording.state, strict=True)):
        ekf.advance(1.0 / recording.rate_hz if k else 0.0, centres, state)
        angles[k] = ekf.angles
    return angles, ekf


def frequency_tuned(q: Array, rate_hz: float, share: float = 0.99) -> ProcessNoise:
    """Process noise from the frequency content of a reference q (t, 25) (eq. 6 and 7), the mean over each group.

    sigma^2 = (A w^4 e^(w dt) / (4 pi) dt)^2 / (3 dt), with w the frequency below which `share` of the power lies and A
    the amplitude of the coordinate.
    """
    dt = 1.0 / rate_hz
    moved = q - q.mean(axis=0)
    power = np.abs(np.fft.rfft(moved, axis=0)[1:]) ** 2
    frequency = np.fft.rfftfreq(len(q), dt)[1:]
    below = np.cumsum(power, axis=0) / np.maximum(power.sum(axis=0), 1e-30)
    w = 2.0 * np.pi * frequency[np.argmax(below >= share, axis=0)]
    amplitude = np.ptp(q, axis=0) / 2.0
    sigma2 = (amplitude * w**4 * np.exp(w * dt) / (4.0 * np.pi) * dt) ** 2 / (3.0 * dt)
    groups = [sigma2[np.equal(GROUP, g)].mean() for g in range(len(GROUPS))]
    return ProcessNoise.of_groups(np.array(groups), held=True)


@dataclass(frozen=True)
class Search:
    """Bounds and length of a search over the 11 groups, in the unit of the process noise it starts from."""

    least: float = LEAST
    most: float = MOST
    evaluations: int = 12


def tuned_against_reference(
    recordings: Sequence[Recording], settings: FilterSettings, chosen: Sequence[int], search: Search,
    run: Callable[[Sequence[FilterSettings]], list[Array]] | None = None,
    on_step: Callable[[], None] = lambda: None,
) -> FilterSettings:  # fmt: skip
    """The process noise that brings the angles `chosen` (0 to 21) nearest to the reference (eq. 8).

    Trust region reflective, as in the paper, over the logarithm of the 11 values: they span five decades. `run` may
    evaluate several settings at once, in other processes; each result is `residuals` of all recordings. `on_step` is
    called after each derivative.
    """
    evaluate = run or (lambda batch: [residuals(recordings, one, chosen) for one in batch])
    held = settings.process.held
    start = np.clip(np.log10(settings.process.groups()), np.log10(search.least), np.log10(search.most))

    def with_groups(log_groups: Array) -> FilterSettings:
        return replace(settings, process=ProcessNoise.of_groups(10.0**log_groups, held=held))

    known: dict[bytes, Array] = {}

    def misfit(log_groups: Array) -> Array:
        key = log_groups.tobytes()
        if key not in known:
            known[key] = evaluate([with_groups(log_groups)])[0]
        return known[key]

    def slope(log_groups: Array) -> Array:
        # A tenth of a decade: finer differences only see where the gate and the bounds switch.
        columns = evaluate([with_groups(log_groups + 0.1 * row) for row in np.eye(len(GROUPS))])
        on_step()
        return np.stack([(column - misfit(log_groups)) / 0.1 for column in columns], axis=1)

    found = least_squares(
        misfit, start, slope, bounds=(np.log10(search.least) - 1e-9, np.log10(search.most) + 1e-9),
        method="trf", max_nfev=search.evaluations, ftol=1e-3, xtol=1e-2,
    )  # fmt: skip
    return with_groups(found.x)


def residuals(recordings: Sequence[Recording], settings: FilterSettings, chosen: Sequence[int]) -> Array:
    """Error of the chosen angles over all frames, rad, recordings one after another; a diverged filter is off by pi.

    Raises:
        ValueError: a recording has no reference.
    """
    rows = []
    for recording in recordings:
        if recording.angles is None:
            raise ValueError("tuning against a reference needs recordings with angles; without, hide centres")
        error = (replay(recording, settings)[0] - recording.angles)[:, list(chosen)]
        rows.append(np.where(np.isfinite(error), error, np.pi).ravel())
    return np.concatenate(rows)


def surprise(recordings: Sequence[Recording], settings: FilterSettings, skipped_s: float = 2.0) -> float:
    """Mean negative log likelihood per row of what each frame brought, given the frames before it.

    The innovations are all that a filter says about itself without a reference: y ~ N(0, S). A gated centre counts with
    the variance it was given.
    """
    total, rows = 0.0, 0
    for recording in recordings:
        ekf = WholeBodyEkf(recording.start, settings)
        for k, (centres, state) in enumerate(zip(recording.centres, recording.state, strict=True)):
            ekf.advance(1.0 / recording.rate_hz if k else 0.0, centres, state)
            if k < skipped_s * recording.rate_hz:
                continue
            count, squares, log_determinant = ekf.evidence()
            total += 0.5 * (squares + log_determinant)
            rows += count
    result = total / max(rows, 1)
    return result if np.isfinite(result) else 1e6


def tuned_by_innovations(
    recordings: Sequence[Recording], settings: FilterSettings, sweeps: int = 2, factor: float = 4.0,
    judge: Judge | None = None, on_step: Callable[[], None] = lambda: None,
) -> FilterSettings:  # fmt: skip
    """Camera variance and process noise that make the innovations likeliest, without any reference.

    Both must move together: with a measurement variance that is too large and fixed, the likeliest process noise is
    none, and angles lag. Kept to be compared: `hidden_centres` does better.
    """
    value = judge or (lambda batch: [surprise(recordings, one) for one in batch])
    return descend(value, settings, sweeps, factor, 1e-5, on_step)
