"""Events of feet and of the lower back against foot movements reviewed by hand (Voisard et al.).

Three healthy adults, two walks each: 10 m, turn, 10 m. The constants of both detectors were chosen with the first
adult among others (`services/segmentation/parameters.py`); the other two are scored.
"""

import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from schemas.vocabulary import GaitEventKind, Segment, Side
from services.bench.gait.detections import Detection, Times, detection, detection_rows
from services.bench.gait.strides import ESTIMATOR, through_chain
from services.bench.scoreboard import Row
from services.ingest.data import MANIFESTS, find_data
from services.ingest.errors import SourceError

DATA = "voisard_feet_lumbar_events"
TEMPLATE, TEMPLATE_TRIAL = MANIFESTS / "voisard_1_1.toml", "1-1"
TUNED, SCORED = ("1-1", "1-2"), ("2-1", "2-2", "3-1", "3-2")
RATE_HZ = 100.0
FEET, BACK = frozenset({Segment.FOOT_LEFT, Segment.FOOT_RIGHT}), frozenset({Segment.PELVIS})
IC, TO = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF


def voisard_rows() -> list[Row]:
    """Contacts and toe-offs by the lower back and by the feet; one row that says why without the data."""
    rows: list[Row] = []
    try:
        for people, trials in (("adults 2 and 3", SCORED), ("adult 1, tuned on", TUNED)):
            for sensor, worn in (("back", BACK), ("feet", FEET)):
                walks = [detections(trial, worn) for trial in trials]
                for kind in GaitEventKind:
                    name = f"voisard {people}, {sensor}, {kind.value.replace('_', ' ')}"
                    found = detection_rows(name, [walk[kind] for walk in walks])
                    rows += [replace(row, detail=trials is TUNED) for row in found]
    except SourceError as missing:
        return [Row("voisard: skipped", None, "", str(missing), None, None)]
    return rows


def detections(trial: str, worn: frozenset[Segment]) -> dict[GaitEventKind, Detection]:
    """One walk through the chain, with sensors on these segments alone."""
    true = reviewed_s(trial)
    with TemporaryDirectory() as folder:
        manifest = Path(folder) / "recording.toml"
        manifest.write_text(manifest_of(trial), encoding="utf-8")
        found = through_chain(str(manifest), ESTIMATOR, worn).found
    return {kind: detection(true, found, kind) for kind in GaitEventKind}


def manifest_of(trial: str) -> str:
    """The manifest of one walk: that of another walk with the trial replaced. The height is not used."""
    return TEMPLATE.read_text(encoding="utf-8").replace(TEMPLATE_TRIAL, trial)


def reviewed_s(trial: str) -> Times:
    """Times of the reviewed events, s: a movement of a foot lasts from toe-off to contact."""
    reviewed = json.loads((find_data(DATA) / f"{trial}.json").read_text(encoding="utf-8"))
    times: dict[tuple[Side, GaitEventKind], np.ndarray[tuple[int], np.dtype[np.float64]]] = {}
    for side in Side:
        moves = np.array(reviewed[f"{side.value.capitalize()}FootEvents"], dtype=np.float64).reshape(-1, 2) / RATE_HZ
        times[side, TO], times[side, IC] = moves[:, 0], moves[:, 1]
    return times
