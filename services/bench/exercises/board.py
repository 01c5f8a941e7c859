"""Scoreboard of tasks of the whole body and of gait from a camera."""

from pathlib import Path

from services.bench.exercises.gait_section import gait_rows
from services.bench.exercises.task_section import MOTIONS, task_rows
from services.bench.scoreboard import Row, Scoreboard

PARTS = (*MOTIONS, "gait")
PEOPLE = 5

NOTE = (
    "Simulated people before a simulated Kinect v2 with a clinic's noise, through estimation and segmentation; nothing "
    "was chosen on them. Missed and invented ones per hundred that were truly made in full (baseline: their number). "
    "Partial ones are counted while the person's own range is not yet known. The simulated walker is on a treadmill; "
    "as given, its joint centres have errors of 12 mm that pass and 30 mm that stay, on either ground."
)


def run(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """All parts, or some of PARTS; a number is how many people or walks. Raises ValueError for another word."""
    people = next((int(word) for word in subject if word.isdecimal()), PEOPLE)
    asked = [word for word in subject if not word.isdecimal()] or list(PARTS)
    unknown = [word for word in asked if word not in PARTS]
    if unknown:
        raise ValueError(f"exercises takes a number of people and parts of {', '.join(PARTS)}, not {unknown[0]!r}")
    rows: list[Row] = task_rows(people, [motion for motion in MOTIONS if motion in asked])
    if "gait" in asked:
        rows += gait_rows(people)
    board = Scoreboard("exercises", rows, NOTE)
    if json_path is not None:
        board.write_json(json_path)
    return board
