"""What live pages are told of trouble: samples lost on the way, and a recording that has stopped."""

import json

import pytest

from schemas.health import Health, Reason, Rejection, SessionHealth
from schemas.quality import DataQuality, SourceQuality
from services.gateway.health.board import HealthBoard


def quality_at(at_s: int, used: int, rejected: int = 0) -> DataQuality:
    """One sensor at 100 Hz."""
    source = SourceQuality(
        name="imu_pelvis", expected=100 * at_s, used=used, rejected=rejected, longest_silence_s=0.1, misplaced=False
    )
    return DataQuality(
        captured_ns=at_s * 10**9, sources=[source], calibrated=True, absolute=True, spanned_s=0.0, estimated_s=0.0,
        moving_s=0.0, locked_s=0.0, late=0,
    )  # fmt: skip


def told(socket) -> dict:
    while True:
        message = json.loads(socket.receive_text())
        if message["kind"] == "data_quality":
            return message


def test_losses_are_those_of_the_last_ten_seconds(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    with client.websocket_connect("/v1/live/a") as socket:
        for quality in (quality_at(5, 500), quality_at(10, 1000), quality_at(15, 1400, rejected=50)):
            hub.measure("a", quality)
        first, second, third = (told(socket) for _ in range(3))
    assert (first["since_s"], first["at_s"]) == (0.0, 5.0)
    assert (second["since_s"], second["at_s"]) == (5.0, 10.0)
    assert second["sources"] == [{"name": "imu_pelvis", "lost": 0.0, "refused": 0.0}]
    assert (third["since_s"], third["at_s"]) == (5.0, 15.0)
    assert third["sources"] == [{"name": "imu_pelvis", "lost": 0.05, "refused": 0.05}]


def test_a_sensor_that_has_told_nothing_yet_has_no_losses(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    with client.websocket_connect("/v1/live/a") as socket:
        hub.measure("a", quality_at(0, 0))
        assert told(socket)["sources"] == [{"name": "imu_pelvis", "lost": None, "refused": None}]


def test_a_late_viewer_hears_of_losses_at_once(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    hub.measure("a", quality_at(5, 450))
    with client.websocket_connect("/v1/live/a") as socket:
        assert told(socket)["sources"][0]["lost"] == pytest.approx(0.1)


def archive(*, low: bool, waits: bool) -> Health:
    disk = [Rejection(subject="disk", reason=Reason.DISK_LOW, count=1)]
    waiting = [Rejection(subject="a", reason=Reason.NOT_RECORDED, count=1)]
    session = SessionHealth(session="a", captured_ns=0, inputs=[], rejections=waiting if waits else [])
    return Health(
        service="archive", instance="i", uptime_s=1, cpu_s=1, rss_bytes=1, queue_length=0, queue_capacity=1,
        queue_dropped=0, errors=0, rejections=disk if low else [], sessions=[session],
        readiness="ready",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("low", "waits", "found"),
    [(False, False, None), (True, False, None), (True, True, "disk"), (False, True, "refused")],
)
def test_why_nothing_is_recorded_is_known_from_the_archive(low, waits, found):
    board = HealthBoard(stale_s=3.0, clock=lambda: 10.0)
    board.record(archive(low=low, waits=waits))
    assert board.recording_stopped("a") == found
    assert board.recording_stopped("b") is None


def test_an_archive_that_is_silent_says_nothing_of_its_recordings():
    now = [10.0]
    board = HealthBoard(stale_s=3.0, clock=lambda: now[0])
    board.record(archive(low=True, waits=True))
    now[0] = 14.0
    assert board.recording_stopped("a") is None


def test_cards_and_sessions_say_that_recording_has_stopped(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    hub.health.record(archive(low=True, waits=True))
    with client.websocket_connect("/v1/live") as socket:
        assert json.loads(socket.receive_text())["sessions"][0]["recording_stopped"] == "disk"
    with client.websocket_connect("/v1/live/a") as socket:
        status = next(message for _ in range(20) if (message := json.loads(socket.receive_text()))["kind"] == "status")
    assert status["recording_stopped"] == "disk"
