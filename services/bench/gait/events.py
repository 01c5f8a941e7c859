"""Scoreboard of initial contact and toe-off, through the whole chain: two shank sensors against force plates, feet
and the lower back against what others saw.

The constants of segmentation were chosen on the first subject. Which instants of the shank's motion they are added to
was decided with a look at both.
"""

from collections.abc import Callable, Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import GaitEventKind
from services.bench.gait.force_plates import PlateWalk, manifest_of, plate_walks
from services.bench.gait.lower_back_walks import lower_back_rows
from services.bench.gait.shoe_walk import shoe_rows
from services.bench.gait.stride_scores import Matched, match, together
from services.bench.gait.strides import ESTIMATOR, through_chain
from services.bench.gait.stroke_sensors import stroke_sensor_rows
from services.bench.gait.voisard import voisard_rows
from services.bench.scoreboard import Row, Scoreboard, at_least, at_most, informative
from services.ingest.data import MANIFESTS
from services.ingest.errors import SourceError

Array = NDArray[np.float64]

TEMPLATE = MANIFESTS / "zju_s01_norm_02.toml"
TUNED, SCORED = "S01", "S05"
CONDITIONS = {"Slow": "slow", "Norm": "usual", "Fast": "fast", "Lmin": "altered"}
BIAS_MS, SPREAD_MS, DETECTED = 15.0, 25.0, 0.98
DETECTED_S = 0.1
"""s from its plate event within which an event counts as detected."""


class Judged(NamedTuple):
    """The found events of one kind beside one walk's plate events."""

    condition: str
    kind: GaitEventKind
    matched: Matched
    claimed_std_s: list[float]


SUBJECTS: dict[str, Callable[[], list[Row]]] = {
    TUNED: lambda: subject_rows(TUNED),
    SCORED: lambda: subject_rows(SCORED),
    "voisard": voisard_rows,
    "gaitmap": shoe_rows,
    "mobgap": lower_back_rows,
    "stroke": stroke_sensor_rows,
}
NOTE = f"""shanks: the constants were chosen on {TUNED}, the instants that they are added to on both
feet and back: chosen on voisard's adult 1, the stroke survivor and, for the back, the neura walk; all others held out
baseline: mobgap's McCamley and Ullrich, which are told where the walking is; blank where mobgap is not installed"""


def run(json_path: Path | None = None, subject: str = "all") -> Scoreboard:
    """Score the events of the subjects S01 and S05 (`zju` for both), of `voisard`, `gaitmap`, `mobgap`,
    of the `stroke` survivor, or of all."""
    chosen = {"all": list(SUBJECTS), "zju": [TUNED, SCORED]}.get(subject, [subject])
    if not set(chosen) <= set(SUBJECTS):
        raise ValueError(f"no events of {subject!r}: choose zju, {', '.join(SUBJECTS)} or all")
    rows = [row for name in chosen for row in SUBJECTS[name]()]
    scoreboard = Scoreboard("gait events of shanks, feet and lower back against what others saw", rows, NOTE)
    if json_path is not None:
        scoreboard.write_json(json_path)
    return scoreboard


def subject_rows(subject: str) -> list[Row]:
    """All figures of a subject; one row that says why when the data is not here."""
    try:
        judged = [entry for walk in plate_walks(subject) for entry in judge(walk)]
    except SourceError as missing:
        return [Row(f"{subject}: skipped", None, "", str(missing), None, None)]
    rows = []
    for kind in GaitEventKind:
        entries = [entry for entry in judged if entry.kind is kind]
        rows += event_rows(f"{subject} {kind.value.replace('_', ' ')}", entries)
    return rows


def judge(walk: PlateWalk) -> Iterable[Judged]:
    """Run one walk through the chain and compare each plate event with the nearest event of that foot and kind."""
    with TemporaryDirectory() as folder:
        manifest = Path(folder) / "recording.toml"
        manifest.write_text(manifest_of(TEMPLATE, walk), encoding="utf-8")
        found = through_chain(str(manifest), ESTIMATOR).found
    for (side, kind), true_s in walk.contact_s.items():
        claimed = [event.time_std_s for event in found.events if (event.side, event.kind) == (side, kind)]
        yield Judged(walk.condition, kind, match(np.array([true_s]), found.times_s(side, kind)), claimed)


def event_rows(name: str, judged: list[Judged]) -> list[Row]:
    """Bias, spread and detected share over all walks with their targets; then the same per condition."""
    whole = together(entry.matched for entry in judged)
    if whole.bias_ms is None or whole.spread_ms is None:
        return [Row(f"{name}: nothing found", None, "", f"{whole.missed} missed", False, None)]
    claimed_ms = 1e3 * float(np.mean([std for entry in judged for std in entry.claimed_std_s]))
    rows = [
        at_least(f"{name}: detected of {_asked(whole)}", detected_share(whole), "1", DETECTED),
        Row(f"{name}: bias", whole.bias_ms, "ms", f"0 +- {BIAS_MS:g}", abs(whole.bias_ms) <= BIAS_MS, None),
        at_most(f"{name}: SD", whole.spread_ms, "ms", SPREAD_MS),
        informative(f"{name}: SD that the events claim", round(claimed_ms, 1), "ms"),
    ]
    for condition, words in CONDITIONS.items():
        part = together(entry.matched for entry in judged if entry.condition == condition)
        rows.append(informative(f"{name}, {words}: bias of {_asked(part)}", part.bias_ms, "ms"))
        rows.append(informative(f"{name}, {words}: SD", part.spread_ms, "ms"))
    return rows


def detected_share(matched: Matched) -> float:
    """Share of the true events that have a found one within DETECTED_S."""
    return float(np.sum(np.abs(matched.errors_s) <= DETECTED_S)) / max(1, _asked(matched))


def _asked(matched: Matched) -> int:
    return len(matched.errors_s) + matched.missed
