"""What the API takes and gives for clinics."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from services.gateway.accounts.account_models import ClinicId

ClinicName = Annotated[
    str, Field(min_length=1, max_length=100, pattern=r"^[^\x00-\x1f]*$", examples=["Rehabilitation, ward 3"])
]
KeepDays = Annotated[
    int, Field(ge=1, le=36_500, description="days that recordings are kept; null for good", examples=[3650])
]


class ClinicIn(BaseModel):
    """A new clinic."""

    model_config = ConfigDict(extra="forbid")

    id: ClinicId
    name: ClinicName
    keep_days: KeepDays | None = None


class ClinicChange(BaseModel):
    """What may change later. What is left out stays; null for `keep_days` keeps recordings for good."""

    model_config = ConfigDict(extra="forbid")

    name: ClinicName = "Clinic"
    keep_days: KeepDays | None = None


class ClinicOut(BaseModel):
    """A clinic of the site."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(examples=["main"])
    name: ClinicName
    keep_days: KeepDays | None = Field(description="days that recordings are kept; null: for good")
    created: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    accounts: int = Field(ge=0, description="number of accounts that are open", examples=[12])


class ClinicPage(BaseModel):
    """Part of the list, by name."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of clinics in the whole list", examples=[1])
    items: list[ClinicOut]
