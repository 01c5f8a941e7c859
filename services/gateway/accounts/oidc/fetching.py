"""Asking a sign-in service: bounded in time and size, no redirects, nothing in clear over a network."""

import json
import time
import urllib.error
import urllib.parse
import urllib.request
from typing import Any

from services.gateway.accounts.oidc.settings import is_safe

ANSWER_S = 5.0
WHOLE_S = 10.0
MOST_BYTES = 500_000
PIECE_BYTES = 65_536


class Unreachable(Exception):
    """The service did not answer as it should. The message says what, never what was sent."""


class _NoRedirects(urllib.request.HTTPRedirectHandler):
    def redirect_request(self, *_: Any) -> None:
        """Nowhere: where to ask is the site's decision."""


_OPENER = urllib.request.build_opener(_NoRedirects)


def fetch(url: str, form: dict[str, str] | None = None, headers: dict[str, str] | None = None) -> dict[str, Any]:
    """The JSON object at an address; with a form, what it answers to that. Blocks for 10 s at most.

    Raises Unreachable.
    """
    if not is_safe(url):
        raise Unreachable("an address of the service is neither https nor on this machine")
    data = None if form is None else urllib.parse.urlencode(form).encode()
    request = urllib.request.Request(url, data, {"Accept": "application/json", **(headers or {})})
    try:
        with _OPENER.open(request, timeout=ANSWER_S) as answer:
            document = json.loads(_read(answer))
    except urllib.error.HTTPError as error:
        error.close()
        raise Unreachable(f"the service answered {error.code}") from error
    except (OSError, ValueError) as error:
        raise Unreachable(f"the service did not answer: {type(error).__name__}") from error
    if not isinstance(document, dict):
        raise Unreachable("the service answered with something else than a JSON object")
    return document


def _read(answer: Any) -> bytes:
    end, text = time.monotonic() + WHOLE_S, b""
    while piece := answer.read1(PIECE_BYTES):
        text += piece
        if len(text) > MOST_BYTES:
            raise ValueError("too long")
        if time.monotonic() > end:
            raise TimeoutError
    return text
