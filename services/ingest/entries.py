"""The tables of a recording.toml, one model each; manifest.py puts them together and checks what they mean."""

from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from schemas.session import Anthropometry, Placement
from schemas.vocabulary import CameraKind, SkeletonJoint
from services.ingest.axes import Axes

FRAME = "frame"
"""Unit of a time column that counts samples at the nominal rate."""

LEANS = ("forward", "right")
"""Endings of the two channels of an inclination."""

Triple = Annotated[list[str], Field(min_length=3, max_length=3)]
Numbers3 = Annotated[list[float], Field(min_length=3, max_length=3)]
Numbers4 = Annotated[list[float], Field(min_length=4, max_length=4)]
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


class JointNumbers(Entry):
    """Joints that follow each other in a file without names: how many numbers each has, and which is its state.

    Counted from 1; the first three are x, y and z.
    """

    each: Annotated[int, Field(ge=3, le=64)]
    state: Annotated[int, Field(ge=4)] | None = None
    first_column: Annotated[int, Field(ge=1)] = 1

    @model_validator(mode="after")
    def _state_is_one_of_them(self) -> Self:
        if self.state is not None and self.state > self.each:
            raise ValueError(f"state is the {self.state}th of {self.each} numbers; count from 1 within one joint")
        return self


class JointColumns(Entry):
    """Joints whose columns have names: patterns with {joint} and {axis} or {AXIS}, and the file's names of the joints.

    `names` follow the order of the camera's joints.
    """

    position: Annotated[str, Field(pattern=r"\{joint\}.*\{(axis|AXIS)\}|\{(axis|AXIS)\}.*\{joint\}")]
    names: list[str]
    state: Annotated[str, Field(pattern=r"\{joint\}")] | None = None


class CameraEntry(Entry):
    """One depth camera and the file of the one person it followed."""

    name: Annotated[str, Field(pattern=r"^[a-z0-9_]{1,40}$")] = "camera"
    kind: CameraKind
    file: str
    numbers: JointNumbers | None = None
    columns: JointColumns | None = None
    joints: list[SkeletonJoint] | None = None
    unit: str | None = None
    axes: Axes | None = None
    up: Numbers3 | None = None
    floor_plane: Numbers4 | None = None
    floor_m: Annotated[float, Field(gt=-5, lt=5)] | None = None
    rate_hz: Rate | None = None
    time: TimeEntry | None = None
    format: FormatEntry | None = None


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


class InclinationEntry(Entry):
    """The lean of a line between two points: becomes name_forward and name_right, rad, ISB world."""

    name: str
    lower: str | Triple
    upper: str | Triple
    axes: Axes | None = None


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
    inclination: list[InclinationEntry] = []


class StandingEntry(Entry):
    """A span that the operator marked as quiet standing, s since the start of the recording."""

    from_s: Annotated[float, Field(ge=0)]
    to_s: Annotated[float, Field(gt=0)]
