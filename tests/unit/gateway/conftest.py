"""A gateway without a bus: the real hub, keeper and database, and a control that plays the ingest."""

from dataclasses import dataclass, field
from types import SimpleNamespace

import pytest
from fastapi.testclient import TestClient

from schemas.session import SessionDescription
from services.gateway.access.roles import Role
from services.gateway.app import create_app
from services.gateway.control import ControlRefused, Source, StartRequest
from services.gateway.live.hub import LiveHub
from services.gateway.settings import GatewaySettings
from tests.unit.gateway import people
from tests.unit.gateway.walk import contact_at, describe, metrics_at, pose_at, stride_at

CAMERA = "device:kinect?port=7788"


@dataclass
class FakeControl:
    """Says yes, unless told otherwise."""

    started: list[StartRequest] = field(default_factory=list)
    stopped: list[str] = field(default_factory=list)
    marked: list[tuple[str, float, float | None]] = field(default_factory=list)
    erased: list[str] = field(default_factory=list)
    trouble: Exception | None = None

    def erase(self, sessions: list[str]) -> list[str]:
        self._fail()
        self.erased += sessions
        return sessions

    def start(self, request: StartRequest) -> SessionDescription:
        self._fail()
        self.started.append(request)
        return describe(request.session, title="Synthetic walk")

    def stop(self, session: str) -> None:
        self._fail()
        if session not in [request.session for request in self.started]:
            raise ControlRefused(f"session {session} does not run here")
        self.stopped.append(session)

    def mark(self, session: str, last_s: float, at_s: float | None) -> tuple[float, float]:
        self._fail()
        if session not in [request.session for request in self.started]:
            raise ControlRefused(f"session {session} does not run here")
        self.marked.append((session, last_s, at_s))
        return 9.4, 9.4 + last_s

    def offered(self) -> list[Source]:
        self._fail()
        camera = Source(CAMERA, "Kinect on port 7788", "device", None, "camera")
        return [camera, Source("some_walk", "A recorded walk", "recording", 49.0)]

    def _fail(self) -> None:
        if self.trouble is not None:
            raise self.trouble


@pytest.fixture
def made() -> SimpleNamespace:
    """Makers of descriptions and messages of one made-up walk."""
    makers = (describe, pose_at, contact_at, stride_at, metrics_at)
    return SimpleNamespace(**{maker.__name__: maker for maker in makers})


@pytest.fixture
def control():
    return FakeControl()


@pytest.fixture
def settings(tmp_path):
    pages = tmp_path / "pages"
    pages.mkdir()
    (pages / "index.html").write_text("<!doctype html><title>Ambula</title>")
    return GatewaySettings(
        data_dir=tmp_path / "recordings", pages_dir=pages, database=f"sqlite:///{tmp_path}/gateway.sqlite",
        http_names=["testserver"],
    )  # fmt: skip


@pytest.fixture
def hub():
    return LiveHub()


@pytest.fixture
def stranger(settings, hub, control):
    """A browser that has not signed in."""
    with TestClient(create_app(settings, hub, control)) as client:
        yield client


@pytest.fixture
def client(stranger):
    """A browser of an administrator of the first clinic."""
    people.sign_in(stranger, Role.ADMIN)
    return stranger


@pytest.fixture
def gateway(stranger):
    return stranger.app.state.gateway
