"""Talking to a gateway as somebody who has signed in: for commands that need more than the bus."""

import json
import secrets
import time
import urllib.error
import urllib.request
from http.cookiejar import CookieJar
from pathlib import Path
from typing import Any, Self

from services.gateway.accounts.first_run import code_file
from services.gateway.certificate import trusting

WORDS = (
    *("amber", "birch", "cedar", "delta", "ember", "fjord", "grove", "heron", "indigo", "juniper", "kestrel", "lagoon"),
    *(
        "maple",
        "nectar",
        "ocean",
        "poplar",
        "quartz",
        "river",
        "saffron",
        "thistle",
        "umber",
        "violet",
        "willow",
        "yarrow",
    ),
)
ACCOUNT_FILE = "demo-account"


class Door:
    """One sign-in at one gateway. `certificate`: that of a gateway that speaks TLS, which is believed alone."""

    def __init__(self, url: str, certificate: Path | None = None) -> None:
        self.url = url
        self._cookies = CookieJar()
        handlers: list[urllib.request.BaseHandler] = [urllib.request.HTTPCookieProcessor(self._cookies)]
        if certificate is not None:
            handlers.append(urllib.request.HTTPSHandler(context=trusting(certificate)))
        self._opener = urllib.request.build_opener(*handlers)

    @classmethod
    def of_first_administrator(
        cls, url: str, data_dir: Path, patience_s: float = 90.0, certificate: Path | None = None
    ) -> Self:
        """Sign in as the administrator that this made at the first run, making it when nobody has an account yet.

        The password lies in the gateway's folder, readable by its owner alone. Raises PermissionError when the accounts
        there were made by somebody else.
        """
        door = cls(url, certificate)
        state = door.until_answered(patience_s)
        file = data_dir / ACCOUNT_FILE
        if state["first_run"]:
            login, password = "demo", "-".join(secrets.choice(WORDS) for _ in range(4))
            code = code_file(data_dir).read_text(encoding="utf-8").strip()
            door.ask("first-run", {"code": code, "login": login, "password": password})
            file.touch(mode=0o600)
            file.write_text(f"{login} {password}\n", encoding="utf-8")
        elif file.exists():
            login, password = file.read_text(encoding="utf-8").split()
            door.ask("sign-in", {"login": login, "password": password})
        else:
            raise PermissionError(f"the gateway at {url} has accounts already; sign in with one of them")
        return door

    def until_answered(self, patience_s: float) -> Any:
        """Wait for the first answer: a service may be on the bus before its port is open. Raises URLError."""
        end = time.monotonic() + patience_s
        while True:
            try:
                return self.ask("sign-in")
            except urllib.error.HTTPError:
                raise
            except urllib.error.URLError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.1)

    def ask(self, path: str, body: dict[str, Any] | None = None, method: str | None = None) -> Any:
        """The JSON answer of a route below /v1; None when there is none. Raises HTTPError, URLError."""
        text = self.read(path, body, method)
        return json.loads(text) if text else None

    def read(self, path: str, body: dict[str, Any] | None = None, method: str | None = None) -> bytes:
        """The bytes of an answer."""
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(
            f"{self.url}/v1/{path}", data, {"Content-Type": "application/json"}, method=method
        )
        with self._opener.open(request, timeout=60) as answer:
            return bytes(answer.read())

    @property
    def cookie(self) -> tuple[str, str]:
        """Name and value of the sign-in, to be given to a browser."""
        cookie = next(iter(self._cookies))
        return cookie.name, cookie.value or ""
