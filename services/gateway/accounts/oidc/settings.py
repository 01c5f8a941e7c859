"""A sign-in service as the site sets it up. No request can name another one."""

from typing import Annotated, Literal, Self
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, SecretStr, StringConstraints, model_validator

from services.gateway.access.roles import Role

LOOPBACK = ("127.0.0.1", "localhost", "::1")

ProviderName = Annotated[str, StringConstraints(pattern=r"^[a-z0-9][a-z0-9-]{0,31}$")]


class OidcProvider(BaseModel):
    """One service. With `role` and `clinic`, whoever it vouches for is given such an account when they first come;
    without, an administrator makes the accounts beforehand."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    issuer: str = Field(description="as it stands in its tokens; its discovery document is below this address")
    client_id: str = Field(min_length=1, description="the gateway's name there")
    client_secret: SecretStr | None = Field(default=None, description="None for a public client: PKCE alone")
    login_claim: str = Field(
        default="email", description="the claim with the name to sign in with; `email` counts only when verified there"
    )
    scopes: list[str] = Field(default_factory=lambda: ["email", "profile"], description="beside `openid`")
    role: Literal[Role.VIEWER, Role.THERAPIST] | None = Field(default=None, description="of accounts that are made")
    clinic: str | None = Field(default=None, description="id of the clinic of accounts that are made")

    @model_validator(mode="after")
    def _is_sound(self) -> Self:
        if not is_safe(self.issuer):
            raise ValueError("issuer must be https (http only on this machine)")
        if (self.role is None) != (self.clinic is None):
            raise ValueError("role and clinic of accounts that are made go together")
        return self


def is_safe(url: str) -> bool:
    """Whether nobody on the way can listen or answer: TLS, or this machine."""
    parts = urlsplit(url)
    if parts.scheme == "https":
        return bool(parts.hostname)
    return parts.scheme == "http" and parts.hostname in LOOPBACK
