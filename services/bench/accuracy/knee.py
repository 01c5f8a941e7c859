"""Knee angle of recordings with one referenced knee: drop landings (two sensors of one leg), sit-to-stand."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import LOWER_BODY_ESTIMATORS, Side
from services.bench.accuracy.joint_scores import Score, best_score, column_of, estimate_angles, score
from services.bench.accuracy.neura_truth import reference_channels
from services.bench.accuracy.vqf_hinge import is_installed, vqf_hinge_angles
from services.bench.accuracy.walk import PUBLISHED
from services.bench.scoreboard import Row, Scoreboard, at_most, informative

Array = NDArray[np.float64]
SIDE = Side.LEFT
"""The knee that was measured."""


class KneeRecording(NamedTuple):
    """What is scored, and what was used to choose parameters."""

    spec: str
    target_deg: float
    windows: dict[str, tuple[int, int]]  # first sample and one after the last
    note: str


KNEES = {
    "fan": KneeRecording(
        "fan_knee_drop_landing_left",
        1.0,
        {"whole": (0, 6671), "chosen on": (0, 2200), "others": (2200, 6671)},
        """Left thigh and shank alone. accel_std was chosen by the errors of the first 22 s and of sit-to-stand,
sample_delay by the lag of both, force_bound and impact_deviations by the errors of the first 22 s with those of the
rest in view, impact_rate by what the gyroscopes of the recorded walk reach, rate_jump by the landings of all of it.
The laboratory's angle is 10 deg while standing: that is most of the absolute error. Zero = quiet standing.
Baseline: VQF per sensor with headings tied at the joint, same alignment, biases and samples.""",
    ),
    "alborno": KneeRecording(
        "alborno_sub03_sts1",
        1.2,
        {"repetitions": (616, 1550)},
        """Five sensors. The zero is a marked standing of 0.55 s between two repetitions; scored from its end. accel_std
was chosen here and on drop landings, the least standing for a bias here. Baseline: VQF per sensor with headings tied
at the joint.""",
    ),
}


def knee_scores(angles: Array, truth: Array, windows: dict[str, tuple[int, int]]) -> dict[str, tuple[Score, Score]]:
    """Scores of the knee (n, 15), deg, in each window: at the best shift and at none.

    Estimates begin with the end of standing; samples before it are left out.
    """
    estimate = angles[:, column_of(f"knee_flexion_{SIDE}")]
    room = min(len(estimate), len(truth)) - 4
    result = {}
    for name, (first, last) in windows.items():
        frames = np.arange(max(first, 4), min(last, room))
        frames = frames[np.isfinite(truth[frames]) & np.isfinite(estimate[frames - 4])]
        result[name] = best_score(estimate, truth, frames), score(estimate, truth, frames, 0)
    return result


def knee_truth(spec: str) -> Array:
    """Measured knee flexion, deg."""
    return np.asarray(np.degrees(reference_channels(spec)[f"knee_flexion_{SIDE}"]))


def _baseline(recording: KneeRecording, truth: Array) -> dict[str, tuple[Score, Score]]:
    """Scores of VQF on the samples that our estimates are scored on: it has angles of the quiet standing before too."""
    column = column_of(f"knee_flexion_{SIDE}")
    ours, angles = estimate_angles(recording.spec, "ekf")[:, column], vqf_hinge_angles(recording.spec)
    estimated = np.zeros(len(angles), dtype=np.bool_)
    estimated[: len(ours)] = np.isfinite(ours)[: len(angles)]
    angles[~estimated, column] = np.nan
    return knee_scores(angles, truth, recording.windows)


def run(subject: str, json_path: Path | None = None) -> Scoreboard:
    """Score all estimators on one of KNEES."""
    recording = KNEES[subject]
    truth = knee_truth(recording.spec)
    baseline = _baseline(recording, truth) if is_installed() else None
    rows: list[Row] = []
    for estimator in LOWER_BODY_ESTIMATORS:
        reached = knee_scores(estimate_angles(recording.spec, estimator), truth, recording.windows)
        for window, (best, fixed) in reached.items():
            title = f"{estimator}, knee {SIDE}, {window}"
            beside = baseline[window][0] if baseline else None
            mean, beside_deg = f"{title}: offset-removed", beside.offset_removed_deg if beside else None
            if estimator == PUBLISHED:
                rows.append(informative(mean, best.offset_removed_deg, "deg", beside_deg))
            else:
                rows.append(at_most(mean, best.offset_removed_deg, "deg", recording.target_deg, beside_deg))
            rows.append(informative(f"{title}: offset-removed, shift 0", fixed.offset_removed_deg, "deg", detail=True))
            rows.append(
                informative(f"{title}: absolute", best.absolute_deg, "deg", beside.absolute_deg if beside else None)
            )
            rows.append(informative(f"{title}: shift", best.shift, "samples"))
            rows.append(informative(f"{title}: r", best.correlation, "", detail=True))
    board = Scoreboard(f"accuracy on {recording.spec}", rows, recording.note)
    if json_path is not None:
        board.write_json(json_path)
    return board
