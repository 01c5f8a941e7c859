"""What the API takes and gives for devices."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

DeviceKind = Literal["sensor_set", "camera"]
TEXT = r"^[^\x00-\x1f]*$"
DeviceName = Annotated[str, Field(min_length=1, max_length=64, pattern=TEXT, examples=["Set B, ward 3"])]
DeviceSource = Annotated[
    str,
    Field(
        pattern=r"^device:[^\x00-\x20]{1,290}$",
        description="where it sends, as GET /v1/sources names it; while it is registered no other clinic is offered it",
        examples=["device:kinect?port=7788"],
    ),
]
Note = Annotated[
    str, Field(max_length=200, pattern=TEXT, description="about the device, nobody else", examples=["strap mended"])
]


class DeviceIn(BaseModel):
    """A new device."""

    model_config = ConfigDict(extra="forbid")

    name: DeviceName
    kind: DeviceKind = Field(examples=["camera"])
    source: DeviceSource | None = None
    note: Note | None = None


class DeviceChange(BaseModel):
    """What may change later. What is left out stays; null takes a source or a note out."""

    model_config = ConfigDict(extra="forbid")

    name: DeviceName = "Device"
    source: DeviceSource | None = None
    note: Note | None = None
    retired: bool = Field(default=False, description="no longer in use; its source is free for others")


class DeviceOut(BaseModel):
    """A device of the clinic."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(examples=["5b1e9a20c4d7"])
    name: DeviceName
    kind: DeviceKind
    source: str | None = Field(
        description="where it sends, as GET /v1/sources names it", examples=["device:kinect?port=7788"]
    )
    note: Note | None
    retired: datetime | None = Field(description="UTC; since when it is not used", examples=[None])
    created: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])


class DevicePage(BaseModel):
    """Part of the list: those in use by name, then the others."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of devices in the whole list", examples=[1])
    items: list[DeviceOut]
