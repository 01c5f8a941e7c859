"""Rows for single treadmill steps: flexion step by step, and the axis against the line through the epicondyles."""

import csv
import gzip
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress
from scipy.spatial.transform import Rotation

from services.bench.accuracy.kam_steps import FOLDER, RATE_HZ, Step, read_steps
from services.bench.knee.comparison import OURS, Judged, judge, pooled
from services.bench.knee.comparison_tables import agreement_table, trial_charts
from services.bench.knee.peers import LITERAL
from services.bench.knee.recordings import KneeRecording
from services.bench.knee.scores import FLEXION, VALID
from services.bench.report import Section, Table, number
from services.bench.scoreboard import Row, informative
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.biomech.two_sensor_knee.mcgrath import knee_flexion
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters
from services.ingest.data import find_data

Array = NDArray[np.float64]

MARKERS = ("RFT", "RFME", "RFLE")
"""Trochanter, inner and outer epicondyle."""
GAP_S = 1.0
"""s between steps: longer than what the estimator bridges, so each step is levelled anew."""
ROUNDS = 6
"""Times that a step is played there and back before it is scored: some levelling times."""
PARAGRAPHS = [
    "Ten steps of 1 s each, not contiguous: too short to level a sensor in. Each is played to and fro six times "
    "(backwards the rates change their sign), then scored on a last pass, offset removed, against lines between joint "
    "centres; axis, arms and biases are kept from step to step, and all steps are shown twice. Offline; the sense of "
    "flexion is that which agrees; how much the force of the instant levels was chosen with it, too. Axis: against "
    "the epicondyles, carried to the sensor by fitting the markers' rate to the gyroscope. 'McGrath' has the maker's "
    "orientations and all steps.",
]


def kam_section(progress: Progress) -> Section:
    """All rows, tables and charts. Raises MissingFile without the data."""
    steps, estimator = read_steps(), KneeAxis(replace(KneeAxisParameters(), sign_evidence=0.0))
    outs: list[Array] = []
    for _ in range(2):
        outs = [_run(estimator, step) for step in progress.track(steps, description="kam")]
    sense = -1.0 if _correlation(outs, steps) < 0.0 else 1.0
    knees = {f"step {k}": _recording(f"step {k}", step) for k, step in enumerate(steps)}
    ours = [
        judge(OURS, sense * out[:, FLEXION], knee, knee.holds, out[:, VALID] > 0)
        for out, knee in zip(outs, knees.values(), strict=True) if (out[:, VALID] > 0).any()
    ]  # fmt: skip
    rows = [informative("kam: steps with a valid angle", sum(bool((out[:, VALID] > 0).any()) for out in outs), "")]
    literal = _published(steps, list(knees.values()))
    for method, judged in ((OURS, ours), (LITERAL, literal)):
        rows += _step_rows(f"kam, {method}", judged)
    true = epicondyles_in_sensor(steps)
    angle = float(np.degrees(np.arccos(min(1.0, abs(float(estimator.axes[0] @ true))))))
    rows.append(informative("kam: axis of the thigh against the epicondyles", angle, "deg"))
    together = {"all steps": [_joined(judged) for judged in (ours, literal) if judged]}
    return Section(
        "Treadmill steps", PARAGRAPHS, rows, [_step_table(ours, literal), agreement_table(together)],
        trial_charts(together, {"all steps": RATE_HZ}),
    )  # fmt: skip


def _step_rows(name: str, judged: list[Judged]) -> list[Row]:
    if not judged:
        return []
    spread = [one.errors.zero_mean_rmse for one in judged]
    return [
        informative(f"{name}: flexion, offset-removed, mean of steps", float(np.mean(spread)), "deg"),
        informative(f"{name}: flexion, offset-removed, worst step", max(spread), "deg"),
        informative(f"{name}: flexion, absolute, all steps", pooled(judged).absolute_rmse, "deg", detail=True),
    ]


def _step_table(ours: list[Judged], literal: list[Judged]) -> Table:
    lines = []
    for k, published in enumerate(literal):
        own = [one for one in ours if one.trial == published.trial]
        figures = [*(_pair(own[0]) if own else (np.nan, np.nan)), *_pair(published)]
        lines.append([str(k), *map(number, figures)])
    header = ("step", "ours, zero-mean", "ours, absolute", "McGrath, zero-mean", "McGrath, absolute")
    return Table("RMSE by step, deg", header, lines)


def _pair(one: Judged) -> tuple[float, float]:
    found = one.errors
    return found.zero_mean_rmse, found.absolute_rmse


def _published(steps: list[Step], knees: list[KneeRecording]) -> list[Judged]:
    """McGrath on the maker's orientations, one axis for all steps."""
    turned = maker_orientations()
    rates = [np.vstack([step.samples[1:, s, :3] for step in steps]) for s in (1, 2)]
    angle, _ = knee_flexion(*(np.concatenate([one[s][1:] for one in turned]) for s in range(2)), *rates)
    angles = np.split(angle, np.cumsum([len(step.samples) - 1 for step in steps])[:-1])
    both = [
        [judge(LITERAL, sense * part, knee, knee.holds, knee.holds) for part, knee in zip(angles, knees, strict=True)]
        for sense in (1.0, -1.0)
    ]
    return min(both, key=lambda judged: pooled(judged).zero_mean_rmse)


def _joined(judged: list[Judged]) -> Judged:
    """All steps as one trial, one after the other."""
    frames = np.arange(sum(len(one.frames) for one in judged))
    estimate, truth = (np.concatenate([getattr(one, part) for one in judged]) for part in ("estimate", "truth"))
    return judged[0]._replace(frames=frames, estimate=estimate, truth=truth)


def _recording(name: str, step: Step) -> KneeRecording:
    samples, truth = step.samples[1:, 1:], np.radians(step.knee_deg[1:])
    return KneeRecording(name, RATE_HZ, samples[:, :, :3], samples[:, :, 3:], truth, np.isfinite(truth), None)


def maker_orientations() -> list[tuple[Array, Array]]:
    """R_world_from_sensor (n, 3, 3) of thigh and shank in each step. Raises MissingFile without the data."""
    rows, number_of = _table()
    quats = [
        np.array([[float(row[f"Quat{part}_{sensor}"]) for part in (1, 2, 3, 4)] for row in rows])
        for sensor in ("R_THIGH", "R_SHANK")
    ]
    matrices = [Rotation.from_quat(quat, scalar_first=True).as_matrix() for quat in quats]
    return [(matrices[0][number_of == k], matrices[1][number_of == k]) for k in np.unique(number_of)]


def _run(estimator: KneeAxis, step: Step) -> Array:
    samples = step.samples[:, 1:]
    rate, force = samples[:, :, :3], samples[:, :, 3:]
    estimator.step(np.full((2, 3), np.nan), np.full((2, 3), np.nan), GAP_S)
    for _ in range(ROUNDS):
        estimator.run(rate, force, 1.0 / RATE_HZ)
        # The turn between samples k and k + 1 is the rate at k + 1, and is undone on the way back to k.
        estimator.run(-rate[:0:-1], force[-2::-1], 1.0 / RATE_HZ)
    return estimator.run(rate[1:], force[1:], 1.0 / RATE_HZ)


def _correlation(outs: list[Array], steps: list[Step]) -> float:
    angle = np.concatenate([out[:, FLEXION] - out[:, FLEXION].mean() for out in outs])
    truth = np.concatenate([step.knee_deg[1:] - step.knee_deg[1:].mean() for step in steps])
    return float(angle @ truth)


def epicondyles_in_sensor(steps: list[Step]) -> Array:
    """Direction (3,) of the line through the epicondyles in the thigh's sensor, of open sense.

    The markers of a step are one rigid body; its rate, turned as agrees best with the gyroscope, gives how the sensor
    lies in it. Raises MissingFile without the data.
    """
    marker_rates, gyro_rates, line = [], [], np.zeros(3)
    shape: Array | None = None
    for points, step in zip(_marker_paths(), steps, strict=True):
        centred = points - points.mean(axis=1, keepdims=True)
        if shape is None:
            shape = centred[0]
            line = shape[2] - shape[1]
        turns = [Rotation.align_vectors(frame, shape)[0] for frame in centred]
        lab_from_body = Rotation.from_quat([turn.as_quat() for turn in turns])
        rate = (lab_from_body[:-2].inv() * lab_from_body[2:]).as_rotvec() * RATE_HZ / 2.0
        marker_rates.append(rate)
        gyro_rates.append(step.samples[1:-1, 1, :3])
    body_from_sensor = Rotation.align_vectors(np.vstack(marker_rates), np.vstack(gyro_rates))[0]
    return np.asarray(body_from_sensor.inv().apply(line / np.linalg.norm(line)))


def _marker_paths() -> list[Array]:
    """(n, 3, 3) of each step: MARKERS in mm."""
    rows, number_of = _table()
    paths = np.array([[[float(row[f"{m}_{axis}"]) for axis in "XYZ"] for m in MARKERS] for row in rows])
    return [paths[number_of == k] for k in np.unique(number_of)]


def _table() -> tuple[list[dict[str, str]], Array]:
    """Rows of the file, and the step of each."""
    with gzip.open(find_data(FOLDER) / "steps.csv.gz", "rt") as file:
        rows = list(csv.DictReader(file))
    return rows, np.array([float(row["step"]) for row in rows])
