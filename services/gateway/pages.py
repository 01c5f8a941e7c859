"""The web pages: files that the bundler wrote. No other host is ever asked for anything."""

import os
import re
from http import HTTPStatus
from pathlib import Path

from fastapi import FastAPI
from fastapi.responses import FileResponse, RedirectResponse, Response
from starlette.middleware.gzip import GZipMiddleware
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from services.gateway.access.rules import OPEN_TO_ALL
from services.gateway.problems import problem_response

NAMED_BY_CONTENT = re.compile(r"-[A-Z0-9]{8}\.(js|css)$")
"""How the bundler names a file whose content is part of its name: it never changes."""

FOREVER = "public, max-age=31536000, immutable"
ASK_AGAIN = "no-cache"


class Assets(StaticFiles):
    """Files of the pages. What is named by its content is kept by browsers, the rest is asked for again each time."""

    def file_response(
        self, full_path: str | os.PathLike[str], stat_result: os.stat_result, scope: Scope, status_code: int = 200
    ) -> Response:
        """The file, and how long it may be kept."""
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["Cache-Control"] = FOREVER if NAMED_BY_CONTENT.search(str(full_path)) else ASK_AGAIN
        return response


def install(app: FastAPI, pages_dir: Path) -> None:
    """Serve the first page, the API page, the icon and the assets."""

    def page(name: str) -> Response:
        path = pages_dir / name
        if path.exists():
            return FileResponse(path, headers={"Cache-Control": ASK_AGAIN})
        return problem_response(
            HTTPStatus.SERVICE_UNAVAILABLE,
            "The web pages are not built.",
            "Run `make web`; the API at /v1 works without.",
        )

    @app.get("/", include_in_schema=False, dependencies=OPEN_TO_ALL)
    def first_page() -> Response:
        return page("index.html")

    @app.get("/docs", include_in_schema=False, dependencies=OPEN_TO_ALL)
    def api_page() -> Response:
        return page("docs.html")

    @app.get("/favicon.ico", include_in_schema=False, dependencies=OPEN_TO_ALL)
    def icon() -> Response:
        return RedirectResponse("/static/favicon.svg", HTTPStatus.MOVED_PERMANENTLY)

    # Nothing secret is in these files, so squeezing them tells nobody anything; the API is never squeezed.
    assets = Assets(directory=pages_dir, check_dir=False)
    app.mount("/static", GZipMiddleware(assets, minimum_size=1000), name="static")
