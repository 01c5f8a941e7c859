"""The patients of the demo: made once, with names, and the gateway is waited for."""

import urllib.error
from email.message import Message
from pathlib import Path

import pytest

from services.cli import demo, picture_visits
from services.gateway.settings import GatewaySettings


class FakeDoor:
    """A gateway that has not heard of sessions yet the first time it is asked about them."""

    def __init__(self, patients=0, fault=None):
        self.patients, self.fault, self.asked, self.known = patients, fault, [], set()

    def ask(self, path, body=None, method=None):
        if self.fault is not None:
            raise self.fault
        self.asked.append((method, path, body))
        if path == "patients" and body is None:
            return {"total": self.patients}
        if path == "patients":
            self.patients += 1
            return {"code": f"P{self.patients}"}
        if path.startswith("sessions/") and path not in self.known:
            self.known.add(path)
            raise urllib.error.HTTPError(path, 404, "Not Found", Message(), None)
        return None


@pytest.fixture
def visited(monkeypatch):
    """What the visits were asked for with."""
    asked = []

    def visits(_door, data, patience_s, **options):
        asked.append((data, patience_s, options))
        return picture_visits.Shown("P9", ["a", "b"])

    monkeypatch.setattr(picture_visits, "visits", visits)
    monkeypatch.setattr("time.sleep", lambda _s: None)
    return asked


def test_sessions_get_patients_with_names_and_one_patient_gets_visits(visited):
    door, settings = FakeDoor(), GatewaySettings(data_dir=Path("there"), database="")
    demo._fill(door, settings, ["s1", "s2"])
    named = {path: body["name"] for method, path, body in door.asked if method == "PUT"}
    assert named == {"patients/P1/name": demo.NAMES[0], "patients/P2/name": demo.NAMES[1]}
    linked = [(path, body["patient"]) for method, path, body in door.asked if method == "PATCH"]
    assert linked == [("sessions/s1", "P1"), ("sessions/s1", "P1"), ("sessions/s2", "P2"), ("sessions/s2", "P2")]
    ((data, _, options),) = visited
    assert data == Path("there")
    assert options == {"pace": demo.VISITS_PACE, "database": settings.database_url, "name": demo.VISITS_NAME}


def test_a_second_demo_makes_nobody_again(visited):
    door = FakeDoor(patients=4)
    demo._fill(door, GatewaySettings(database=""), ["s1"])
    assert door.asked == [(None, "patients", None)]
    assert visited == []


def test_a_gateway_that_is_stopped_meanwhile_is_said_in_a_line(visited, capsys):
    demo._fill(FakeDoor(fault=urllib.error.URLError("refused")), GatewaySettings(database=""), ["s1"])
    assert "not complete" in capsys.readouterr().err
