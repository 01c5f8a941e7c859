"""One sensor of a recording: its columns, in SI and in Ambula's sensor axes, without the rows that say nothing."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from schemas.health import Reason
from services.flow.rejections import RejectionCounter
from services.ingest.axes import rotation_from_axes
from services.ingest.checks import DeclaredUnits, check_units
from services.ingest.entries import FormatEntry, QuantityEntry, SensorEntry
from services.ingest.errors import EmptyFile, place
from services.ingest.manifest import Manifest
from services.ingest.table import CsvFormat, Table, read_table
from services.ingest.timing import advancing_rows, row_times_s
from services.ingest.tracks import ImuTrack
from services.ingest.units import scale_to_si

LARGEST_SPECIFIC_FORCE = 1e4
"""m/s^2; a thousand g, beyond any worn sensor. Larger numbers are damage to the file."""

LARGEST_ANGULAR_VELOCITY = 1e3
"""rad/s; likewise."""


@dataclass(frozen=True, slots=True)
class RawTrack:
    """One sensor's usable rows: n, n x 3 rad/s, n x 3 m/s^2; times in s on the file's own time base."""

    time_s: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    specific_force: NDArray[np.float64]

    def placed(self, zero_s: float) -> ImuTrack:
        """On session time, which is zero at `zero_s`."""
        captured_ns = np.round((self.time_s - zero_s) * 1e9).astype(np.int64)
        return ImuTrack(captured_ns, self.angular_velocity, self.specific_force)

    def where(self, kept: NDArray[np.bool_]) -> "RawTrack":
        """Only some rows."""
        return RawTrack(self.time_s[kept], self.angular_velocity[kept], self.specific_force[kept])


def read_sensor(folder: Path, manifest: Manifest, sensor: SensorEntry, rejected: RejectionCounter) -> RawTrack:
    """Read, convert and check one sensor. Raises a SourceError that names file, line and column."""
    shared = manifest.imu
    force = _quantity(sensor.specific_force, shared.specific_force)
    rate = _quantity(sensor.angular_velocity, shared.angular_velocity)
    time = sensor.time or shared.time or manifest.time
    path = folder / (sensor.file or shared.file or "").replace("{sensor}", sensor.name)
    wanted = [*_columns(rate, sensor.name), *_columns(force, sensor.name), *([time.column] if time.column else [])]
    table = read_table(path, wanted, csv_format(manifest.format))
    rejected.add(sensor.name, Reason.MALFORMED_ROW, table.malformed)
    rate_hz = sensor.rate_hz or manifest.rate_hz
    R_sensor_from_vendor = rotation_from_axes(sensor.axes or shared.axes, sensor.name)
    scales = scale_to_si("angular velocity", rate.unit), scale_to_si("specific force", force.unit)
    vendor = RawTrack(row_times_s(table, time, rate_hz), table.values[:, :3], table.values[:, 3:6])
    usable = _usable(table, sensor.name, vendor, rejected)
    track = RawTrack(
        usable.time_s,
        usable.angular_velocity @ R_sensor_from_vendor.T * scales[0],
        usable.specific_force @ R_sensor_from_vendor.T * scales[1],
    )
    track = _in_range(sensor.name, track, rejected)
    where = f"{place(path)}, sensor {sensor.name}"
    check_units(where, track.placed(float(track.time_s[0])), rate_hz, DeclaredUnits(force.unit, rate.unit))
    return track


def csv_format(entry: FormatEntry) -> CsvFormat:
    """The manifest's words as the reader wants them."""
    return CsvFormat(entry.delimiter, entry.header, entry.skip_lines)


def expanded(columns: str | list[str], axes: str, sensor: str = "") -> list[str]:
    """Column names, one per axis; a pattern's {axis}, {AXIS} and {sensor} are filled in."""
    patterns = [columns] * len(axes) if isinstance(columns, str) else columns
    return [
        pattern.replace("{axis}", axis).replace("{AXIS}", axis.upper()).replace("{sensor}", sensor)
        for pattern, axis in zip(patterns, axes, strict=True)
    ]


def _columns(quantity: QuantityEntry, sensor: str) -> list[str]:
    return expanded(quantity.columns, "xyz", sensor)


def _quantity(own: QuantityEntry | None, shared: QuantityEntry | None) -> QuantityEntry:
    entry = own or shared
    assert entry is not None, "load_manifest checked that every sensor has both quantities"
    return entry


def _usable(table: Table, sensor: str, track: RawTrack, rejected: RejectionCounter) -> RawTrack:
    finite = np.isfinite(track.angular_velocity).all(axis=1) & np.isfinite(track.specific_force).all(axis=1)
    finite &= np.isfinite(track.time_s)
    rejected.add(sensor, Reason.NOT_FINITE, int((~finite).sum()))
    advancing = advancing_rows(table, np.where(finite, track.time_s, np.nan))
    rejected.add(sensor, Reason.CLOCK_BACKWARDS, int(finite.sum() - advancing.sum()))
    if not advancing.any():
        raise EmptyFile(f"{place(table.path)}: sensor {sensor} has no row with all its numbers")
    return track.where(advancing)


def _in_range(sensor: str, track: RawTrack, rejected: RejectionCounter) -> RawTrack:
    """Without absurd rows; when most are absurd the unit is wrong, and the check of units says so."""
    kept = (np.abs(track.angular_velocity).max(axis=1) < LARGEST_ANGULAR_VELOCITY) & (
        np.abs(track.specific_force).max(axis=1) < LARGEST_SPECIFIC_FORCE
    )
    if kept.mean() < 0.5:
        return track
    rejected.add(sensor, Reason.OUT_OF_RANGE, int((~kept).sum()))
    return track.where(kept)
