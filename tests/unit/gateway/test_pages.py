import gzip
import json
import re
from http import HTTPStatus

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from services.gateway.pages import install
from services.gateway.settings import DIST

built = pytest.mark.skipif(not (DIST / "index.html").exists(), reason="the pages are not built: run `make web`")


def test_pages_and_assets_are_served(client):
    assert "<title>Ambula" in client.get("/").text
    assert client.get("/static/index.html").status_code == HTTPStatus.OK


def test_without_built_pages_the_api_works_and_the_page_says_what_to_do(client, settings):
    (settings.pages_dir / "index.html").unlink()
    answer = client.get("/")
    assert answer.status_code == HTTPStatus.SERVICE_UNAVAILABLE
    assert "make web" in answer.json()["next_step"]
    health = client.get("/v1/health")
    assert (health.status_code, health.json()["pages"]) == (HTTPStatus.OK, False)


@pytest.mark.parametrize("path", ["/static/../settings.py", "/static/%2e%2e/settings.py", "/static//etc/passwd"])
def test_assets_stay_in_their_folder(client, path):
    assert client.get(path).status_code == HTTPStatus.NOT_FOUND


@built
def test_built_pages_point_to_nothing_outside():
    namespaces = re.compile(r"http://www\.w3\.org/(1999/xhtml|2000/svg|1999/xlink)")
    files = [*DIST.glob("*.html"), *DIST.glob("favicon.svg"), *DIST.glob("*-*.css"), *DIST.glob("*-????????.js")]
    chunks = list(DIST.glob("chunks/*.js"))
    assert len(files) >= 7
    assert len(chunks) >= 5
    for file in (*files, *chunks):
        name = file.name
        text = namespaces.sub("", file.read_text())
        # Messages of the drawing library may name its manual; nothing may be loaded from anywhere.
        assert not re.search(r"""(src|href|url|import|fetch|WebSocket|@import)\s*[=(]?\s*["'(]\s*https?:""", text), name
        if file in files:
            assert "http" not in text, name


@built
def test_every_asset_that_a_page_names_exists():
    for page in ("index.html", "docs.html"):
        for name in re.findall(r'"/static/([^"]+)"', (DIST / page).read_text()):
            assert (DIST / name).exists(), name


@built
def test_what_is_named_by_its_content_is_kept_and_the_rest_is_asked_for_again():
    names = json.loads((DIST / "names.json").read_text())
    chunk = next(DIST.glob("chunks/*.js")).relative_to(DIST)
    app = FastAPI(docs_url=None)
    install(app, DIST)
    client = TestClient(app)
    for name in (names["main.js"], names["style.css"], chunk):
        answer = client.get(f"/static/{name}")
        assert "immutable" in answer.headers["Cache-Control"], name
    for path in ("/", "/docs", "/static/favicon.svg", "/static/swagger-ui.css"):
        assert client.get(path).headers["Cache-Control"] == "no-cache", path
    assert client.get(f"/static/{names['style.css']}").headers["Content-Encoding"] == "gzip"


@built
def test_first_load_is_small():
    page = (DIST / "index.html").read_text()
    asked = [DIST / name for name in re.findall(r'"/static/([^"]+)"', page)]
    assert len(asked) >= 4
    assert sum(len(gzip.compress(file.read_bytes())) for file in asked) < 60_000


@built
def test_licences_of_what_is_bundled_come_along():
    text = (DIST / "LICENSES.txt").read_text()
    assert all(name in text for name in ("three 0.", "uplot 1.", "swagger-ui-dist 5."))


def test_locked_packages_carry_hashes_and_no_addresses():
    lock = json.loads((DIST.parents[1] / "web" / "package-lock.json").read_text())
    packages = {name: entry for name, entry in lock["packages"].items() if name}
    assert packages
    for name, entry in packages.items():
        assert "resolved" not in entry, name
        assert entry["integrity"].startswith("sha512-"), name
