"""What the API takes and gives for the keys of machines."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from services.gateway.access.roles import Role

LONGEST_DAYS = 365

KeyName = Annotated[
    str,
    Field(
        min_length=1,
        max_length=64,
        pattern=r"^[^\x00-\x1f]*$",
        description="what uses it",
        examples=["hospital export"],
    ),
]


class KeyIn(BaseModel):
    """A new key."""

    model_config = ConfigDict(extra="forbid")

    name: KeyName
    role: Literal[Role.SERVICE, Role.VIEWER] = Field(examples=["service"])
    days: int = Field(ge=1, le=LONGEST_DAYS, description="days until it ends", examples=[90])


class KeyOut(BaseModel):
    """A key without its secret, which is not kept."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(description="second part of the key's text", examples=["3f9c0a71be42"])
    name: KeyName
    role: Role
    created_by: str | None = Field(description="login of who made it; null when the account is gone")
    created: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    expires: datetime = Field(description="UTC", examples=["2027-02-20T09:30:00Z"])
    used: datetime | None = Field(description="UTC, to the minute; null: never", examples=[None])
    revoked: datetime | None = Field(description="UTC; when it was taken back", examples=[None])


class NewKeyOut(KeyOut):
    """A new key, this once with its text."""

    key: str = Field(
        description="to be sent as a bearer token; it is shown only now",
        examples=["ambula_3f9c0a71be42_Zk3v0mJx2QYw1rT8uF5sLb7cN9dHaGpE4iOoK6tXyRU"],
    )


class KeyPage(BaseModel):
    """Part of the list, newest first."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of keys in the whole list", examples=[1])
    items: list[KeyOut]
