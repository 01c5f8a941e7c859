"""What the API takes and gives for accounts, as their administrators see them."""

from datetime import datetime
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from services.gateway.access.roles import Role
from services.gateway.accounts.models import Login, NewPassword

ClinicId = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]{0,31}$", description="id of a clinic", examples=["main"])]
PersonsRole = Literal[Role.VIEWER, Role.THERAPIST, Role.ADMIN]
"""Machines have keys."""


class AccountIn(BaseModel):
    """A new account: with a password, or with the service where its owner signs in."""

    model_config = ConfigDict(extra="forbid")

    login: Login
    role: PersonsRole = Field(examples=["therapist"])
    password: NewPassword | None = Field(default=None, description="the first one, to be changed by its owner")
    provider: str | None = Field(
        default=None, max_length=32, description="name of the sign-in service that knows the password instead"
    )
    clinic: ClinicId | None = Field(default=None, description="one's own when left out; another by site admins only")
    site_admin: bool = Field(default=False, description="may manage every clinic; given by site admins only")

    @model_validator(mode="after")
    def _signs_in_somewhere(self) -> Self:
        if (self.password is None) == (self.provider is None):
            raise ValueError("give either a password or a provider")
        return self


class AccountChange(BaseModel):
    """What may change later. What is left out, or null, stays."""

    model_config = ConfigDict(extra="forbid")

    role: PersonsRole | None = Field(default=None, examples=["viewer"])
    disabled: bool | None = Field(default=None, description="closed: every browser is signed out, and none gets in")
    clinic: ClinicId | None = Field(default=None, description="by site admins only")
    site_admin: bool | None = Field(default=None, description="by site admins only")


class PasswordIn(BaseModel):
    """A new password for somebody else."""

    model_config = ConfigDict(extra="forbid")

    password: NewPassword


class AccountOut(BaseModel):
    """An account."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(examples=["8d0c2a71f04be655"])
    login: str = Field(examples=["m.arnold"])
    role: Role
    clinic: str = Field(description="id of the clinic", examples=["main"])
    site_admin: bool = Field(description="may manage every clinic of the site")
    disabled: bool = Field(description="closed by an administrator")
    provider: str | None = Field(
        description="the sign-in service that knows the password; null when it is known here", examples=[None]
    )
    created: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    locked_until: datetime | None = Field(description="UTC; closed until then by wrong passwords", examples=[None])
    browsers: int = Field(ge=0, description="number of browsers that are signed in", examples=[1])


class AccountPage(BaseModel):
    """Part of the list, by login."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of accounts in the whole list", examples=[1])
    items: list[AccountOut]
