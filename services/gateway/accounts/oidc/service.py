"""One sign-in service: where its parts are, its keys, and what it says of whoever comes back from it."""

import base64
import hashlib
import threading
import time
import urllib.parse
from typing import Any

import jwt

from services.gateway.accounts.oidc.fetching import Unreachable, fetch
from services.gateway.accounts.oidc.settings import OidcProvider
from services.gateway.accounts.oidc.tokens import Claims, NotBelieved, believe, key_id

DISCOVERY = "/.well-known/openid-configuration"
FRESH_S = 3600.0
KEYS_EVERY_S = 60.0
"""A token may name any key; the service is not asked for its keys more often than this because of it."""

MOST_AT_ONCE = 4
"""Threads that may wait for one service; others are for everybody else's requests."""


class OidcService:
    """Used from many threads; every public method but `address` may block for seconds and raises Unreachable."""

    def __init__(self, provider: OidcProvider) -> None:
        self.provider = provider
        self._places = threading.BoundedSemaphore(MOST_AT_ONCE)
        self._discovered: tuple[float, dict[str, Any]] | None = None
        self._keys: tuple[float, dict[str | None, jwt.PyJWK]] | None = None

    def address(self, state: str, nonce: str, verifier: str, back: str, *, again: bool) -> str:
        """Where to send a browser. `again`: have the password asked for, even of somebody who is signed in there."""
        asked = {
            "response_type": "code",
            "client_id": self.provider.client_id,
            "redirect_uri": back,
            "scope": " ".join(dict.fromkeys(("openid", *self.provider.scopes))),
            "state": state,
            "nonce": nonce,
            "code_challenge": _challenge(verifier),
            "code_challenge_method": "S256",
        }
        if again:
            asked |= {"prompt": "login", "max_age": "0"}
        entrance = self._part("authorization_endpoint")
        return f"{entrance}{'&' if '?' in entrance else '?'}{urllib.parse.urlencode(asked)}"

    def claims(self, code: str, nonce: str, verifier: str, back: str) -> Claims:
        """What the service says for a code. Raises NotBelieved."""
        form = {"grant_type": "authorization_code", "code": code, "redirect_uri": back, "code_verifier": verifier}
        headers = self._authenticate(form)
        token = self._ask(self._part("token_endpoint"), form, headers).get("id_token")
        if not isinstance(token, str):
            raise NotBelieved("there is no id token")
        return believe(token, self._key(key_id(token)), self.provider, nonce)

    def _authenticate(self, form: dict[str, str]) -> dict[str, str]:
        if self.provider.client_secret is None:
            form["client_id"] = self.provider.client_id
            return {}
        name, secret = self.provider.client_id, self.provider.client_secret.get_secret_value()
        ways = self._discovery().get("token_endpoint_auth_methods_supported", ["client_secret_basic"])
        if "client_secret_basic" not in ways:
            form |= {"client_id": name, "client_secret": secret}
            return {}
        both = f"{urllib.parse.quote(name, safe='')}:{urllib.parse.quote(secret, safe='')}"
        return {"Authorization": f"Basic {base64.b64encode(both.encode()).decode()}"}

    def _part(self, name: str) -> str:
        address = self._discovery().get(name)
        if not isinstance(address, str):
            raise Unreachable(f"the service names no {name}")
        return address

    def _discovery(self) -> dict[str, Any]:
        now = time.monotonic()
        if self._discovered is None or now - self._discovered[0] > FRESH_S:
            document = self._ask(self.provider.issuer.rstrip("/") + DISCOVERY)
            if document.get("issuer") != self.provider.issuer:
                raise Unreachable("the service calls itself otherwise than AMBULA_OIDC does")
            self._discovered = now, document
        return self._discovered[1]

    def _key(self, name: str | None) -> jwt.PyJWK:
        now = time.monotonic()
        if self._keys is None or (name not in self._keys[1] and now - self._keys[0] > KEYS_EVERY_S):
            self._keys = now, self._fetch_keys()
        known = self._keys[1]
        if name is None and len(known) == 1:
            return next(iter(known.values()))
        if name not in known:
            raise NotBelieved("it is signed with a key that the service does not have")
        return known[name]

    def _fetch_keys(self) -> dict[str | None, jwt.PyJWK]:
        try:
            found = jwt.PyJWKSet.from_dict(self._ask(self._part("jwks_uri"))).keys
        except jwt.PyJWTError as error:
            raise Unreachable("the service has no keys that can be used") from error
        return {key.key_id: key for key in found if key.public_key_use in (None, "sig")}

    def _ask(
        self, url: str, form: dict[str, str] | None = None, headers: dict[str, str] | None = None
    ) -> dict[str, Any]:
        if not self._places.acquire(blocking=False):
            raise Unreachable("too many wait for the service")
        try:
            return fetch(url, form, headers)
        finally:
            self._places.release()


def _challenge(verifier: str) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(verifier.encode()).digest()).decode().rstrip("=")
