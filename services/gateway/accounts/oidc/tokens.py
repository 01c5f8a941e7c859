"""An id token: whether the service really says this, about this sign-in, to us, now."""

import hmac
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import jwt

from services.gateway.accounts.oidc.settings import OidcProvider

ALGORITHMS = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "EdDSA")
"""Signatures by a key that only the service has. Neither `none` nor those by a shared secret."""

LEEWAY_S = 60.0
"""s by which the clocks of the site and the service may differ."""


class NotBelieved(Exception):
    """The token is refused. The message says why, never what it holds."""


@dataclass(frozen=True, slots=True)
class Claims:
    """What a service says of somebody. `login` None: not said, or not verified there.

    `authenticated`: when they gave their password there, None when it is not said.
    """

    subject: str
    login: str | None
    authenticated: datetime | None


def key_id(token: str) -> str | None:
    """Which key it says that it is signed with. Raises NotBelieved."""
    try:
        header = jwt.get_unverified_header(token)
    except jwt.PyJWTError as error:
        raise NotBelieved("it is no token") from error
    if header.get("alg") not in ALGORITHMS:
        raise NotBelieved("it is not signed as it should be")
    return header.get("kid")


def believe(token: str, key: jwt.PyJWK, provider: OidcProvider, nonce: str) -> Claims:
    """What a token says. Raises NotBelieved."""
    try:
        claims = jwt.decode(
            token,
            key,
            algorithms=list(ALGORITHMS),
            audience=provider.client_id,
            issuer=provider.issuer,
            leeway=LEEWAY_S,
            options={"require": ["exp", "iat", "iss", "aud", "sub"]},
        )
    except jwt.PyJWTError as error:
        raise NotBelieved(type(error).__name__) from error
    said = claims.get("nonce")
    if not isinstance(said, str) or not hmac.compare_digest(said.encode(), nonce.encode()):
        raise NotBelieved("it belongs to another sign-in")
    several = isinstance(claims["aud"], list) and len(claims["aud"]) > 1
    if (several or "azp" in claims) and claims.get("azp") != provider.client_id:
        raise NotBelieved("it was made for another client")
    return Claims(claims["sub"], _login(claims, provider), _authenticated(claims))


def _login(claims: dict[str, Any], provider: OidcProvider) -> str | None:
    login = claims.get(provider.login_claim)
    verified = provider.login_claim != "email" or claims.get("email_verified") is True
    return login if isinstance(login, str) and verified else None


def _authenticated(claims: dict[str, Any]) -> datetime | None:
    at = claims.get("auth_time")
    if isinstance(at, bool) or not isinstance(at, int | float):
        return None
    try:
        return min(datetime.fromtimestamp(at, UTC), datetime.now(UTC))
    except (OverflowError, ValueError, OSError) as error:
        raise NotBelieved("its times make no sense") from error
