import re
from http import HTTPStatus
from pathlib import Path

import pytest

from services.gateway.app import create_app
from services.gateway.settings import GatewaySettings

HEADERS = {
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; "
        "img-src 'self' data: blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'self'"
    ),
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), geolocation=(), microphone=()",
}


@pytest.mark.parametrize(
    "path",
    ["/", "/docs", "/favicon.ico", "/static/nothing.js", "/v1/health", "/v1/sessions", "/v1/nothing", "/nothing"],
)
def test_every_answer_has_the_headers(client, path):
    answer = client.get(path, follow_redirects=False)
    assert {name: answer.headers.get(name) for name in HEADERS} == HEADERS
    assert answer.headers["cache-control"] == ("no-store" if path.startswith("/v1/") else "no-cache")
    assert "server" not in answer.headers


def test_an_unexpected_error_has_the_headers_too_and_tells_nothing(client, gateway, monkeypatch):
    client._transport.raise_server_exceptions = False
    monkeypatch.setattr(gateway.live.health, "reports", lambda: 1 / 0)
    answer = client.get("/v1/health")
    assert answer.status_code == HTTPStatus.INTERNAL_SERVER_ERROR
    assert {name: answer.headers.get(name) for name in HEADERS} == HEADERS
    assert answer.headers["content-type"] == "application/problem+json"
    assert "division" not in answer.text


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/v1/nothing", HTTPStatus.NOT_FOUND),
        ("DELETE", "/v1/sessions", HTTPStatus.METHOD_NOT_ALLOWED),
        ("POST", "/v1/patients", HTTPStatus.UNPROCESSABLE_ENTITY),
    ],
)
def test_every_error_is_a_problem(client, method, path, status):
    answer = client.request(method, path)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    body = answer.json()
    assert (body["status"], body["title"]) == (status, status.phrase)
    assert body["next_step"]


def test_large_bodies_are_refused_announced_or_not(client):
    announced = client.post("/v1/patients", content=b" " * 1_000_001, headers={"content-type": "application/json"})
    pieces = (b" " * 100_000 for _ in range(11))
    unannounced = client.post("/v1/patients", content=pieces, headers={"content-type": "application/json"})
    for answer in (announced, unannounced):
        assert answer.status_code == HTTPStatus.REQUEST_ENTITY_TOO_LARGE
        assert answer.headers["content-security-policy"]


def test_only_known_host_names_are_answered(client):
    answer = client.get("/v1/health", headers={"host": "rebound.example"})
    assert answer.status_code == HTTPStatus.MISDIRECTED_REQUEST
    assert client.get("/v1/health", headers={"host": "testserver:8000"}).status_code == HTTPStatus.OK


@pytest.mark.parametrize(
    ("host", "names", "expected"),
    [
        ("127.0.0.1", None, ["127.0.0.1", "localhost", "[::1]"]),
        ("0.0.0.0", None, ["*"]),
        ("0.0.0.0", ["clinic"], ["clinic"]),
    ],
)
def test_host_names_follow_from_the_address(host, names, expected):
    assert GatewaySettings(http_host=host, http_names=names).host_names == expected


def test_no_foreign_site_is_invited(client):
    answer = client.options(
        "/v1/patients", headers={"origin": "https://elsewhere.example", "access-control-request-method": "POST"}
    )
    assert "access-control-allow-origin" not in answer.headers


def test_the_api_page_needs_no_foreign_host(client):
    pages = Path(create_app.__code__.co_filename).parent / "web"
    for name in ("docs.html", "index.html", "src/docs.js"):
        assert "http" not in (pages / name).read_text().replace("http-equiv", "")
    assert "validatorUrl: null" in (pages / "src" / "docs.js").read_text()


def test_our_own_sources_name_no_foreign_host_and_write_no_markup():
    web = Path(create_app.__code__.co_filename).parent / "web"
    sources = [path for path in web.glob("src/**/*") if path.is_file()]
    for path in [*sources, *web.glob("*.html")]:
        text = path.read_text().replace("http://www.w3.org/2000/svg", "")
        assert not re.search(r"https?://|//[a-z]+\.[a-z]", text), path.name
        assert not re.search(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(", text), path.name
