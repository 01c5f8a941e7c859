"""What stands behind `device:`, and in the environment."""

import pytest
from pydantic import ValidationError

from services.ingest.capture.options import CaptureOptions
from services.ingest.capture.settings import CaptureSettings
from services.ingest.errors import SourceError
from services.ingest.source import open_source


def test_options():
    assert CaptureOptions.parse("") == CaptureOptions(7788, None, None)
    assert CaptureOptions.parse("port=7790&height=1.71&duration=60") == CaptureOptions(7790, 1.71, 60.0)
    assert isinstance(CaptureOptions.parse("port=7790").port, int)


@pytest.mark.parametrize(
    ("spec", "word"),
    [
        ("device:", "device:kinect"),
        ("device:webcam", "device:kinect"),
        ("device:kinect?port=0", "1 to 65535"),
        ("device:kinect?port=70000", "1 to 65535"),
        ("device:kinect?port=7788.5", "1 to 65535"),
        ("device:kinect?port=nan", "1 to 65535"),
        ("device:kinect?port=abc", "1 to 65535"),
        ("device:kinect?height=171", "0.5 to 2.5"),
        ("device:kinect?colour=red", "port, height, duration"),
        ("device:kinect?port", "no list of options"),
    ],
)
def test_bad_options_are_refused(spec, word):
    with pytest.raises(SourceError, match=word):
        open_source(spec)


def test_nobody_from_outside_is_heard_by_default(monkeypatch):
    for name in ("HOST", "PORTS", "SENDERS"):
        monkeypatch.delenv(f"AMBULA_SKELETON_{name}", raising=False)
    settings = CaptureSettings()
    assert (settings.skeleton_host, settings.skeleton_ports) == ("127.0.0.1", [7788])
    assert not settings.are_ports_chosen
    assert not settings.is_open_to_all
    assert settings.may_send("127.0.0.1")


def test_the_environment(monkeypatch):
    monkeypatch.setenv("AMBULA_SKELETON_HOST", "192.168.7.2")
    monkeypatch.setenv("AMBULA_SKELETON_PORTS", "[7001, 7002]")
    assert CaptureSettings().is_open_to_all
    monkeypatch.setenv("AMBULA_SKELETON_SENDERS", '["192.168.7.20", "10.0.3.0/24", "fe80::/10"]')
    settings = CaptureSettings()
    assert settings.are_ports_chosen
    assert not settings.is_open_to_all
    assert [settings.may_send(each) for each in ("192.168.7.20", "10.0.3.9", "fe80::1%eth0")] == [True] * 3
    assert [settings.may_send(each) for each in ("192.168.7.21", "10.0.4.1", "127.0.0.1", "::1")] == [False] * 4


@pytest.mark.parametrize(
    ("name", "value"),
    [("PORTS", "[0]"), ("PORTS", "[70000]"), ("SENDERS", '["capture-pc"]'), ("SENDERS", '["1.2.3.4/8"]')],
)
def test_a_wrong_environment_is_told_at_once(monkeypatch, name, value):
    monkeypatch.setenv(f"AMBULA_SKELETON_{name}", value)
    with pytest.raises(ValidationError):
        CaptureSettings()
