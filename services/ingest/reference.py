"""Truth that came with a recording: angles, contacts, points and orientations, in SI and ISB axes."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from schemas.health import Reason
from services.flow.rejections import RejectionCounter
from services.ingest.axes import rotation_from_axes
from services.ingest.entries import LEANS, InclinationEntry, OrientationEntry, PointEntry, ReferenceEntry
from services.ingest.errors import EmptyFile, place
from services.ingest.manifest import Manifest
from services.ingest.sensor_file import csv_format, expanded
from services.ingest.table import Table, read_table
from services.ingest.timing import advancing_rows, row_times_s
from services.ingest.tracks import ReferenceTrack
from services.ingest.units import reference_unit, scale_to_si

Values = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ReferenceTable:
    """One file of truth: time_s n on the file's time base, values n x channels, NaN where unknown."""

    time_s: Values
    values: Values


def channels_of(entry: ReferenceEntry) -> list[tuple[str, str]]:
    """Name and SI unit of each channel of a file, in the order of its values."""
    channels = [(channel.name, reference_unit(channel.unit)[1]) for channel in entry.channel]
    channels += [(f"{point.name}_{axis}", "m") for point in entry.point for axis in "xyz"]
    channels += [(f"{turn.name}_{axis}", "1") for turn in entry.orientation for axis in "wxyz"]
    return channels + [(f"{lean.name}_{direction}", "rad") for lean in entry.inclination for direction in LEANS]


def read_reference(
    folder: Path, manifest: Manifest, entry: ReferenceEntry, rejected: RejectionCounter
) -> ReferenceTable:
    """Read and convert one file of truth. Raises a SourceError that names file, line and column."""
    time = entry.time or manifest.time
    wanted = [channel.column for channel in entry.channel]
    for point in entry.point:
        wanted += expanded(point.columns, "xyz")
    for turn in entry.orientation:
        wanted += turn.columns
    for lean in entry.inclination:
        wanted += expanded(lean.lower, "xyz") + expanded(lean.upper, "xyz")
    table = read_table(
        folder / entry.file,
        wanted + ([time.column] if time.column else []),
        csv_format(entry.format or manifest.format),
    )
    rejected.add(entry.file, Reason.MALFORMED_ROW, table.malformed)
    time_s = row_times_s(table, time, entry.rate_hz or manifest.rate_hz)
    advancing = advancing_rows(table, time_s)
    rejected.add(entry.file, Reason.CLOCK_BACKWARDS, int(np.isfinite(time_s).sum() - advancing.sum()))
    if not advancing.any():
        raise EmptyFile(f"{place(table.path)}: no row with a time")
    return ReferenceTable(time_s[advancing], _converted(entry, table)[advancing])


def reference_track(tables: list[ReferenceTable], zero_s: float) -> ReferenceTrack:
    """All files of truth side by side on session time; a file that has no row for an instant is unknown there."""
    captured = [np.round((table.time_s - zero_s) * 1e9).astype(np.int64) for table in tables]
    every_ns = np.unique(np.concatenate(captured))
    blocks = []
    for captured_ns, table in zip(captured, tables, strict=True):
        block = np.full((len(every_ns), table.values.shape[1]), np.nan)
        block[np.searchsorted(every_ns, captured_ns)] = table.values
        blocks.append(block)
    return ReferenceTrack(every_ns, np.hstack(blocks))


def _converted(entry: ReferenceEntry, table: Table) -> Values:
    blocks: list[Values] = [np.empty((len(table.rows), 0))]
    at = 0
    for channel in entry.channel:
        blocks.append(channel.sign * reference_unit(channel.unit)[0] * table.values[:, at : at + 1])
        at += 1
    for point in entry.point:
        blocks.append(_position_in_world(point, table.values[:, at : at + 3]))
        at += 3
    for turn in entry.orientation:
        blocks.append(_quat_world_from_segment(turn, table.values[:, at : at + 4]))
        at += 4
    for lean in entry.inclination:
        blocks.append(_inclination(lean, table.values[:, at : at + 3], table.values[:, at + 3 : at + 6]))
        at += 6
    return np.hstack(blocks)


def _position_in_world(point: PointEntry, position_in_lab: Values) -> Values:
    R_world_from_lab = rotation_from_axes(point.axes, point.name)
    return position_in_lab @ R_world_from_lab.T * scale_to_si("length", point.unit)


def _inclination(lean: InclinationEntry, lower_in_lab: Values, upper_in_lab: Values) -> Values:
    """n x 2, rad: angle of the line from its lower to its upper end to the vertical, forward and to the right."""
    line = (upper_in_lab - lower_in_lab) @ rotation_from_axes(lean.axes, lean.name).T
    return np.arctan2(line[:, [0, 2]], line[:, [1]])


def _quat_world_from_segment(turn: OrientationEntry, quat_lab_from_vendor: Values) -> Values:
    """R_world_from_segment = R_world_from_lab R_lab_from_vendor R_segment_from_vendor'; n x 4, wxyz, NaN kept."""
    R_world_from_lab = rotation_from_axes(turn.world_axes, turn.name)
    R_segment_from_vendor = rotation_from_axes(turn.segment_axes, turn.name)
    norm = np.linalg.norm(quat_lab_from_vendor, axis=1)
    known = np.isfinite(norm) & (norm > 0.5)
    quat = np.full_like(quat_lab_from_vendor, np.nan)
    if known.any():
        turned = Rotation.from_quat(quat_lab_from_vendor[known], scalar_first=True)
        in_world = Rotation.from_matrix(R_world_from_lab) * turned * Rotation.from_matrix(R_segment_from_vendor.T)
        quat[known] = in_world.as_quat(canonical=True, scalar_first=True)
    return quat
