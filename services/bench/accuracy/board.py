"""Accuracy by recording."""

from pathlib import Path

from services.bench.accuracy import drift, knee, steps, walk
from services.bench.scoreboard import Scoreboard


def run(json_path: Path | None = None, subject: str = "neura") -> Scoreboard:
    """Score the estimates on one recording. Raises ValueError for a subject that is not known."""
    if subject in walk.RECORDINGS:
        return walk.run(subject, json_path)
    if subject in knee.KNEES:
        return knee.run(subject, json_path)
    if subject == steps.SUBJECT:
        return steps.run(json_path)
    if subject == drift.SUBJECT:
        return drift.run(json_path)
    known = ", ".join([*walk.RECORDINGS, *knee.KNEES, steps.SUBJECT, drift.SUBJECT])
    raise ValueError(f"accuracy is measured on {known}, not on {subject!r}")
