"""Starting and stopping sessions: what the gateway asks of an ingest, without saying how it is reached."""

from dataclasses import dataclass
from typing import Literal, Protocol

from schemas.conditions import Conditions
from schemas.rhythm import KnownRhythm
from schemas.session import SessionDescription, WalkPath
from schemas.vocabulary import CAMERA_ESTIMATORS, FUSION_ESTIMATORS, KNEE_ESTIMATORS, Task


class ControlUnavailable(RuntimeError):
    """No ingest can be reached just now."""


class ControlRefused(RuntimeError):
    """An ingest was reached and said no; the message is its reason."""


@dataclass(frozen=True, slots=True)
class StartRequest:
    """A session to be started. `speed` None plays as fast as the services follow.

    `estimator`, `walk_path`, `known_rhythms`, `task`, `walkway_m` and `conditions` None are what the source says.
    """

    session: str
    source: str
    speed: float | None
    estimator: str | None
    walk_path: WalkPath | None
    known_rhythms: list[KnownRhythm] | None
    task: Task | None
    walkway_m: float | None
    conditions: Conditions | None


Worn = Literal["lower_body", "knee", "camera", "camera_and_sensors"]
"""What measures the person: sensors on pelvis and both legs, on the thigh and shank of one leg, nothing that is worn
but a depth camera, or sensors and a camera at once."""


def worn_by(estimator: str) -> Worn:
    """What an estimator is made for, by its name."""
    if estimator in FUSION_ESTIMATORS:
        return "camera_and_sensors"
    if estimator in CAMERA_ESTIMATORS:
        return "camera"
    return "knee" if estimator in KNEE_ESTIMATORS else "lower_body"


SourceKind = Literal["recording", "synthetic", "device"]


@dataclass(frozen=True, slots=True)
class Source:
    """Something that can be played as a session, or a device that sends by itself."""

    id: str
    title: str
    kind: SourceKind
    duration_s: float | None
    worn: Worn | None = None
    task: Task | None = None


class Control(Protocol):
    """The way to the ingests. Every call may raise ControlUnavailable; waits a few seconds at most."""

    def start(self, request: StartRequest) -> SessionDescription:
        """Start a session. Raises ControlRefused with the ingest's reason."""

    def stop(self, session: str) -> None:
        """End a session's streams. Raises ControlRefused when the ingest does not run it."""

    def mark(self, session: str, last_s: float, at_s: float | None) -> tuple[float, float]:
        """Mark the last seconds as standing; the span, s of session time. Raises ControlRefused with the reason."""

    def erase(self, sessions: list[str]) -> list[str]:
        """Remove the recordings of sessions for good; those that are gone. The archive leaves what still runs."""

    def offered(self) -> list[Source]:
        """Devices that send to an ingest, and recordings that it has at hand."""


def _walker(options: str, title: str, worn: Worn = "lower_body") -> Source:
    return Source(f"synthetic:walk?{options}&duration=120", title, "synthetic", 120.0, worn, Task.WALK)


def _before_a_camera(motion: str, title: str, task: Task) -> Source:
    return Source(f"synthetic:{motion}?person=2", title, "synthetic", None, "camera", task)


def _on_foot(what: str, title: str, task: Task) -> Source:
    return Source(f"synthetic:{what}", title, "synthetic", None, "lower_body", task)


SYNTHETIC_SOURCES = (
    _walker("speed=1.2&seed=1", "Walk, comfortable speed"),
    _walker("speed=0.7&seed=2", "Walk, slow"),
    _walker("speed=0.9&asymmetry=0.25&seed=3", "Walk, uneven sides"),
    _walker("worn=1&speed=1.1&seed=4", "Walk, left knee alone", "knee"),
    Source(
        "synthetic:tug?attempts=2&stroll=8&seed=4",
        "Timed up and go, twice",
        "synthetic",
        None,
        "lower_body",
        Task.TIMED_UP_AND_GO,
    ),
    Source(
        "synthetic:tug?attempts=2&worn=2&seed=4",
        "Timed up and go, right knee alone",
        "synthetic",
        None,
        "knee",
        Task.TIMED_UP_AND_GO,
    ),
    _on_foot("six_minutes?rests=1&seed=6", "Six-minute walk with a rest, 30 m corridor", Task.SIX_MINUTE_WALK),
    _on_foot("six_minutes?duration=60&corridor=10&seed=6", "One-minute walk, 10 m corridor", Task.SIX_MINUTE_WALK),
    _on_foot("ten_metres?seed=7", "Ten-metre walk, three times from standing", Task.TEN_METRE_WALK),
    _on_foot("march?seed=8", "Marching on the spot", Task.MARCHING),
    Source("synthetic:knee?seed=2", "Seated knee extension, right knee", "synthetic", 90.0, "knee", Task.KNEE_FLEXION),
    _before_a_camera("squat", "Squats with the arms raised, camera", Task.SQUAT),
    _before_a_camera("steps", "Stepping on the spot, camera", Task.STEPPING),
    _before_a_camera("tilt_forward", "Leaning forward, camera", Task.TRUNK_TILT_SAGITTAL),
    _before_a_camera("tilt_aside", "Leaning to the sides, camera", Task.TRUNK_TILT_FRONTAL),
    _walker("camera=1&speed=1.1&seed=5", "Walk, camera and sensors together", "camera_and_sensors"),
)
"""Simulated people that are always there."""
