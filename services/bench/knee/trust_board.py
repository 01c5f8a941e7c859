"""Whether the knee's claimed deviations hold, and whether it takes soft tissue for a slipped sensor."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress
from scipy.spatial.transform import Rotation

from schemas.vocabulary import Side
from services.bench.knee.agreement import unwrapped_error
from services.bench.knee.hinge_board import HINGE
from services.bench.knee.legs import Motion, Sensors, record, sit_to_stand, walking
from services.bench.knee.recordings import KneeRecording, from_manifest, weygers
from services.bench.knee.scores import FLEXION, FROM_SENSORS, STD, VALID, run_knee
from services.bench.knee.worn_board import ALBORNO, FAN, NEURA, PARAMETERS
from services.bench.report import Section, Table, number
from services.bench.scoreboard import Row, at_most, informative
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

Array = NDArray[np.float64]

SEEDS = range(9000, 9006)
SOFT_TISSUE = (0.02, 0.05)
"""rad by which the thigh's sensor wobbles."""
RATE_HZ, DURATION_S = 100.0, 40.0
WITHIN = (1.0, 1.96)
"""Claimed deviations that should hold 68 and 95 % of the errors."""
PARAGRAPHS = [
    "Shares of the errors within 1 and 1.96 claimed deviations (68 and 95 % if they were normal), first pass, where "
    "the angle is valid: with the offset removed, and as it stands. A claimed deviation is that of changes; what a "
    "datum is off by is not in it, and the last column says how much that was. Deviations were set on weygers 02 and "
    "synthetic legs of other seeds. No recording may show a slip; legs whose sensor does slip are in the unit tests.",
]


def trust_section(progress: Progress) -> Section:
    """Rows and table. Raises MissingFile without the data."""
    rows: list[Row] = []
    lines = []
    for name, outputs, truth, slips in progress.track(_cases(), description="trust"):
        used = (outputs[:, VALID] > 0) & np.isfinite(truth)
        error, std = unwrapped_error(outputs[used, FLEXION], truth[used]), outputs[used, STD]
        offset = float(np.angle(np.mean(np.exp(1j * error))))
        shape = [float(np.mean(np.abs(error - offset) < width * std)) for width in WITHIN]
        whole = [float(np.mean(np.abs(error) < width * std)) for width in WITHIN]
        for width, share, standing in zip(("68", "95"), shape, whole, strict=True):
            rows.append(informative(f"trust, {name}: errors in {width} %, offset removed", 100.0 * share, "%"))
            rows.append(informative(f"trust, {name}: errors in {width} %", 100.0 * standing, "%", detail=True))
        rows.append(at_most(f"trust, {name}: slips seen where there were none", slips, "", 0.0))
        lines.append([name, *(number(100.0 * x) for x in (*shape, *whole)), number(float(np.degrees(offset)))])
    head = [
        "",
        "68 %, offset removed",
        "95 %, offset removed",
        "68 %, as it stands",
        "95 %, as it stands",
        "offset, deg",
    ]
    return Section("Claimed deviations", PARAGRAPHS, rows, [Table("Share of errors, %", head, lines)])


def _cases() -> list[tuple[str, Array, Array, int]]:
    """Name, outputs (n, 8), truth (n,) in rad with NaN where it cannot be believed, and slips seen."""
    return [*_hinges(), *_worn(), *_synthetic()]


def _hinges() -> list[tuple[str, Array, Array, int]]:
    cases = []
    for trial in ("02", "05"):
        recording = weygers(trial)
        outputs, estimator = run_knee(recording, HINGE)
        assert recording.axes is not None
        outputs[:, FLEXION] = np.sign(np.sum(estimator.axes * recording.axes)) * outputs[:, FROM_SENSORS]
        cases.append((recording.name, outputs, _believed(recording), estimator.slips))
    return cases


def _worn() -> list[tuple[str, Array, Array, int]]:
    cases = []
    for spec, side in ((FAN, Side.LEFT), (ALBORNO, Side.LEFT), *((NEURA["neura"], side) for side in Side)):
        recording = from_manifest(spec, side)
        outputs, estimator = run_knee(recording, PARAMETERS)
        cases.append((f"{spec} {side}", outputs, _believed(recording), estimator.slips))
    return cases


def _believed(recording: KneeRecording) -> Array:
    return np.where(recording.holds, recording.flexion, np.nan)


def _synthetic() -> list[tuple[str, Array, Array, int]]:
    """Walks and sit-to-stands of six legs each: any mounting, biases up to 0.5 deg/s."""
    motions: dict[str, Motion] = {"walking": walking(), "sit to stand": sit_to_stand()}
    return [_legs(name, motion, amount) for name, motion in motions.items() for amount in SOFT_TISSUE]


def _legs(name: str, motion: Motion, soft_tissue: float) -> tuple[str, Array, Array, int]:
    parameters = replace(KneeAxisParameters(), sample_delay_s=0.0)
    outputs, truth, slips = [], [], 0
    for seed in SEEDS:
        draw = np.random.default_rng(seed)
        mounted = Rotation.random(2, rng=seed).as_matrix()
        worn = Sensors(mounted, np.radians(draw.uniform(-0.5, 0.5, (2, 3))), 0.003, 0.1, soft_tissue)
        leg = record(motion, DURATION_S, RATE_HZ, worn, seed=seed)
        everywhere = np.ones(len(leg.flexion), dtype=np.bool_)
        recording = KneeRecording(name, RATE_HZ, leg.rate, leg.force, leg.flexion, everywhere, None)
        out, estimator = run_knee(recording, parameters)
        outputs.append(out)
        truth.append(leg.flexion)
        slips += estimator.slips
    return f"{name}, {np.degrees(soft_tissue):.0f} deg of soft tissue", np.vstack(outputs), np.concatenate(truth), slips
