"""recording.toml: what lies in which column, in which unit, worn where. Documented in this folder's README."""

import tomllib
from datetime import datetime
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from schemas.session import Anthropometry, Placement, WalkPath
from schemas.vocabulary import ESTIMATORS, KNEE_ESTIMATORS, Segment, Task
from services.biomech.event_sources import whole_legs
from services.ingest.axes import Axes, rotation_from_axes
from services.ingest.errors import InvalidManifest, MissingFile, UnknownSegment, UnreadableFile
from services.ingest.units import reference_unit, scale_to_si

FILE_NAME = "recording.toml"
FRAME = "frame"
"""Unit of a time column that counts samples at the nominal rate."""

Triple = Annotated[list[str], Field(min_length=3, max_length=3)]
Numbers3 = Annotated[list[float], Field(min_length=3, max_length=3)]
Rate = Annotated[float, Field(gt=0.1, lt=10_000)]


class Entry(BaseModel):
    """A table of the manifest. Misspelt keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class FormatEntry(Entry):
    """How the csv files are written."""

    delimiter: Annotated[str, Field(pattern=r"^[,;|\t ]$")] = ","
    header: bool = True
    skip_lines: Annotated[int, Field(ge=0, le=10_000)] = 0


class TimeEntry(Entry):
    """The time column; without one, rows follow each other at the rate."""

    column: str | None = None
    unit: str = FRAME
    offset_s: float = 0.0


class QuantityEntry(Entry):
    """Three columns of a vector: their names, or a pattern with {axis} (x, y, z), {AXIS} (X, Y, Z) and {sensor}."""

    columns: str | Triple
    unit: str


class ImuEntry(Entry):
    """What holds for every sensor unless the sensor says otherwise."""

    file: str | None = None
    specific_force: QuantityEntry | None = None
    angular_velocity: QuantityEntry | None = None
    time: TimeEntry | None = None
    axes: Axes | None = None


class SensorEntry(ImuEntry):
    """One sensor and where it is worn."""

    name: Annotated[str, Field(pattern=r"^[a-z0-9_]{1,40}$")]
    segment: str
    outward_axis: Numbers3
    upward_axis: Numbers3 | None = None
    placement: Placement = Placement.UNKNOWN
    position_in_segment: Numbers3 | None = None
    rate_hz: Rate | None = None


class HubEntry(Entry):
    """One receiver with its sensors."""

    name: Annotated[str, Field(pattern=r"^[a-z0-9_]{1,40}$")] = "imu"
    sensor: Annotated[list[SensorEntry], Field(min_length=1)]


class ChannelEntry(Entry):
    """One column of truth."""

    name: str
    column: str
    unit: str = "1"
    sign: Literal[1, -1] = 1


class PointEntry(Entry):
    """A marker or joint centre: becomes the channels name_x, name_y, name_z in m, ISB world."""

    name: str
    columns: str | Triple
    unit: str
    axes: Axes | None = None


class OrientationEntry(Entry):
    """A unit quaternion, columns in the order w, x, y, z: becomes name_w, name_x, name_y, name_z, ISB frames."""

    name: str
    columns: Annotated[list[str], Field(min_length=4, max_length=4)]
    world_axes: Axes | None = None
    segment_axes: Axes | None = None


class BodyEntry(Entry):
    """Body dimensions; height and mass may be left out."""

    thigh_length_m: Annotated[float, Field(gt=0.1, lt=0.8)]
    shank_length_m: Annotated[float, Field(gt=0.1, lt=0.8)]
    hip_width_m: Annotated[float, Field(gt=0.05, lt=0.5)]
    height_m: Annotated[float, Field(gt=0.5, lt=2.6)] | None = None
    mass_kg: Annotated[float, Field(gt=5, lt=400)] | None = None
    source: Literal["measured", "regression", "default"] = "measured"

    def described(self) -> Anthropometry:
        """As the session description carries it."""
        return Anthropometry(**self.model_dump())


class ReferenceEntry(Entry):
    """One file of truth."""

    file: str
    rate_hz: Rate | None = None
    time: TimeEntry | None = None
    format: FormatEntry | None = None
    channel: list[ChannelEntry] = []
    point: list[PointEntry] = []
    orientation: list[OrientationEntry] = []


class StandingEntry(Entry):
    """A span that the operator marked as quiet standing, s since the start of the recording."""

    from_s: Annotated[float, Field(ge=0)]
    to_s: Annotated[float, Field(gt=0)]


class Manifest(Entry):
    """A whole recording.toml."""

    title: str
    protocol: str = ""
    task: Task = Task.WALK
    walkway_m: Annotated[float, Field(gt=0, le=100)] | None = None
    estimator: str = "rhythmic_ekf"
    walk_path: WalkPath = "turning"
    data: str = "."
    started: datetime | None = None
    rate_hz: Rate
    anthropometry: BodyEntry
    format: FormatEntry = FormatEntry()
    time: TimeEntry = TimeEntry()
    imu: ImuEntry = ImuEntry()
    hub: Annotated[list[HubEntry], Field(min_length=1)]
    standing: list[StandingEntry] = []
    reference: list[ReferenceEntry] = []


def load_manifest(path: Path) -> Manifest:
    """Read and check a manifest. Raises a SourceError that names the key and what to write instead."""
    try:
        manifest = Manifest.model_validate(tomllib.loads(path.read_text(encoding="utf-8")))
    except FileNotFoundError as error:
        raise MissingFile(f"no {path}; a recording folder needs a {FILE_NAME}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise UnreadableFile(f"{path.name}: {error}") from error
    except tomllib.TOMLDecodeError as error:
        raise InvalidManifest(f"{path.name}: {error}; this is not TOML") from error
    except ValidationError as error:
        raise InvalidManifest(f"{path.name}: {_first_fault(error)}; see services/ingest/README.md") from error
    _check_meaning(manifest, path.name)
    return manifest


def _first_fault(error: ValidationError) -> str:
    fault = error.errors(include_url=False, include_context=False)[0]
    key = ".".join(str(part) for part in fault["loc"])
    return f"{key or 'the file'}: {fault['msg']}"


def _check_meaning(manifest: Manifest, where: str) -> None:
    if manifest.estimator not in ESTIMATORS:
        raise InvalidManifest(f"{where}: estimator {manifest.estimator!r} is none of {', '.join(ESTIMATORS)}")
    sensors = [sensor for hub in manifest.hub for sensor in hub.sensor]
    _check_unique(where, "sensor", [sensor.name for sensor in sensors])
    _check_unique(where, "hub", [hub.name for hub in manifest.hub])
    for standing in manifest.standing:
        if standing.to_s <= standing.from_s:
            raise InvalidManifest(f"{where}: standing ends before it starts ({standing.from_s} .. {standing.to_s} s)")
    for sensor in sensors:
        _check_sensor(manifest, sensor, f"{where}, sensor {sensor.name}")
    if manifest.estimator in KNEE_ESTIMATORS and not whole_legs({Segment(sensor.segment) for sensor in sensors}):
        raise InvalidManifest(
            f"{where}: estimator {manifest.estimator!r} needs a sensor on the thigh and one on the shank of one leg; "
            "correct the segments, or leave the estimator out"
        )
    for reference in manifest.reference:
        _check_reference(reference, f"{where}, reference {reference.file}")
    _check_unique(where, "reference channel", [name for entry in manifest.reference for name in channel_names(entry)])


def _check_unique(where: str, what: str, names: list[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise InvalidManifest(f"{where}: {what} {name!r} appears twice; names must differ")


def _check_sensor(manifest: Manifest, sensor: SensorEntry, where: str) -> None:
    if sensor.segment not in list(Segment):
        raise UnknownSegment(f"{where}: segment {sensor.segment!r} is none of {', '.join(Segment)}")
    if sensor.upward_axis is not None and sum(value**2 for value in sensor.upward_axis) < 1e-6:
        raise InvalidManifest(f"{where}: upward_axis must not be zero; name the axis that points up, or leave it out")
    if sum(value**2 for value in sensor.outward_axis) < 1e-6:
        raise InvalidManifest(f"{where}: outward_axis must not be zero; name the sensor axis that points off the skin")
    if sensor.file is None and manifest.imu.file is None:
        raise InvalidManifest(f"{where}: no file; write `file` here or under [imu]")
    for name, quantity in (("specific_force", "specific force"), ("angular_velocity", "angular velocity")):
        entry = getattr(sensor, name) or getattr(manifest.imu, name)
        if entry is None:
            raise InvalidManifest(f"{where}: no {name}; write columns and unit here or under [imu]")
        scale_to_si(quantity, entry.unit)
    check_time(sensor.time or manifest.imu.time or manifest.time)
    rotation_from_axes(sensor.axes, where)
    rotation_from_axes(manifest.imu.axes, where)


def _check_reference(entry: ReferenceEntry, where: str) -> None:
    for channel in entry.channel:
        reference_unit(channel.unit)
    for point in entry.point:
        scale_to_si("length", point.unit)
        rotation_from_axes(point.axes, where)
    for orientation in entry.orientation:
        rotation_from_axes(orientation.world_axes, where)
        rotation_from_axes(orientation.segment_axes, where)
    if entry.time is not None:
        check_time(entry.time)


def check_time(time: TimeEntry) -> None:
    """Raises UnknownUnit for a unit that is neither a frame count nor a time."""
    if time.unit != FRAME:
        scale_to_si("time", time.unit)


def channel_names(entry: ReferenceEntry) -> list[str]:
    """Channels that one file of truth delivers, in order."""
    names = [channel.name for channel in entry.channel]
    names += [f"{point.name}_{axis}" for point in entry.point for axis in "xyz"]
    return names + [f"{orientation.name}_{axis}" for orientation in entry.orientation for axis in "wxyz"]
