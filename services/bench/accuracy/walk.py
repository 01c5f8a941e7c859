"""Joint angles against optical motion capture, through the same nodes as live."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from schemas.session import SessionDescription
from schemas.vocabulary import LOWER_BODY_ESTIMATORS, Side
from services.bench.accuracy.joint_scores import SHIFTS, Score, best_score, column_of, estimate_angles, score
from services.bench.accuracy.neura_truth import NeuraTruth, collect_truth
from services.bench.accuracy.vqf_hinge import is_installed, vqf_hinge_angles
from services.bench.scoreboard import Row, Scoreboard, at_most, informative
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.parameters import PUBLISHED as PUBLISHED_PARAMETERS
from services.estimation.parameters import EstimationParameters
from services.flow.node import Node

Array = NDArray[np.float64]

NOTE = """Means of both sides. Each side's shift between sensor and camera clocks is one constant in -3..+3 samples.
Baseline: VQF per sensor with headings tied at the joints. The truths themselves differ by 1.9 (right knee) and 4.2
(left knee) deg rms; one person and two or three strides each way: differences below 0.2 deg mean nothing.
Straight path: heading of pelvis and thighs against the world (Joukov eq. 22); all else is the turning mode, thighs
against the pelvis. joukov_published has the oscillator and the measurement model as printed.
Without standing: the node sees the walk alone; scored from 1 s after its first estimate. How little it believes biases
told by walking was set on this recording."""

RECORDINGS = {"neura": "neura_s02_walk", "neura_midshank": "neura_s02_walk_midshank"}
FIXED_SHIFT = 0
STRAIGHT = np.r_[1119:1454, 1651:2073]
"""Frames of the two straight passes."""
WITH_TURN = np.r_[1119:2073]
"""Frames of the whole walk, the 180 degree turn included."""
PATH_WINDOWS = {"before the turn": np.r_[1119:1454], "straight": STRAIGHT, "with turn": WITH_TURN}
"""Before the turn the path is straight as the operator said; behind it the walk goes the other way."""
WINDOWS = {"straight": STRAIGHT, "with turn": WITH_TURN}
PUBLISHED = "joukov_published"
FLOORS = {
    ("knee PiG", "straight"): 3.5, ("knee PiG", "with turn"): 3.8,
    ("hip", "straight"): 2.8, ("hip", "with turn"): 3.1,
}  # fmt: skip
"""deg, offset removed, mean of both sides."""
WITHOUT_STANDING = {("knee PiG", "straight"): 2.9}
"""deg, offset removed, mean of both sides, where the walk is calibrated from itself."""

Figures = dict[tuple[str, str], dict[Side, Score]]
"""(truth, window) -> score of each side at its best shift."""


def figures(
    angles: Array,
    truth: NeuraTruth,
    *,
    fixed_shift: int | None = None,
    windows: dict[str, NDArray[np.int64]] = WINDOWS,
) -> Figures:
    """Scores of angles (frames, 15) against all truths in all windows."""
    result: Figures = {}
    for window, frames in windows.items():
        for label, (joint, truths) in truth.by_label().items():
            sides = {side: angles[:, column_of(f"{joint}_flexion_{side}")] for side in Side}
            result[label, window] = {
                side: best_score(estimate, truths[side], frames)
                if fixed_shift is None
                else score(estimate, truths[side], frames, fixed_shift)
                for side, estimate in sides.items()
            }
    return result


def mean_of(scores: dict[Side, Score]) -> float:
    """Offset-removed error, mean of both sides, deg."""
    return float(np.mean([s.offset_removed_deg for s in scores.values()]))


def absolute_mean_of(scores: dict[Side, Score]) -> float:
    """Error as it stands, mean of both sides, deg."""
    return float(np.mean([s.absolute_deg for s in scores.values()]))


def estimator_rows(name: str, angles: Array, truth: NeuraTruth, baseline: Figures) -> list[Row]:
    """All figures of one estimator; `baseline` may be empty. The published filter is shown, not held to our floors."""
    rows: list[Row] = []
    fixed = figures(angles, truth, fixed_shift=FIXED_SHIFT)
    for key, scores in figures(angles, truth).items():
        title, floor = f"{name}, {key[0]}, {key[1]}", None if name == PUBLISHED else FLOORS.get(key)
        beside = mean_of(baseline[key]) if baseline else None
        mean = f"{title}: offset-removed"
        if floor is None:
            rows.append(informative(mean, mean_of(scores), "deg", beside))
        else:
            rows.append(at_most(mean, mean_of(scores), "deg", floor, beside))
        rows.append(
            informative(f"{title}: offset-removed, shift {FIXED_SHIFT}", mean_of(fixed[key]), "deg", detail=True)
        )
        rows.append(informative(f"{title}: absolute", absolute_mean_of(scores), "deg"))
        for side, s in scores.items():
            rows.append(informative(f"{title}, {side}: offset-removed", s.offset_removed_deg, "deg", detail=True))
            rows.append(informative(f"{title}, {side}: r", s.correlation, "", detail=True))
            rows.append(informative(f"{title}, {side}: shift", s.shift, "samples", detail=True))
    return rows


def run(subject: str, json_path: Path | None = None) -> Scoreboard:
    """Score all estimators on one of RECORDINGS."""
    spec = RECORDINGS[subject]
    truth = collect_truth(spec)
    baseline = figures(vqf_hinge_angles(spec), truth) if is_installed() else {}
    rows: list[Row] = []
    for estimator in LOWER_BODY_ESTIMATORS:
        rows += estimator_rows(estimator, estimate_angles(spec, estimator), truth, baseline)
    rows += without_standing_rows(without_standing(spec, truth))
    rows += walk_path_rows(spec, truth)
    rows += deviation_rows(spec, truth)
    board = Scoreboard(f"accuracy on {spec}", rows, NOTE)
    if json_path is not None:
        board.write_json(json_path)
    return board


def deviation_rows(spec: str, truth: NeuraTruth) -> list[Row]:
    """How often the truths of the walk with its turn are within twice the published deviation, each side at its shift.

    The soft tissue in the deviation was taken from this person: it is no test, but it shows what is claimed.
    """
    angles = estimate_angles(spec, "rhythmic_ekf")
    claimed = estimate_angles(spec, "rhythmic_ekf", quantity="position_std")
    rows: list[Row] = []
    for label, (joint, truths) in truth.by_label().items():
        for side, measured in truths.items():
            column = column_of(f"{joint}_flexion_{side}")
            shift = best_score(angles[:, column], measured, WITH_TURN).shift
            error, std = angles[WITH_TURN + shift, column] - measured[WITH_TURN], claimed[WITH_TURN + shift, column]
            for what, left in (("absolute", error), ("offset removed", error - error.mean())):
                held = 100.0 * float(np.mean(np.abs(left) < 2.0 * std))
                rows.append(informative(f"{label} {side}, with turn: within 2 std, {what}", held, "%"))
    return rows


def walk_path_rows(spec: str, truth: NeuraTruth) -> list[Row]:
    """Both choices of `walk_path` beside each other, and how much the trust in the heading matters."""
    before = {"before the turn": PATH_WINDOWS["before the turn"]}
    rows = path_rows("ekf, turning path", figures(estimate_angles(spec, "ekf"), truth, windows=before))
    for estimator in ("ekf", PUBLISHED):
        angles = estimate_angles(spec, estimator, walk_path="straight")
        rows += path_rows(f"{estimator}, straight path", figures(angles, truth, windows=PATH_WINDOWS))
    angles = estimate_angles(spec, "ekf", _sure_of_yaw, walk_path="straight")
    return rows + path_rows("ekf, straight path, yaw to 0.1 rad", figures(angles, truth, windows=PATH_WINDOWS))


def path_rows(title: str, scores: Figures) -> list[Row]:
    """The same walk by an operator who said that it is straight: true before the turn, wrong with it."""
    return [
        informative(f"{title}, {label}, {window}: offset-removed", mean_of(sides), "deg", detail="centres" in label)
        for (label, window), sides in scores.items()
    ]


def _sure_of_yaw(description: SessionDescription) -> Node:
    ours = EstimationParameters()
    noise = replace(ours.filter.noise, yaw_std=PUBLISHED_PARAMETERS.noise.yaw_std)
    return LowerBodyNode(description, replace(ours, filter=replace(ours.filter, noise=noise)))


def without_standing(spec: str, truth: NeuraTruth) -> Figures:
    """Scores when the walk is all that the node is shown: nobody stood. From 1 s after the first estimate."""
    angles = estimate_angles(spec, "ekf", during_s=(WITH_TURN[0] / 100.0, (WITH_TURN[-1] + 1) / 100.0))
    estimated = np.flatnonzero(np.isfinite(angles[:, 0]))
    if len(estimated) == 0:
        return {}
    first, last = estimated[0] + 100, estimated[-1]
    windows = {
        name: frames[(frames + SHIFTS[0] >= first) & (frames + SHIFTS[-1] <= last)] for name, frames in WINDOWS.items()
    }
    return figures(angles, truth, windows=windows)


def without_standing_rows(scores: Figures) -> list[Row]:
    """What is left where nobody stood: shape as before, zero from the population."""
    rows: list[Row] = []
    for key, sides in scores.items():
        title, target = f"ekf without standing, {key[0]}, {key[1]}", WITHOUT_STANDING.get(key)
        mean = f"{title}: offset-removed"
        rows.append(
            at_most(mean, mean_of(sides), "deg", target) if target else informative(mean, mean_of(sides), "deg")
        )
        rows.append(informative(f"{title}: absolute", absolute_mean_of(sides), "deg"))
    return rows
