"""Our estimate and every other method on one recording, scored alike: the error analysis of McGrath et al. 2018."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.bench.knee import peers
from services.bench.knee.agreement import BlandAltman, Errors, bland_altman, errors, unwrapped_error
from services.bench.knee.recordings import KneeRecording
from services.bench.knee.scores import KneeScore, score

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

OURS = "ours"


class Judged(NamedTuple):
    """One method on one recording. Angles in deg, at the samples that were scored, clocks aligned by a constant."""

    trial: str
    method: str
    frames: NDArray[np.int64]
    estimate: Array
    truth: Array
    score: KneeScore  # rad
    cost_us: float | None  # of a sample, both sensors

    @property
    def agreement(self) -> BlandAltman:
        """Of the estimate as it is, datum included."""
        return bland_altman(self.estimate, self.truth)

    @property
    def errors(self) -> Errors:
        """Absolute and zero-mean, deg."""
        return errors(self.estimate, self.truth)


def judge(
    method: str, angle: Array, recording: KneeRecording, asked: Mask, valid: Mask, *, absolute: bool = False,
    cost_us: float | None = None,
) -> Judged:  # fmt: skip
    """Score an angle (n,), rad, where asked and valid, at zero and at the best constant shift.

    Raises:
        ValueError: none of the asked samples has a valid estimate.
    """
    s = score(angle, recording.flexion, asked, valid, absolute=absolute)
    frames = np.flatnonzero(asked & valid & np.isfinite(angle))
    truth = np.interp(frames - s.shift, np.arange(len(angle)), np.unwrap(recording.flexion))
    error = unwrapped_error(angle[frames], truth)
    return Judged(recording.name, method, frames, np.degrees(truth + error), np.degrees(truth), s, cost_us)


def judge_peers(recording: KneeRecording, asked: Mask, *, absolute: bool = False) -> tuple[list[Judged], list[str]]:
    """All of METHODS in the sense that agrees with the truth, and why some did not run.

    They see the whole recording before they say their axis.
    """
    found, absent = [], []
    everywhere = np.ones(len(recording.flexion), dtype=np.bool_)
    for method, (libraries, run) in peers.METHODS.items():
        reason = peers.missing(*libraries)
        if run is peers.mcgrath_as_measured and recording.orientations is None:
            reason = "no orientations came with the recording"
        if reason is not None:
            absent.append(f"{method}: {reason}")
            continue
        result = run(recording)
        both = [
            judge(method, sense * result.angle, recording, asked, everywhere, absolute=absolute,
                  cost_us=1e6 * result.seconds_per_sample)
            for sense in (1.0, -1.0)
        ]  # fmt: skip
        found.append(min(both, key=lambda one: one.score.shifted.zero_mean_rmse))
    return found, absent


def pooled(judged: Sequence[Judged]) -> Errors:
    """All samples of one method together (table 1, "total")."""
    return errors(np.concatenate([one.estimate for one in judged]), np.concatenate([one.truth for one in judged]))
