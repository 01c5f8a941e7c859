"""The web pages: files that the bundler wrote. No other host is ever asked for anything."""

from http import HTTPStatus
from pathlib import Path

from fastapi import FastAPI
from fastapi.responses import FileResponse, RedirectResponse, Response
from starlette.staticfiles import StaticFiles

from services.gateway.access.rules import OPEN_TO_ALL
from services.gateway.problems import problem_response


def install(app: FastAPI, pages_dir: Path) -> None:
    """Serve the first page, the API page, the icon and the assets."""

    def page(name: str) -> Response:
        path = pages_dir / name
        if path.exists():
            return FileResponse(path)
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

    app.mount("/static", StaticFiles(directory=pages_dir, check_dir=False), name="static")
