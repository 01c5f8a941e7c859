"""The file of one depth camera: its joints on the axes of the room, without the rows that say nothing."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from schemas.health import Reason
from services.flow.rejections import RejectionCounter
from services.ingest.camera_checks import check_view
from services.ingest.camera_view import camera_view
from services.ingest.entries import CameraEntry
from services.ingest.errors import EmptyFile, place
from services.ingest.manifest import Manifest
from services.ingest.sensor_file import csv_format, expanded
from services.ingest.skeleton import CameraView, RoomFrames, frames_in_room
from services.ingest.table import read_table
from services.ingest.timing import advancing_rows, row_times_s
from services.ingest.tracks import SkeletonTrack


@dataclass(frozen=True, slots=True)
class CameraTrack:
    """One camera's frames: times n in s on the file's own time base."""

    time_s: NDArray[np.float64]
    frames: RoomFrames

    def placed(self, zero_s: float) -> SkeletonTrack:
        """On session time, which is zero at `zero_s`. A file holds one person: who is in none of its joints is away."""
        captured_ns = np.round((self.time_s - zero_s) * 1e9).astype(np.int64)
        present = np.asarray((self.frames.state > 0).any(axis=1))
        body = [1 if there else None for there in present.tolist()]
        return SkeletonTrack(captured_ns, body, [int(there) for there in present.tolist()], self.frames)


def read_camera(folder: Path, manifest: Manifest, entry: CameraEntry, rejected: RejectionCounter) -> CameraTrack:
    """Read, convert and check one camera. Raises a SourceError that names file, line and column.

    A frame that comes out of time is left out and counted; single joints that are no place are counted and not tracked.
    """
    view = camera_view(entry)
    time = entry.time or manifest.time
    position_columns, state_columns = joint_columns(entry, view)
    table = read_table(
        folder / entry.file,
        [*position_columns, *state_columns, *([time.column] if time.column else [])],
        csv_format(entry.format or manifest.format),
    )
    rejected.add(entry.name, Reason.MALFORMED_ROW, table.malformed)
    time_s = row_times_s(table, time, entry.rate_hz or manifest.rate_hz)
    advancing = advancing_rows(table, time_s)
    rejected.add(entry.name, Reason.NOT_FINITE, int((~np.isfinite(time_s)).sum()))
    rejected.add(entry.name, Reason.CLOCK_BACKWARDS, int(np.isfinite(time_s).sum() - advancing.sum()))
    if not advancing.any():
        raise EmptyFile(f"{place(table.path)}: camera {entry.name} has no row with a time")
    values, joints = table.values[advancing], len(view.joints)
    positions = values[:, : 3 * joints].reshape(-1, joints, 3)
    codes = state_codes(values[:, 3 * joints : 3 * joints + len(state_columns)])
    where = f"{place(table.path)}, camera {entry.name}"
    check_view(where, view, positions, codes, entry.unit)
    frames = frames_in_room(view, positions, codes)
    rejected.add(entry.name, Reason.NOT_FINITE, frames.not_finite)
    rejected.add(entry.name, Reason.OUT_OF_RANGE, frames.out_of_range)
    return CameraTrack(time_s[advancing], frames)


def joint_columns(entry: CameraEntry, view: CameraView) -> tuple[list[str], list[str]]:
    """Names of the columns with x, y and z of each joint, and of those with the states; the latter may be none."""
    if entry.numbers is not None:
        first = [entry.numbers.first_column + entry.numbers.each * k for k in range(len(view.joints))]
        states = [] if entry.numbers.state is None else [str(at + entry.numbers.state - 1) for at in first]
        return [str(at + axis) for at in first for axis in range(3)], states
    assert entry.columns is not None, "load_manifest checked that one of the two is there"
    names, pattern = entry.columns.names, entry.columns.state
    positions = [
        column for name in names for column in expanded(entry.columns.position.replace("{joint}", name), "xyz")
    ]
    return positions, [] if pattern is None else [pattern.replace("{joint}", name) for name in names]


def state_codes(values: NDArray[np.float64]) -> NDArray[np.int64] | None:
    """n x joints; a field without a number is the code of no camera, and so not tracked. None without such columns."""
    if values.shape[1] == 0:
        return None
    known = np.isfinite(values) & (values == np.round(values)) & (np.abs(values) < 1000)
    return np.where(known, np.where(known, values, 0.0), -1.0).astype(np.int64)
