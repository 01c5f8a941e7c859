"""What a gyroscope bias that drifts costs, with and without following it in pauses: synthetic walks of ten minutes."""

from collections.abc import Iterator
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

from schemas.imu import ReferenceBatch
from schemas.kinematics import JointState
from schemas.signals import JOINT_STATE, REFERENCE
from schemas.vocabulary import LOWER_BODY
from services.bench.accuracy.joint_scores import column_of
from services.bench.scoreboard import Row, Scoreboard, at_most, informative
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.parameters import EstimationParameters
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.flow.message import Message
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]

SUBJECT = "drift"
DURATION_S = 600.0
SEEDS = (11, 12)
DRIFT = 0.0087
"""rad/s (0.5 deg/s) within the ten minutes, standard deviation of each axis of each sensor; linear."""
WALK = "synthetic:walk?duration={duration:g}&stop_every=60&pause=5&soft_tissue=0.03&gyro_drift={drift:g}&seed={seed}"
SIDES = ("left", "right")
GROUPS = {
    "pelvis tilt and obliquity": ["pelvis_tilt", "pelvis_obliquity"],
    "hip flexion": [f"hip_flexion_{side}" for side in SIDES],
    "hip rotation": [f"hip_internal_rotation_{side}" for side in SIDES],
    "knee flexion": [f"knee_flexion_{side}" for side in SIDES],
}
LARGEST_GROWTH_DEG = 0.1
NOTE = f"""Means of {len(SEEDS)} walks (seeds {", ".join(map(str, SEEDS))}) of 10 min, 5 s of standing after each
minute, 2 deg of soft tissue; rms as it stands over the second half. Biases drift by 0.5 deg/s (one standard deviation),
linearly. Growth: against the same walks whose biases stay; baseline: its growth where the bias is not followed.
Nothing was chosen on these walks."""

Errors = dict[str, float]
"""rms in deg by group."""


def errors(seed: int, drift: float, duration_s: float = DURATION_S) -> dict[bool, Errors]:
    """Errors over the second half of one walk, by whether the bias was followed."""
    source = open_source(WALK.format(duration=duration_s, drift=drift, seed=seed), session="drift", estimator="ekf")
    description = source.describe()
    chains = {
        follow: Chain(
            [HostedNode("estimation", "drift", LowerBodyNode(description, EstimationParameters(follow_bias=follow)))]
        )
        for follow in (False, True)
    }
    truth: dict[int, list[float]] = {}
    estimated: dict[bool, dict[int, list[float]]] = {follow: {} for follow in chains}
    for message in iter_messages(source):
        for follow, chain in chains.items():
            estimated[follow].update(_positions(chain, message))
        if message.stream.signal is REFERENCE and isinstance(message.payload, ReferenceBatch):
            rows = [[float(value or 0.0) for value in row[: len(LOWER_BODY)]] for row in message.payload.values]
            truth.update(zip(message.payload.captured_ns, rows, strict=True))
    return {follow: _errors(rows, truth, duration_s / 2.0) for follow, rows in estimated.items()}


def _positions(chain: Chain, message: Message) -> Iterator[tuple[int, list[float]]]:
    for produced in chain.push(message):
        if produced.stream.signal is JOINT_STATE and isinstance(produced.payload, JointState):
            yield from zip(produced.payload.captured_ns, produced.payload.position, strict=True)


def _errors(estimated: dict[int, list[float]], truth: dict[int, list[float]], from_s: float) -> Errors:
    shared = sorted(ns for ns in estimated.keys() & truth.keys() if ns >= from_s * 1e9)
    apart = np.degrees(np.array([estimated[ns] for ns in shared]) - np.array([truth[ns] for ns in shared]))
    return {
        group: float(np.mean([np.sqrt(np.mean(apart[:, column_of(name)] ** 2)) for name in names]))
        for group, names in GROUPS.items()
    }


def run(json_path: Path | None = None) -> Scoreboard:
    """Walk and score."""
    cases = list(product(SEEDS, (0.0, DRIFT)))
    with Progress(transient=True) as progress:
        found = {case: errors(*case) for case in progress.track(cases, description="walks of 10 min")}
    rows: list[Row] = []
    for group in GROUPS:
        mean = {
            (drift > 0.0, follow): float(np.mean([found[seed, drift][follow][group] for seed in SEEDS]))
            for drift, follow in product((0.0, DRIFT), (False, True))
        }
        rows.append(informative(f"{group}: steady biases, not followed", mean[False, False], "deg"))
        rows.append(informative(f"{group}: steady biases, followed", mean[False, True], "deg"))
        rows.append(informative(f"{group}: drifting biases, not followed", mean[True, False], "deg"))
        rows.append(informative(f"{group}: drifting biases, followed", mean[True, True], "deg"))
        growth = mean[True, True] - mean[False, False]
        lost = mean[True, False] - mean[False, False]
        rows.append(at_most(f"{group}: growth by the drift, followed", growth, "deg", LARGEST_GROWTH_DEG, lost))
    board = Scoreboard("accuracy with drifting gyroscope biases", rows, NOTE)
    if json_path is not None:
        board.write_json(json_path)
    return board
