"""Which numbers belong to the report of a test: the strides of a timed up and go, say, are no gait analysis."""

from schemas.metrics import Metric
from schemas.vocabulary import Task
from services.definitions.table import BY_NAME
from services.report.source import ReportSource

EXERCISES = (
    Task.KNEE_FLEXION, Task.SQUAT, Task.STEPPING, Task.TRUNK_TILT_SAGITTAL, Task.TRUNK_TILT_FRONTAL,
)  # fmt: skip
WALKING_TESTS = (Task.SIX_MINUTE_WALK, Task.TEN_METRE_WALK)
ONLY: dict[Task, str] = {
    Task.TIMED_UP_AND_GO: "tug_",
    Task.MARCHING: "marching_",
    **dict.fromkeys(EXERCISES, "repetition"),
}
"""What the names of a task's numbers begin with, where no others belong to its report."""


def in_scope(source: ReportSource) -> list[Metric]:
    """Numbers that the report is about; none that is for files only."""
    start = ONLY.get(source.description.task, "")
    return [each for each in source.metrics.metrics if each.name.startswith(start) and not _for_files(each.name)]


def _for_files(name: str) -> bool:
    return name in BY_NAME and BY_NAME[name].export_only
