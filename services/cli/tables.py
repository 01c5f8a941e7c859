"""Tables for people: the one place where files get degrees and seconds.

Each file starts with comment lines (#) that define its columns; an invalid or unknown value is an empty cell.
"""

import csv
import math
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import TextIO

from schemas.gait import GaitEvent, Stride
from schemas.kinematics import JointState
from schemas.payload import Payload
from schemas.vocabulary import BODY_MODELS

SECONDS = 1e-9
STRIDE_DEFINITION = (
    "A stride runs from one initial contact to the next of the same foot; steps are named by the leading leg."
)

Cell = str | float | int | bool | None


class Table:
    """A CSV file with a commented header, written row by row."""

    def __init__(self, path: Path, definitions: Iterable[str], columns: list[str]) -> None:
        self._file: TextIO = path.open("w", newline="", encoding="utf-8")
        self._file.writelines(f"# {line}\n" for line in definitions)
        self._rows = csv.writer(self._file)
        self._rows.writerow(columns)

    def __enter__(self) -> "Table":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def write(self, row: Iterable[Cell]) -> None:
        """One row; None becomes an empty cell."""
        self._rows.writerow(["" if cell is None else cell for cell in row])


def joint_angle_table(path: Path, model: str) -> Table:
    """joint_angles.csv: time, then angle and standard deviation of every degree of freedom."""
    freedoms = BODY_MODELS[model]
    definitions = ["Joint angles in degrees; zero is quiet standing, both segments vertical.", STRIDE_DEFINITION]
    definitions += [f"{freedom.name}: positive = {freedom.positive}" for freedom in freedoms]
    columns = ["time_s"]
    for freedom in freedoms:
        columns += [f"{freedom.name}_deg", f"{freedom.name}_std_deg"]
    return Table(path, definitions, columns)


def joint_angle_rows(state: JointState) -> Iterable[list[Cell]]:
    """One row a sample; cells of degrees of freedom that are not valid stay empty."""
    for captured_ns, position, std in zip(state.captured_ns, state.position, state.position_std, strict=True):
        row: list[Cell] = [f"{captured_ns * SECONDS:.6f}"]
        for value, deviation, valid in zip(position, std, state.valid, strict=True):
            row += [f"{math.degrees(value):.4f}", f"{math.degrees(deviation):.4f}"] if valid else [None, None]
        yield row


def event_table(path: Path) -> Table:
    """events.csv: initial contacts and toe-offs."""
    return Table(
        path, ["Foot contacts; time_std_s is one standard deviation."], ["time_s", "side", "event", "time_std_s"]
    )


def event_row(event: GaitEvent) -> list[Cell]:
    """One row of events.csv."""
    return [f"{event.captured_ns * SECONDS:.4f}", event.side, event.kind, f"{event.time_std_s:.4f}"]


STRIDE_TIMES = ("start", "toe_off", "opposite_contact", "end")
STRIDE_FIELDS = (
    "stride_time_s", "stance_fraction", "step_time_s", "step_length_m", "step_length_std_m",
    "stride_length_m", "walking_speed", "phase_advance", "turning", "valid", "rejected_because",
)  # fmt: skip


def stride_table(path: Path) -> Table:
    """strides.csv: one row a stride."""
    definitions = [STRIDE_DEFINITION]
    definitions += [f"{name}: {_description(Stride, name)}" for name in STRIDE_FIELDS if _description(Stride, name)]
    return Table(path, definitions, ["side", "index", *(f"{time}_s" for time in STRIDE_TIMES), *STRIDE_FIELDS])


def stride_row(stride: Stride) -> list[Cell]:
    """One row of strides.csv."""
    times = [getattr(stride, f"{time}_ns") for time in STRIDE_TIMES]
    in_seconds = [None if time is None else f"{time * SECONDS:.4f}" for time in times]
    values = [getattr(stride, name) for name in STRIDE_FIELDS]
    rounded = [f"{value:.5f}" if isinstance(value, float) else value for value in values]
    return [stride.side, stride.index, *in_seconds, *rounded]


def _description(model: type[Payload], field: str) -> str:
    return model.model_fields[field].description or ""
