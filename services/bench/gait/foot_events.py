"""Scores the swing detector on sensors that the chain does not model: both feet, against reviewed foot movements.

The detector is the one for a shank alone, fed with the raw rate of the foot about its principal axis; its constants,
which were chosen for shanks, are left as they are.
"""

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import GaitEventKind, Side
from services.bench.gait.stride_scores import Matched, match, together
from services.bench.scoreboard import Row, informative
from services.ingest.data import find_data
from services.ingest.errors import SourceError
from services.ingest.table import CsvFormat, read_table
from services.segmentation.lone_swing import ShankSwingDetector
from services.segmentation.parameters import SegmentationParameters

Array = NDArray[np.float64]

DATA = "voisard_feet_lumbar_events"
RATE_HZ = 100.0
LAYOUT = CsvFormat(delimiter="\t", skip_lines=1)
FEET = {Side.LEFT: ("lf", "LeftFootEvents"), Side.RIGHT: ("rf", "RightFootEvents")}


def foot_rows() -> list[Row]:
    """Share found, share true, bias and deviation of both kinds; one row that says why without the recordings."""
    try:
        trials = sorted(find_data(DATA).glob("*.json"))
        matched = [matched for trial in trials for matched in _trial(trial)]
    except SourceError as missing:
        return [Row("feet (Voisard): skipped", None, "", str(missing), None, None)]
    rows = []
    for kind in GaitEventKind:
        whole = together(part for found, part in matched if found is kind)
        name, pairs = f"feet (Voisard) {kind.value.replace('_', ' ')}", len(whole.errors_s)
        rows += [
            informative(f"{name}: sensitivity of {pairs + whole.missed}", pairs / max(1, pairs + whole.missed), "1"),
            informative(f"{name}: positive predictive value", pairs / max(1, pairs + whole.extra), "1"),
            informative(f"{name}: bias", whole.bias_ms, "ms"),
            informative(f"{name}: SD", whole.spread_ms, "ms"),
        ]
    return rows


def forward_rate(rate: Array) -> Array:
    """Rate (n,) rad/s about the principal axis of (n, 3), positive while a foot swings forward.

    The foot turns back fast and briefly as the heel lifts and before the toes come down, forward longer and slower:
    so the cubes of the forward rate have a negative mean.
    """
    axis = np.linalg.eigh(rate.T @ rate)[1][:, -1]
    about: Array = rate @ axis
    return -about if np.mean(about**3) > 0 else about


def swing_events(rate: Array) -> dict[GaitEventKind, Array]:
    """Times (k,) s of both kinds of events in a forward rate (n,) rad/s that starts at time zero."""
    detector = ShankSwingDetector(SegmentationParameters())
    steps = (detector.step(round(i * 1e9 / RATE_HZ), value, 0.0, False) for i, value in enumerate(rate.tolist()))
    found = [event for event in steps if event is not None]
    return {kind: np.array([e.captured_ns * 1e-9 for e in found if e.kind is kind]) for kind in GaitEventKind}


def _trial(path: Path) -> list[tuple[GaitEventKind, Matched]]:
    reviewed = json.loads(path.read_text(encoding="utf-8"))
    matched = []
    for suffix, name in FEET.values():
        table = read_table(path.with_name(f"{path.stem}_{suffix}.txt"), ("Gyr_X", "Gyr_Y", "Gyr_Z"), LAYOUT)
        found = swing_events(forward_rate(table.values))
        lifted_s, landed_s = np.array(reviewed[name], dtype=np.float64).reshape(-1, 2).T / RATE_HZ
        matched.append((GaitEventKind.TOE_OFF, match(lifted_s, found[GaitEventKind.TOE_OFF])))
        matched.append((GaitEventKind.INITIAL_CONTACT, match(landed_s, found[GaitEventKind.INITIAL_CONTACT])))
    return matched
