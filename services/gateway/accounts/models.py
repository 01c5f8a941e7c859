"""What the API takes and gives for signing in, and for one's own account."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, SecretStr

from services.gateway.access.roles import Permission, Role
from services.gateway.accounts.passwords import SHORTEST

Login = Annotated[
    str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._@-]{0,63}$", description="name to sign in with", examples=["m.arnold"])
]
Password = Annotated[SecretStr, Field(max_length=200, description="in clear, over TLS", examples=["three quiet steps"])]
NewPassword = Annotated[
    SecretStr,
    Field(min_length=SHORTEST, max_length=200, description="at least 12 letters", examples=["three quiet steps"]),
]


class SignInState(BaseModel):
    """What a page must know before anybody has signed in."""

    model_config = ConfigDict(extra="forbid")

    first_run: bool = Field(description="nobody has an account yet: choose the first administrator")
    providers: list[str] = Field(
        description="names of the organisation's sign-in services (OIDC)", examples=[["clinic"]]
    )


class FirstRunIn(BaseModel):
    """The first administrator."""

    model_config = ConfigDict(extra="forbid")

    code: str = Field(max_length=32, description="as the gateway's terminal shows it", examples=["7KQM3F9TPX"])
    login: Login
    password: NewPassword


class SignInIn(BaseModel):
    """Somebody who wants in."""

    model_config = ConfigDict(extra="forbid")

    # Without control characters, which not every database takes as text.
    login: str = Field(
        max_length=64, pattern=r"^[^\x00-\x1f]*$", description="name of the account", examples=["m.arnold"]
    )
    password: Password


class ConfirmationIn(BaseModel):
    """The password once more."""

    model_config = ConfigDict(extra="forbid")

    password: Password


class PasswordChange(BaseModel):
    """A new password for one's own account."""

    model_config = ConfigDict(extra="forbid")

    password: Password
    new_password: NewPassword


class EndedOut(BaseModel):
    """Sign-ins that were ended."""

    model_config = ConfigDict(extra="forbid")

    ended: int = Field(ge=0, description="number of browsers that are signed out now", examples=[2])


class MeOut(BaseModel):
    """Whoever is signed in, and what they may do."""

    model_config = ConfigDict(extra="forbid")

    account: str = Field(description="id of the account or key", examples=["8d0c2a71f04be655"])
    login: str = Field(examples=["m.arnold"])
    role: Role
    clinic: str = Field(description="id of the clinic", examples=["main"])
    clinic_name: str = Field(examples=["Clinic"])
    site_admin: bool = Field(description="may manage every clinic of the site")
    provider: str | None = Field(
        description="the sign-in service that knows the password; null when it is known here", examples=[None]
    )
    may: list[Permission]
