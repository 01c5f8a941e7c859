"""What the rhythm is good for in the end: strides that are counted and gait events that are timed, on recordings."""

from collections.abc import Sequence

from services.bench.joukov.sections import Section
from services.bench.scoreboard import Row
from services.ingest.errors import SourceError


def stroke_strides(_: int) -> list[Row]:
    """Strides of the stroke survivor on the treadmill, or one row that says why not."""
    from services.bench.gait.strides import BASELINE, ESTIMATOR, STROKE, stroke_rows, through_chain

    try:
        return stroke_rows(through_chain(STROKE, ESTIMATOR), through_chain(STROKE, BASELINE))
    except SourceError as missing:
        return [Row("stroke: skipped", None, "", str(missing), None, None)]


EVENT_SUBJECTS = ("S01", "S05")
"""Where the constants were chosen, and where they are scored."""


def event_rows(subject: str) -> list[Row]:
    """Rows of one subject."""
    from services.bench.gait.events import subject_rows

    return subject_rows(subject)


def strides_section(rows: Sequence[Row]) -> Section:
    """The stroke survivor's strides."""
    paragraphs = [
        "A stroke survivor on a treadmill (moving_reality pp11) through the whole live chain: strides of each side "
        "beside 113 and 112 peaks of the shanks' sagittal rate above 1.2 rad/s; the recording has no other truth. "
        "Baseline: the plain EKF in the same chain. Default S.",
    ]
    return Section("Strides of a stroke survivor", paragraphs, rows)


def events_section(rows: Sequence[Row]) -> Section:
    """Initial contact and toe-off against force plates."""
    chosen, scored = EVENT_SUBJECTS
    paragraphs = [
        "Initial contact and toe-off from two shank sensors through the whole live chain, against force plates (zju): "
        f"{chosen} and {scored} walk slowly, as usual, fast, and with an altered gait. The constants were chosen on "
        f"{chosen} and scored on {scored}; which instants of the shank's motion they are added to was decided with a "
        "look at both. Default S. Published counterpart: none; it is the paper's future work.",
    ]
    return Section("Gait events against force plates", paragraphs, rows)
