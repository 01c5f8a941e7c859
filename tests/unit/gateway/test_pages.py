import json
import re
from http import HTTPStatus

import pytest

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
    for name in ("index.html", "docs.html", "style.css", "docs.js", "favicon.svg", "main.js"):
        text = namespaces.sub("", (DIST / name).read_text())
        # Messages of the drawing library may name its manual; nothing may be loaded from anywhere.
        assert not re.search(r"""(src|href|url|import|fetch|WebSocket|@import)\s*[=(]?\s*["'(]\s*https?:""", text), name
        if name != "main.js":
            assert "http" not in text, name


@built
def test_every_asset_that_a_page_names_exists():
    for page in ("index.html", "docs.html"):
        for name in re.findall(r'"/static/([^"]+)"', (DIST / page).read_text()):
            assert (DIST / name).exists(), name


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
