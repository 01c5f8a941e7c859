"""recording.toml: what lies in which column, in which unit, worn where. Documented in this folder's README."""

import tomllib
from datetime import datetime
from pathlib import Path
from typing import Annotated

from pydantic import Field, ValidationError

from schemas.conditions import UNSAID, Conditions
from schemas.session import WalkPath
from schemas.vocabulary import ESTIMATORS, KNEE_ESTIMATORS, Segment, Task
from services.biomech.event_sources import whole_legs
from services.ingest.axes import rotation_from_axes
from services.ingest.camera_view import check_camera
from services.ingest.choices import missing_source, usual_estimator
from services.ingest.entries import (
    LEANS,
    BodyEntry,
    CameraEntry,
    Entry,
    FormatEntry,
    HubEntry,
    ImuEntry,
    Rate,
    ReferenceEntry,
    SensorEntry,
    StandingEntry,
    TimeEntry,
)
from services.ingest.errors import InvalidManifest, MissingFile, UnknownSegment, UnreadableFile
from services.ingest.timing import check_time
from services.ingest.units import reference_unit, scale_to_si

FILE_NAME = "recording.toml"

TYPICAL_BODY = BodyEntry(thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="default")


class Manifest(Entry):
    """A whole recording.toml."""

    title: str
    protocol: str = ""
    task: Task = Task.WALK
    walkway_m: Annotated[float, Field(gt=0, le=100)] | None = None
    conditions: Conditions = UNSAID
    estimator: str | None = None
    walk_path: WalkPath = "turning"
    data: str = "."
    started: datetime | None = None
    rate_hz: Rate
    anthropometry: BodyEntry | None = None
    format: FormatEntry = FormatEntry()
    time: TimeEntry = TimeEntry()
    imu: ImuEntry = ImuEntry()
    hub: list[HubEntry] = Field(default_factory=list)
    camera: list[CameraEntry] = Field(default_factory=list)
    standing: list[StandingEntry] = Field(default_factory=list)
    reference: list[ReferenceEntry] = Field(default_factory=list)

    @property
    def chosen_estimator(self) -> str:
        """The one that is named, else the usual one for what there is."""
        return self.estimator or usual_estimator(hubs=bool(self.hub), cameras=bool(self.camera))

    @property
    def body(self) -> BodyEntry:
        """What is stated about the body; a camera measures it, so that its people need no dimensions."""
        return self.anthropometry or TYPICAL_BODY


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
    _check_sources(manifest, where)
    sensors = [sensor for hub in manifest.hub for sensor in hub.sensor]
    _check_unique(where, "sensor", [sensor.name for sensor in sensors])
    _check_unique(
        where, "hub or camera", [hub.name for hub in manifest.hub] + [camera.name for camera in manifest.camera]
    )
    for standing in manifest.standing:
        if standing.to_s <= standing.from_s:
            raise InvalidManifest(f"{where}: standing ends before it starts ({standing.from_s} .. {standing.to_s} s)")
    for sensor in sensors:
        _check_sensor(manifest, sensor, f"{where}, sensor {sensor.name}")
    for camera in manifest.camera:
        check_camera(camera, manifest.format, f"{where}, camera {camera.name}")
    if manifest.estimator in KNEE_ESTIMATORS and not whole_legs({Segment(sensor.segment) for sensor in sensors}):
        raise InvalidManifest(
            f"{where}: estimator {manifest.estimator!r} needs a sensor on the thigh and one on the shank of one leg; "
            "correct the segments, or leave the estimator out"
        )
    for reference in manifest.reference:
        _check_reference(reference, f"{where}, reference {reference.file}")
    _check_unique(where, "reference channel", [name for entry in manifest.reference for name in channel_names(entry)])


def _check_sources(manifest: Manifest, where: str) -> None:
    if not manifest.hub and not manifest.camera:
        raise InvalidManifest(f"{where}: nothing is recorded; add a [[hub]] with sensors or a [[camera]]")
    if manifest.hub and manifest.anthropometry is None:
        raise InvalidManifest(f"{where}: anthropometry: missing; sensors need the lengths of thigh and shank")
    if manifest.estimator is not None and manifest.estimator not in ESTIMATORS:
        raise InvalidManifest(f"{where}: estimator {manifest.estimator!r} is none of {', '.join(ESTIMATORS)}")
    lacking = missing_source(manifest.chosen_estimator, hubs=bool(manifest.hub), cameras=bool(manifest.camera))
    if lacking is not None:
        raise InvalidManifest(f"{where}: {lacking}")


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
    for inclination in entry.inclination:
        rotation_from_axes(inclination.axes, where)
    if entry.time is not None:
        check_time(entry.time)


def channel_names(entry: ReferenceEntry) -> list[str]:
    """Channels that one file of truth delivers, in order."""
    names = [channel.name for channel in entry.channel]
    names += [f"{point.name}_{axis}" for point in entry.point for axis in "xyz"]
    names += [f"{orientation.name}_{axis}" for orientation in entry.orientation for axis in "wxyz"]
    return names + [f"{lean.name}_{direction}" for lean in entry.inclination for direction in LEANS]
