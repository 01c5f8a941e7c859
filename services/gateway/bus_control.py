"""Control over the bus: commands that an ingest answers."""

import json
from typing import Any

from schemas.session import SessionDescription
from schemas.signals import command_key
from schemas.vocabulary import Task
from services.bus.connection import RemoteError
from services.gateway.bus_feed import BusLink
from services.gateway.control import ControlRefused, ControlUnavailable, Source, StartRequest, Worn

START_TIMEOUT_S = 8.0
"""Opening a long recording takes seconds."""
START_TRIES = 3
"""An answer may get lost; the session's id says that it is the same order."""
TIMEOUT_S = 3.0
ERASE_TIMEOUT_S = 30.0
"""A file that is being closed is waited for."""


class BusControl:
    """See `services.gateway.control.Control`."""

    def __init__(self, link: BusLink) -> None:
        self._link = link

    def start(self, request: StartRequest) -> SessionDescription:
        """Ask an ingest to run a source."""
        order = {
            "session": request.session,
            "source": request.source,
            "speed": request.speed,
            "estimator": request.estimator,
            "walk_path": request.walk_path,
            "known_rhythms": None
            if request.known_rhythms is None
            else [known.model_dump(mode="json") for known in request.known_rhythms],
            "task": request.task,
            "walkway_m": request.walkway_m,
            "conditions": None if request.conditions is None else request.conditions.model_dump(mode="json"),
        }
        try:
            return SessionDescription.model_validate(self._order("start", order, START_TIMEOUT_S, tries=START_TRIES))
        except ValueError as error:
            raise ControlRefused(f"the ingest answered with something else than a session: {error}") from error

    def stop(self, session: str) -> None:
        """Ask the ingest that runs the session to end it."""
        self._order("stop", {"session": session}, TIMEOUT_S)

    def mark(self, session: str, last_s: float, at_s: float | None) -> tuple[float, float]:
        """Ask the ingest that runs the session to put the mark among its samples."""
        answer = self._order("mark", {"session": session, "last_s": last_s, "at_s": at_s}, TIMEOUT_S)
        return float(answer["from_s"]), float(answer["to_s"])

    def erase(self, sessions: list[str]) -> list[str]:
        """Ask the archive to remove recordings."""
        answer = self._order("erase", {"sessions": sessions}, ERASE_TIMEOUT_S, "archive")
        return [str(session) for session in answer["erased"]]

    def offered(self) -> list[Source]:
        """Ask an ingest what it has."""
        answer = self._order("sources", {}, TIMEOUT_S)
        devices = [Source(each["name"], each["title"], "device", None, "camera") for each in answer.get("devices", [])]
        return devices + [_recording(each) for each in answer.get("recordings", [])]

    def _order(
        self, command: str, body: dict[str, Any], timeout_s: float, service: str = "ingest", tries: int = 1
    ) -> dict[str, Any]:
        bus = self._link.bus
        if bus is None:
            raise ControlUnavailable("The gateway has no connection to the router yet.")
        key = command_key(bus.settings.site, service, command)
        try:
            answers = bus.ask_again(key, json.dumps(body).encode(), timeout_s, tries)
        except RemoteError as error:
            raise ControlRefused(str(error)) from error
        if not answers:
            raise ControlUnavailable(f"No {service} service answers.")
        answer = json.loads(answers[0].payload or b"{}")
        if "error" in answer:
            raise ControlRefused(str(answer["error"]))
        assert isinstance(answer, dict)
        return answer


def _recording(told: dict[str, Any]) -> Source:
    worn: Worn | None = None
    if told.get("cameras"):
        worn = "camera_and_sensors" if told.get("hubs") else "camera"
    task = Task(told["task"]) if told.get("task") else None
    return Source(told["name"], told["title"], "recording", told.get("duration_s"), worn, task)
