"""Tables by name: of which messages, with which columns, and what is said above them."""

import math
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from schemas.gait import GaitEvent, Stride
from schemas.kinematics import JointState
from schemas.metrics import Doubt, MeanCurve, Metric, SessionMetrics, SideComparison
from schemas.payload import Payload
from schemas.signals import GAIT_EVENT, JOINT_STATE, METRICS, REPETITION, STRIDE, TASK_PHASE, Signal
from schemas.tasks import Repetition, TaskPhase
from schemas.vocabulary import BODY_MODELS, MOVEMENTS, Side
from services.definitions.table import BY_NAME
from services.exports.facts import directions, freedoms_of
from services.exports.tables.columns import Cell, Column, Row, angles, degrees, field, plain, seconds, times

FREEDOMS = {freedom.name: freedom for model in BODY_MODELS.values() for freedom in model}


class Table(NamedTuple):
    """One file. Its entries come from messages of `signal`; of `newest_only` signals from the last one alone."""

    signal: Signal
    columns: Callable[[Payload | None], tuple[Column, ...]]
    """For the first message; None when there was none."""
    entries: Callable[[Any], Iterable[Any]]
    about: Callable[[Payload | None], list[str]]
    newest_only: bool = False


STRIDE_COLUMNS = (
    *plain(Stride, "side", "index"),
    *times(Stride, "start", "toe_off", "opposite_contact", "opposite_toe_off", "end"),
    *plain(
        Stride, "stride_time_s", "stance_fraction", "step_time_s", "step_length_m", "step_length_std_m",
        "stride_length_m", "walking_speed", "step_width_m", "circumduction_m", "turn", "phase_advance", "turning",
        "valid", "rejected_because",
    ),
)  # fmt: skip
EVENT_COLUMNS = (
    Column("time_s", "s since the session started", seconds("captured")),
    Column("side", "", field("side")),
    Column("event", "initial_contact or toe_off", field("kind")),
    *plain(GaitEvent, "time_std_s"),
)
PHASE_COLUMNS = (
    *plain(TaskPhase, "task", "attempt", "phase"),
    *times(TaskPhase, "start"),
    *plain(TaskPhase, "start_std_s"),
    *times(TaskPhase, "end"),
    *plain(TaskPhase, "end_std_s", "largest_turn_rate", "largest_thigh_rate", "steps", "distance_m", "distance_std_m"),
)
REPETITION_COLUMNS = (
    *plain(Repetition, "degree_of_freedom", "side", "index"),
    *times(Repetition, "start", "turn", "end"),
    *angles(Repetition, "start_angle", "turn_angle", "end_angle", "angle_std"),
    *plain(Repetition, "largest_velocity", "hold_s", "valid", "rejected_because"),
    Column(
        "ranges",
        "rad, largest minus smallest of every valid angle, by name",
        lambda one: "; ".join(f"{name}={value:.5f}" for name, value in one.ranges.items()),
    ),
)


def _metric_angle(name: str) -> Callable[[Any], Cell]:
    return lambda metric: getattr(metric, name) if metric.unit == "rad" else None


METRIC_COLUMNS = (
    *plain(Metric, "name", "side", "unit", "value", "spread", "mean_std", "low", "high"),
    Column("strides", "number of strides or repetitions it rests on (n)", field("strides")),
    *plain(Metric, "grade"),
    Column("doubts", "what led to the grade, weightiest first", lambda one: "; ".join(map(_doubt, one.doubts))),
    Column("withheld_because", "why there is no value", field("withheld_because")),
    *(
        Column(f"{name}_deg", f"{name} in degrees; angles only", degrees(_metric_angle(name)))
        for name in ("value", "spread", "low", "high")
    ),
)
SIDE_COLUMNS = (
    *plain(SideComparison, "joint", "reference_side"),
    *angles(SideComparison, "rmse", "rmse_std", "rmse_about_mean"),
    *plain(SideComparison, "shift"),
    Column("strides", "number of strides of the side with fewer (n)", field("strides")),
)
CURVE_COLUMNS = (
    Column("degree_of_freedom", "", lambda point: point[0].degree_of_freedom),
    Column("percent", "% of the stride", lambda point: point[1]),
    Column("mean", "rad", lambda point: point[0].mean[point[1]]),
    Column("sd", "rad, over the strides", lambda point: point[0].spread[point[1]]),
    Column("mean_deg", "mean in degrees", lambda point: math.degrees(point[0].mean[point[1]])),
    Column("sd_deg", "sd in degrees", lambda point: math.degrees(point[0].spread[point[1]])),
    Column("strides", "number of strides (n)", lambda point: point[0].strides),
)


def _doubt(doubt: Doubt) -> str:
    parts = [str(doubt.kind), *(f"{name} {value}" for name, value in doubt if name != "kind" and value is not None)]
    return " ".join(parts)


def _angle_columns(first: Payload | None) -> tuple[Column, ...]:
    columns = [Column("time_s", "s since the session started", _cell(0))]
    for freedom in freedoms_of(first.model) if isinstance(first, JointState) else ():
        i = len(columns)
        columns.append(Column(f"{freedom.name}_deg", f"degrees, positive = {freedom.positive}", _cell(i)))
        columns.append(Column(f"{freedom.name}_std_deg", "degrees, one standard deviation", _cell(i + 1)))
    return tuple(columns)


def _cell(index: int) -> Callable[[Any], Cell]:
    return lambda row: row[index]


def _angle_entries(state: JointState) -> Iterable[Row]:
    """A row a sample; cells of degrees of freedom that are not valid stay empty."""
    for captured_ns, position, std in zip(state.captured_ns, state.position, state.position_std, strict=True):
        row: Row = [f"{captured_ns * 1e-9:.6f}"]
        for value, deviation, valid in zip(position, std, state.valid, strict=True):
            row += [f"{math.degrees(value):.4f}", f"{math.degrees(deviation):.4f}"] if valid else [None, None]
        yield row


def _about_metrics(newest: Payload | None) -> list[str]:
    names = dict.fromkeys(metric.name for metric in newest.metrics) if isinstance(newest, SessionMetrics) else {}
    told = [f"{name}: {BY_NAME[name].sentence}" for name in names if name in BY_NAME]
    return ["value and spread: mean and SD over the strides, as z-scores need them; low to high: 95 % interval", *told]


def _about_curves(newest: Payload | None) -> list[str]:
    names = [curve.degree_of_freedom for curve in newest.curves] if isinstance(newest, SessionMetrics) else []
    known = [FREEDOMS[name] for name in dict.fromkeys(names) if name in FREEDOMS]
    return ["mean and sd over the strides, 0 to 100 % of the stride; a band of them is +-1 SD", *directions(known)]


def _about_sides(newest: Payload | None) -> list[str]:
    joints = [each.joint for each in newest.sides] if isinstance(newest, SessionMetrics) else []
    known = [FREEDOMS[f"{joint}_{side}"] for joint in joints for side in Side if f"{joint}_{side}" in FREEDOMS]
    return [
        "mean curves of one leg against the other's, shifted by half a stride; reference_side: non-paretic, else right",
        *directions(known),
    ]


def _about_repetitions(_: Payload | None) -> list[str]:
    movements = [f"{name}: {meaning}" for name, meaning in MOVEMENTS.items()]
    return [*movements, *directions(freedom for freedom in FREEDOMS.values() if freedom.name not in MOVEMENTS)]


def _curve_points(metrics: SessionMetrics) -> Iterable[tuple[MeanCurve, int]]:
    return ((curve, percent) for curve in metrics.curves for percent in range(len(curve.mean)))


def _always(columns: tuple[Column, ...]) -> Callable[[Payload | None], tuple[Column, ...]]:
    return lambda _: columns


def _says(*lines: str) -> Callable[[Payload | None], list[str]]:
    return lambda _: list(lines)


def _itself(payload: Payload) -> Iterable[Payload]:
    return (payload,)


def _ended(phase: TaskPhase) -> Iterable[TaskPhase]:
    return () if phase.end_ns is None else (phase,)


TABLES: dict[str, Table] = {
    "metrics": Table(METRICS, _always(METRIC_COLUMNS), lambda newest: newest.metrics, _about_metrics, True),
    "curves": Table(METRICS, _always(CURVE_COLUMNS), _curve_points, _about_curves, True),
    "sides": Table(METRICS, _always(SIDE_COLUMNS), lambda newest: newest.sides, _about_sides, True),
    "strides": Table(STRIDE, _always(STRIDE_COLUMNS), _itself, _says("one row a stride of each foot, in order")),
    "events": Table(GAIT_EVENT, _always(EVENT_COLUMNS), _itself, _says("foot contacts, in order")),
    "joint_angles": Table(JOINT_STATE, _angle_columns, _angle_entries, _says("an empty cell: not valid then")),
    "phases": Table(TASK_PHASE, _always(PHASE_COLUMNS), _ended, _says("phases of timed tests that have ended")),
    "repetitions": Table(REPETITION, _always(REPETITION_COLUMNS), _itself, _about_repetitions),
}
"""By the name of the file without its ending."""
