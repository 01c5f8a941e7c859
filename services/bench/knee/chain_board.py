"""The same knees as sessions: ingest and the plain loop of all nodes, beside the library called directly."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

from schemas.kinematics import JointState
from schemas.signals import JOINT_STATE
from schemas.vocabulary import LOWER_BODY, Side
from services.bench.knee.recordings import KneeRecording, from_manifest
from services.bench.knee.scores import FLEXION, VALID, KneeScore, Pass, run_knee, score
from services.bench.knee.worn_board import ALBORNO, FAN, NEURA, PARAMETERS, SCORED_ALBORNO, WITH_TURN
from services.bench.report import Section
from services.bench.scoreboard import Row, at_most, informative
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

ESTIMATORS = ("knee_axis", "knee_axis_mcgrath")
PARAGRAPHS = [
    "Recordings as sessions of one knee: ingest, messages, estimation, segmentation, metrics in the loop of "
    "`ambula run`. Scored is what joint_state holds and calls valid, offset-removed RMSE at the best constant shift. "
    "The baseline is the library on the same samples in its second pass, for the node too goes back over what it kept.",
]


class Case(NamedTuple):
    """A recording, its side, what is scored, and the target in deg."""

    spec: str
    side: Side
    frames: NDArray[np.int64]
    limit: float | None


CASES = {
    "fan": Case(FAN, Side.LEFT, np.arange(100, 6668), 0.9),
    "alborno": Case(ALBORNO, Side.LEFT, np.arange(*SCORED_ALBORNO), 1.5),
    "neura left": Case(NEURA["neura"], Side.LEFT, WITH_TURN, None),
    "neura right": Case(NEURA["neura"], Side.RIGHT, WITH_TURN, None),
}


def chain_section(progress: Progress) -> Section:
    """All rows. Raises MissingFile without the data."""
    rows: list[Row] = []
    cases = [(estimator, name) for estimator in ESTIMATORS for name in CASES]
    for estimator, name in progress.track(cases, description="through the service"):
        case = CASES[name]
        recording = from_manifest(case.spec, case.side)
        asked = np.zeros(len(recording.flexion), dtype=np.bool_)
        asked[case.frames] = recording.holds[case.frames]
        angle = published_flexion(case, estimator, recording)
        title = f"{name} as a session of {estimator}"
        if not (asked & np.isfinite(angle)).any():
            rows.append(Row(f"{title}: offset-removed", None, "deg", "no valid angle came", None, None))
            continue
        s = score(angle, recording.flexion, asked, np.isfinite(angle))
        limit = case.limit if estimator == ESTIMATORS[0] else None
        rows += _rows(title, s, _library(recording, asked) if estimator == ESTIMATORS[0] else None, limit)
    return Section("As a session", PARAGRAPHS, rows)


def published_flexion(case: Case, estimator: str, recording: KneeRecording) -> Array:
    """Flexion (n,), rad, that the chain publishes as valid at each frame; NaN where it does not.

    Where a frame is published twice, what came last stands.
    """
    from services.cli.assembly import build_chain

    source = open_source(case.spec, session="knee", estimator=estimator)
    chain = build_chain(source.describe())
    column = [dof.name for dof in LOWER_BODY].index(f"knee_flexion_{case.side}")
    angle = np.full(len(recording.flexion), np.nan)
    for message in iter_messages(source):
        for produced in chain.push(message):
            state = produced.payload
            if produced.stream.signal is JOINT_STATE and isinstance(state, JointState) and state.valid[column]:
                frames = [round(captured_ns * recording.rate_hz / 1e9) for captured_ns in state.captured_ns]
                kept = [(frame, row[column]) for frame, row in zip(frames, state.position, strict=True)]
                for frame, value in kept:
                    if frame < len(angle):
                        angle[frame] = value
    return angle


def _library(recording: KneeRecording, asked: Mask) -> KneeScore:
    out, _ = run_knee(recording, PARAMETERS, Pass.SECOND)
    return score(out[:, FLEXION], recording.flexion, asked, out[:, VALID] > 0)


def _rows(title: str, s: KneeScore, library: KneeScore | None, limit: float | None) -> list[Row]:
    value = float(np.degrees(s.shifted.zero_mean_rmse))
    baseline = None if library is None else float(np.degrees(library.shifted.zero_mean_rmse))
    figure = f"{title}: offset-removed"
    return [
        informative(figure, value, "deg", baseline)
        if limit is None
        else at_most(figure, value, "deg", limit, baseline),
        informative(f"{title}: absolute", float(np.degrees(s.shifted.absolute_rmse)), "deg", detail=True),
        informative(
            f"{title}: share with a valid angle", s.coverage, "", None if library is None else library.coverage
        ),
    ]
