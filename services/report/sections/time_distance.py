"""The time-distance table, in the order of the clinical conventions, section 10.3."""

from services.definitions.definition import CV_SUFFIX, PARETIC_RATIO_SUFFIX, RATIO_SUFFIX
from services.report.catalogue import Catalogue
from services.report.content import Section, SectionId
from services.report.sections.measure_table import measure_table
from services.report.sections.table_notes import table_notes
from services.report.source import ReportSource

ROWS = (
    "walking_speed", "cadence", "stride_length", "step_length", "stance_fraction", "double_support_fraction",
    f"step_time{PARETIC_RATIO_SUFFIX}", f"step_time{RATIO_SUFFIX}", f"stride_time{CV_SUFFIX}",
    f"stride_length{CV_SUFFIX}", "step_width",
)  # fmt: skip


def time_distance(source: ReportSource, words: Catalogue) -> Section | None:
    """None where the session knows none of its rows."""
    title = words.text("title.time_distance")
    table = measure_table(source, words, ROWS, title)
    if table is None:
        return None
    return Section(
        id=SectionId.TIME_DISTANCE, page=1, title=title, sentences=[], charts=[], table=table,
        notes=table_notes(source, words, ROWS),
    )  # fmt: skip
