"""Scoreboard of repetitions: counts, ranges and boundaries of exercises; recorded knees; steps that are none."""

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from rich.progress import track

from services.bench.joukov.segmentation import segmentation
from services.bench.repetitions.exercises import EXERCISES, SCORED_SEEDS, Truth, exercise, truths
from services.bench.repetitions.recordings import measured_rows, walking_rows
from services.bench.repetitions.runs import Run, of_exact_angles, through_chain
from services.bench.repetitions.scores import Tally, mean_absolute, true_phase
from services.bench.scoreboard import Row, Scoreboard, at_most, informative

SETUPS = {
    "one leg": ("worn=2&standing=0", tuple(EXERCISES)),
    "one leg, standing first": (
        "worn=2&standing=5",
        ("seated extension", "seated extension, hard", "heel slides", "squats"),
    ),
    "five sensors": (
        "worn=0&standing=5",
        ("seated extension, hard", "squats, hard", "cycling, fast", "sit to stand"),
    ),
}
"""What is worn, and which exercises it is tried on."""
RHYTHMIC = ("squats", "cycling, slow", "cycling, fast", "sit to stand")
PARTS = ("exact", "synthetic", "recorded", "walks")
SEEDS = 1
EXACT_SEEDS = 5

NOTE = (
    "Synthetic exercises on seeds that nothing was chosen on. What tells a step was set with the NeuRA walk and a slow "
    "synthetic one in view, nothing with the measured knees. Wrong: missed and extra ones per hundred true ones. "
    "Cut right: start and end within 10 % of the repetition. Baselines: of wrong ones the number truly made, of "
    "'cut right' the rhythm's phase (Joukov), of one angle alone the number in the optical angle, of steps the "
    "strides. Partial ones are counted while the person's own range is not yet known."
)


def run(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """All parts, or some of PARTS; a number is how many seeds pass the whole chain."""
    seeds = next((int(word) for word in subject if word.isdecimal()), SEEDS)
    asked = [word for word in subject if not word.isdecimal()] or list(PARTS)
    unknown = [word for word in asked if word not in PARTS]
    if unknown:
        raise ValueError(f"repetitions takes a number of seeds and parts of {', '.join(PARTS)}, not {unknown[0]!r}")
    rows: list[Row] = []
    if "exact" in asked:
        rows += _exact()
    if "synthetic" in asked:
        for setup, (options, names) in SETUPS.items():
            rows += _estimated(setup, options, names, seeds)
    if "recorded" in asked:
        rows += measured_rows()
    if "walks" in asked:
        rows += walking_rows()
    board = Scoreboard("repetitions", rows, NOTE)
    if json_path is not None:
        board.write_json(json_path)
    return board


def _exact() -> list[Row]:
    """The segmenter alone, on the true angles."""
    rows: list[Row] = []
    all_of_them = Tally()
    for name, options in track(EXERCISES.items(), "exact angles", total=len(EXERCISES)):
        tally = Tally()
        for seed in SCORED_SEEDS[:EXACT_SEEDS]:
            session = exercise(f"{options}&seed={seed}")
            found, true = of_exact_angles(session), truths(session)
            tally.add(found, true)
            all_of_them.add(found, true)
        rows += _figures(f"exact angles, {name}", tally, detail=True)
    return [*_figures("exact angles", all_of_them), *rows]


def _estimated(setup: str, worn: str, names: Sequence[str], seeds: int) -> list[Row]:
    """The whole chain."""
    rows: list[Row] = []
    all_of_them, by_phase = Tally(), list[float]()
    for name in track(names, setup):
        tally, phase = Tally(), list[float]()
        options = EXERCISES[name]
        for seed in SCORED_SEEDS[:seeds]:
            session = exercise(f"{options}&{worn}&seed={seed}")
            try:
                through = through_chain(f"synthetic:knee?{options}&{worn}&seed={seed}")
            except ValueError as error:
                return [Row(f"{setup}: {error}"[:120], None, "", None, None, None)]
            true = truths(session)
            for each in (tally, all_of_them):
                each.add(through.of(session.side), true)
            if name in RHYTHMIC:
                phase += _cut_by_phase(through, session.parameters.standing, true)
        by_phase += phase
        rows += _figures(f"{setup}, {name}", tally, phase, detail=True)
    return [*_figures(setup, all_of_them, by_phase), *rows]


def _cut_by_phase(through: Run, standing_s: float, true: Sequence[Truth]) -> list[float]:
    """For each repetition whether the rhythm's phase cuts it right."""
    time_s, phase, locked = through.phase()
    moving = time_s > standing_s
    if not np.any(moving):
        return [0.0] * (len(true) - 1)
    time_s, phase, locked = time_s[moving], phase[moving], locked[moving]
    cut: list[float] = segmentation(time_s, phase, locked, true_phase(time_s, true)).tolist()
    return cut


def _figures(name: str, tally: Tally, by_phase: Sequence[float] = (), *, detail: bool = False) -> list[Row]:
    wrong, right = tally.wrong_percent, tally.right_percent
    degrees = math.degrees(mean_absolute(tally.range_errors))
    rows = [at_most(f"{name}: wrong", wrong, "%", 1.0, tally.true)]
    if not tally.range_errors:
        return [replace(row, detail=detail) for row in rows]
    rows += [
        at_most(f"{name}: range, mean absolute error", degrees, "deg", 3.0),
        at_most(f"{name}: start, mean absolute error", mean_absolute(tally.start_errors), "s", 0.1),
        at_most(f"{name}: turn, mean absolute error", mean_absolute(tally.turn_errors), "s", 0.1),
        at_most(f"{name}: end, mean absolute error", mean_absolute(tally.end_errors), "s", 0.1),
        informative(f"{name}: cut right", right, "%", 100.0 * float(np.mean(by_phase)) if by_phase else None),
    ]
    if tally.partial:
        share = 100.0 * tally.partial_counted / tally.partial
        rows.append(informative(f"{name}: partial ones counted", share, "%", tally.partial))
    return [replace(row, detail=detail) for row in rows]
