"""What the API takes and gives for shared patients."""

from datetime import datetime

from pydantic import BaseModel, ConfigDict, Field

from services.gateway.access.roles import Role


class ColleagueOut(BaseModel):
    """Somebody with whom a patient may be shared."""

    model_config = ConfigDict(extra="forbid")

    account: str = Field(description="id of the account", examples=["8d0c2a71f04be655"])
    login: str = Field(examples=["m.arnold"])
    role: Role
    clinic: str = Field(description="id of the clinic", examples=["north"])
    clinic_name: str = Field(examples=["Clinic in the north"])


class ShareIn(BaseModel):
    """With whom."""

    model_config = ConfigDict(extra="forbid")

    account: str = Field(
        pattern="^[0-9a-f]{1,32}$", description="id, from GET /v1/colleagues", examples=["8d0c2a71f04be655"]
    )


class ShareOut(ColleagueOut):
    """A colleague who may see the patient."""

    granted: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    granted_by: str | None = Field(description="login of who shared; null when the account is gone")


class SharesOut(BaseModel):
    """Everybody outside of the clinic who may see a patient."""

    model_config = ConfigDict(extra="forbid")

    items: list[ShareOut]
