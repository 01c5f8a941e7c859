"""The page over TLS, with a certificate made here: nothing without it, cookies and browsers kept to it."""

import http.client
import json
import ssl
import threading
import time
import urllib.error
from datetime import UTC, datetime

import pytest
import uvicorn
from websockets.sync.client import connect

from services.cli.door import Door
from services.gateway.app import create_app, first_run_code
from services.gateway.certificate import CertificateError, read_pair, trusting
from services.gateway.serve import config_of
from services.gateway.settings import GatewaySettings

NOW = datetime.now(UTC)


@pytest.fixture
def served(settings, hub, control, make_pair):
    """A gateway that speaks TLS: its settings with the port it has, and the application."""
    certificate, key = make_pair()
    secure = settings.model_copy(
        update={"http_port": 0, "http_certificate": certificate, "http_key": key, "http_names": ["127.0.0.1"]}
    )
    app = create_app(secure, hub, control)
    server = uvicorn.Server(config_of(app, secure, hub.parameters))
    thread = threading.Thread(target=server.run)
    thread.start()
    end = time.monotonic() + 20.0
    while not server.started:
        assert time.monotonic() < end
        time.sleep(0.01)
    port = server.servers[0].sockets[0].getsockname()[1]
    yield secure.model_copy(update={"http_port": port}), app
    server.should_exit = True
    thread.join(20.0)


def test_the_page_over_tls(served):
    settings, app = served
    assert settings.url.startswith("https://127.0.0.1:")
    first_run_code(app)
    door = Door.of_first_administrator(settings.url, settings.own_dir, certificate=settings.http_certificate)
    assert door.ask("me")["login"] == "demo"
    name, value = door.cookie
    assert name == "__Host-ambula"
    assert next(iter(door._cookies)).secure

    context = trusting(settings.http_certificate)
    plain = http.client.HTTPSConnection("127.0.0.1", settings.http_port, context=context, timeout=10)
    plain.request("POST", "/v1/sign-in", body="{}", headers={"Content-Type": "application/json"})
    assert plain.getresponse().getheader("Strict-Transport-Security") == "max-age=31536000"
    plain.close()

    address = f"wss://127.0.0.1:{settings.http_port}/v1/live"
    with connect(address, ssl=context, additional_headers={"Cookie": f"{name}={value}"}) as socket:
        assert json.loads(socket.recv(10.0))["kind"] == "floor"


def test_nobody_gets_in_without_tls_or_with_another_certificate(served, make_pair):
    settings, _ = served
    with pytest.raises((urllib.error.URLError, ConnectionError, http.client.HTTPException)):
        Door(settings.url.replace("https", "http")).ask("sign-in")
    with pytest.raises(urllib.error.URLError, match="CERTIFICATE_VERIFY_FAILED"):
        Door(settings.url).ask("sign-in")
    with pytest.raises(urllib.error.URLError, match="CERTIFICATE_VERIFY_FAILED"):
        Door(settings.url, make_pair()[0]).ask("sign-in")
    old = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    old.check_hostname, old.verify_mode = False, ssl.CERT_NONE
    with pytest.warns(DeprecationWarning, match="TLSv1_1"):
        old.maximum_version = ssl.TLSVersion.TLSv1_1
    connection = http.client.HTTPSConnection("127.0.0.1", settings.http_port, context=old, timeout=10)
    with pytest.raises(ssl.SSLError):
        connection.request("GET", "/")


def test_without_tls_browsers_are_told_nothing_of_it(client):
    assert "Strict-Transport-Security" not in client.get("/v1/me").headers


def test_a_certificate_tells_its_days_and_names(make_pair):
    told = read_pair(*make_pair(days=20, name="gait.example"))
    assert told.names == ("gait.example",)
    assert told.days_left(NOW) == pytest.approx(20.0, abs=0.01)
    assert read_pair(*make_pair(days=-1)).days_left(NOW) < 0


def test_what_cannot_be_used_is_said_with_what_to_do(make_pair, tmp_path):
    certificate, key = make_pair()
    with pytest.raises(CertificateError, match=r"cannot be used together.*AMBULA_HTTP_KEY"):
        read_pair(certificate, make_pair()[1])
    with pytest.raises(CertificateError, match=r"nowhere\.pem is not there"):
        read_pair(certificate, tmp_path / "nowhere.pem")
    with pytest.raises(CertificateError, match="encrypted"):
        read_pair(*make_pair(password=b"secret"))
    with pytest.raises(CertificateError):
        read_pair(key, key)
    with pytest.raises(ValueError, match="belong together"):
        GatewaySettings(http_certificate=certificate)
