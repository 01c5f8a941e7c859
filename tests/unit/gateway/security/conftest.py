"""One site for all tests of a file: making it takes longer than asking it."""

import pytest
from fastapi.testclient import TestClient

from tests.unit.gateway.security.site import Site


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site and a client that holds no cookies: each request brings its caller's headers."""
    made = Site(tmp_path_factory.mktemp("site"))
    with TestClient(made.app, raise_server_exceptions=False) as client:
        made.prepare(client)
        yield made
