"""A recorded walk of 10 m, a turn, and 10 m back, taken for a walk for time: where its turn is."""

import json
from pathlib import Path
from tempfile import TemporaryDirectory

from schemas.conditions import UNSAID
from schemas.vocabulary import Task, TaskPhaseKind
from services.bench.gait.voisard import DATA, RATE_HZ, SCORED, TUNED, manifest_of
from services.bench.scoreboard import Row, at_most, informative
from services.bench.walking_tests.sessions import Outcome, measured
from services.ingest.data import find_data
from services.ingest.errors import SourceError

WALKWAY_M = 10.0
LONGEST_S = 120.0
TRIALS = (*TUNED, *SCORED)
"""Nothing of walking tests was chosen on any of them."""


def recording_rows() -> list[Row]:
    """Turns found against those that were annotated; one row that says why without the data."""
    missed = invented = 0
    starts_s: list[float] = []
    ends_s: list[float] = []
    try:
        for trial in TRIALS:
            begun_s, over_s = annotated_turn_s(trial)
            found = _measured(trial)
            turns = found.phases(TaskPhaseKind.TURN)
            here = [turn for turn in turns if abs(turn.start_ns * 1e-9 - begun_s) < WALKWAY_M / 2]
            missed += not here
            invented += len(turns) - len(here[:1])
            if here:
                starts_s.append(here[0].start_ns * 1e-9 - begun_s)
                ends_s.append((here[0].end_ns or 0) * 1e-9 - over_s)
    except SourceError as missing:
        return [Row("voisard: skipped", None, "", str(missing), None, None)]
    return [
        at_most(f"recorded, 10 m and back: turns missed of {len(TRIALS)}", missed, "1", 0),
        at_most("recorded, 10 m and back: turns invented", invented, "1", 0),
        informative("recorded: turn begins, mean against the annotation", sum(starts_s) / max(1, len(starts_s)), "s"),
        informative("recorded: turn ends, mean against the annotation", sum(ends_s) / max(1, len(ends_s)), "s"),
        informative("recorded: turn begins, largest", max(map(abs, starts_s), default=None), "s"),
        informative("recorded: turn ends, largest", max(map(abs, ends_s), default=None), "s"),
    ]


def annotated_turn_s(trial: str) -> tuple[float, float]:
    """Begin and end of the turn, s."""
    told = json.loads((find_data(DATA) / f"{trial}.json").read_text(encoding="utf-8"))
    first, last = told["UTurnBoundaries"]
    return first / RATE_HZ, last / RATE_HZ


def _measured(trial: str) -> Outcome:
    conditions = UNSAID.model_copy(update={"test_duration_s": LONGEST_S})
    asked = {"task": Task.SIX_MINUTE_WALK, "walkway_m": WALKWAY_M, "conditions": conditions}
    with TemporaryDirectory() as folder:
        manifest = Path(folder) / "recording.toml"
        manifest.write_text(manifest_of(trial), encoding="utf-8")
        return measured(str(manifest), asked)
