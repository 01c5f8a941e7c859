"""`ambula report`: the report of a stored session as a file, from a gateway that runs."""

import http.client
import json
import os
import urllib.error
import urllib.parse
import urllib.request
from http import HTTPStatus
from pathlib import Path
from typing import Annotated

import typer

from services.cli.console import out, told
from services.report.content import Language

TIMEOUT_S = 30.0
FORMS = {".pdf": "report.pdf", ".html": "report.html", ".json": "report"}
"""What a file's ending asks for."""


class ReportRefused(Exception):
    """The gateway gave no report; says why and what to do."""


KEY_VARIABLE = "AMBULA_KEY"
"""A key of the gateway, as an administrator makes it; never an argument, which other users of the machine can see."""


def report(
    session: Annotated[str, typer.Argument(metavar="SESSION", help="id of a stored session")],
    file: Annotated[Path, typer.Option("--out", help=f"file to write; its ending chooses: {', '.join(FORMS)}")],
    language: Annotated[Language, typer.Option(help="language of the report")] = Language.ENGLISH,
    url: Annotated[str, typer.Option(help="where the gateway answers")] = "http://127.0.0.1:8000",
) -> None:
    """Write the report of a session as PDF, as one page of HTML or as its content. AMBULA_KEY holds a key."""
    with told(ReportRefused, OSError):
        if file.suffix not in FORMS:
            raise ReportRefused(f"{file}: the ending must be one of {', '.join(FORMS)}")
        name = urllib.parse.quote(session, safe="")
        body = _fetched(f"{url.rstrip('/')}/v1/sessions/{name}/{FORMS[file.suffix]}?language={language}")
        part = file.with_name(f"{file.name}.part")
        part.write_bytes(body)
        os.replace(part, file)
    out.print(f"written: {file}, {len(body)} bytes", soft_wrap=True, highlight=False)


def _fetched(url: str) -> bytes:
    if not url.startswith(("http://", "https://")):
        raise ReportRefused(f"{url}: the gateway's address begins with http:// or https://")
    try:
        key = os.environ.get(KEY_VARIABLE)
        request = urllib.request.Request(url, headers={"Authorization": f"Bearer {key}"} if key else {})
        with urllib.request.urlopen(request, timeout=TIMEOUT_S) as answer:
            body = answer.read()
            assert isinstance(body, bytes)
            return body
    except urllib.error.HTTPError as error:
        raise ReportRefused(_reason(error)) from error
    except (urllib.error.URLError, http.client.HTTPException) as error:
        raise ReportRefused(f"no gateway answers at {url}: start it with `ambula up`, or name it by --url") from error


def _reason(error: urllib.error.HTTPError) -> str:
    try:
        problem = json.loads(error.read())
        return f"{problem['detail']} {problem['next_step']}"
    except (ValueError, KeyError, TypeError):
        return f"the gateway answered {error.code} {HTTPStatus(error.code).phrase}"
