"""Rows for single treadmill steps: flexion step by step, and the axis against the line through the epicondyles."""

import csv
import gzip
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.bench.accuracy.kam_steps import FOLDER, RATE_HZ, Step, read_steps
from services.bench.knee.agreement import per_trial
from services.bench.knee.scores import FLEXION, VALID
from services.bench.scoreboard import Row, informative
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters
from services.ingest.data import find_data

Array = NDArray[np.float64]

MARKERS = ("RFT", "RFME", "RFLE")
"""Trochanter, inner and outer epicondyle."""
GAP_S = 1.0
"""s between steps: longer than what the estimator bridges, so each step is levelled anew."""
ROUNDS = 6
"""Times that a step is played there and back before it is scored: some levelling times."""
NOTE = """Ten steps of 1 s each, not contiguous: too short to level a sensor in. Each is played to and fro six times
(backwards the rates change their sign), then scored on a last pass, offset removed, against lines between joint
centres; axis, arms and biases are kept from step to step, and all steps are shown twice. Offline; the sense of
flexion is that which agrees, nothing else was chosen here. Axis: against the epicondyles, carried to the sensor
by fitting the markers' rate to the gyroscope."""


def kam_rows() -> list[Row]:
    """All rows. Raises MissingFile without the data."""
    steps, estimator = read_steps(), KneeAxis(replace(KneeAxisParameters(), sign_evidence=0.0))
    outs: list[Array] = []
    for _ in range(2):
        outs = [_run(estimator, step) for step in steps]
    sense = -1.0 if _correlation(outs, steps) < 0.0 else 1.0
    trials = {
        str(k): (np.where(out[:, VALID] > 0, sense * np.degrees(out[:, FLEXION]), np.nan), step.knee_deg[1:])
        for k, (out, step) in enumerate(zip(outs, steps, strict=True))
        if (out[:, VALID] > 0).any()
    }
    rows = [informative("kam: steps with a valid angle", len(trials), "")]
    if trials:
        table = per_trial(trials)
        spread = [errors.zero_mean_rmse for name, errors in table.items() if name != "total"]
        rows.append(informative("kam: flexion, offset-removed, mean of steps", float(np.mean(spread)), "deg"))
        rows.append(informative("kam: flexion, offset-removed, worst step", max(spread), "deg"))
        rows.append(informative("kam: flexion, absolute, all steps", table["total"].absolute_rmse, "deg", detail=True))
    true = epicondyles_in_sensor(steps)
    angle = float(np.degrees(np.arccos(min(1.0, abs(float(estimator.axes[0] @ true))))))
    rows.append(informative("kam: axis of the thigh against the epicondyles", angle, "deg"))
    return rows


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
    with gzip.open(find_data(FOLDER) / "steps.csv.gz", "rt") as file:
        rows = list(csv.DictReader(file))
    number = np.array([float(row["step"]) for row in rows])
    paths = np.array([[[float(row[f"{m}_{axis}"]) for axis in "XYZ"] for m in MARKERS] for row in rows])
    return [paths[number == k] for k in np.unique(number)]
