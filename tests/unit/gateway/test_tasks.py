"""Timed tests, exercises and misplaced sensors: from the bus to the browser, the database and REST."""

import json
import math
from http import HTTPStatus

import pytest

from schemas.signals import REPETITION, TASK_PHASE
from schemas.tasks import Repetition, TaskPhase
from schemas.vocabulary import (
    KNEE_ESTIMATORS,
    LOWER_BODY_ESTIMATORS,
    TASK_PHASES,
    Misplacement,
    Side,
    Task,
    TaskPhaseKind,
)
from services.flow.message import Envelope, Message, Stream
from services.gateway.bus_feed import BusFeed, BusLink
from services.gateway.control import SYNTHETIC_SOURCES
from services.gateway.live import views
from services.gateway.live.memory import Memory
from services.ingest.source import open_source
from tests.unit.gateway.walk import calibration_of, metrics_at

SOURCE = "synthetic:walk?seed=3"


def phase_of(kind: TaskPhaseKind, start_s: float, end_s: float | None, attempt: int = 0) -> TaskPhase:
    return TaskPhase(
        task=Task.TIMED_UP_AND_GO, attempt=attempt, phase=kind, start_ns=round(start_s * 1e9), start_std_s=0.03,
        end_ns=None if end_s is None else round(end_s * 1e9), end_std_s=None if end_s is None else 0.04,
        largest_turn_rate=1.5, largest_thigh_rate=None, steps=4,
    )  # fmt: skip


def repetition_of(index: int, turn_angle: float = 1.9) -> Repetition:
    start_s = 3.0 * index
    return Repetition(
        degree_of_freedom="knee_flexion_left", side=Side.LEFT, index=index, start_ns=round(start_s * 1e9),
        turn_ns=round((start_s + 1.1) * 1e9), end_ns=round((start_s + 2.4) * 1e9), start_angle=0.05,
        turn_angle=turn_angle, end_angle=0.07, angle_std=0.02, largest_velocity=2.5, hold_s=None,
        ranges={}, valid=True, rejected_because=None,
    )  # fmt: skip


def first_of(socket, kind: str) -> dict:
    for _ in range(50):
        message = json.loads(socket.receive_text())
        if message["kind"] == kind:
            return message
    raise AssertionError(kind)


def start(client, **more):
    return client.post("/v1/sessions", json={"source": SOURCE, **more})


def test_the_task_is_the_operator_s_choice_and_else_the_source_s(client, control):
    start(client, task="timed_up_and_go", walkway_m=3.0)
    start(client)
    assert [(request.task, request.walkway_m) for request in control.started] == [
        (Task.TIMED_UP_AND_GO, 3.0),
        (None, None),
    ]


@pytest.mark.parametrize("wish", [{"task": "dance"}, {"walkway_m": 0}, {"walkway_m": 101}, {"walkway_m": "far"}])
def test_a_task_or_walkway_that_is_none_is_refused(client, control, wish):
    assert start(client, **wish).status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert control.started == []


def test_sources_and_estimators_say_what_is_worn(client):
    offer = client.get("/v1/sources").json()
    fitting = {each["worn"]: {name["name"] for name in offer["estimators"] if name["worn"] == each["worn"]}
               for each in offer["sources"] if each["worn"]}  # fmt: skip
    assert fitting["knee"] == set(KNEE_ESTIMATORS)
    assert fitting["lower_body"] == set(LOWER_BODY_ESTIMATORS)
    assert {source["task"] for source in offer["sources"] if source["kind"] == "synthetic"} == set(Task)
    assert {source["worn"] for source in offer["sources"] if source["kind"] == "recording"} == {None}


def test_every_simulated_source_is_one_that_an_ingest_knows():
    for source in SYNTHETIC_SOURCES:
        description = open_source(source.id).describe()
        assert description.task == source.task
        knees = description.estimator in KNEE_ESTIMATORS
        assert knees == (source.worn == "knee"), source.title
        assert source.duration_s in (None, pytest.approx(description.duration_s, abs=0.1))


def test_a_session_tells_its_task_as_it_runs(client, gateway, made):
    session = start(client).json()["id"]
    gateway.keeper.appeared(made.describe(session, task=Task.TIMED_UP_AND_GO, walkway_m=3.0))
    told = client.get(f"/v1/sessions/{session}").json()
    assert (told["task"], told["walkway_m"]) == ("timed_up_and_go", 3.0)
    with client.websocket_connect(f"/v1/live/{session}") as socket:
        head = first_of(socket, "session")
    assert (head["task"], head["walkway_m"]) == ("timed_up_and_go", 3.0)


def test_misplaced_sensors_are_told_live_on_the_floor_and_later(client, gateway, made):
    gateway.keeper.appeared(made.describe("a"))
    untold = client.get("/v1/sessions/a").json()
    assert (untold["datum"], untold["misplaced"]) == (None, {})
    gateway.keeper.calibrated("a", calibration_of({Side.LEFT: [Misplacement.OTHER_LEG]}))
    with client.websocket_connect("/v1/live/a") as socket:
        assert first_of(socket, "calibration")["misplaced"] == {"left": ["other_leg"]}
    with client.websocket_connect("/v1/live") as socket:
        [card] = json.loads(socket.receive_text())["sessions"]
    assert card["misplaced"] == {"left": ["other_leg"]}
    gateway.keeper.measured("a", metrics_at(60.0, final=True))
    told = client.get("/v1/sessions/a").json()
    assert told["misplaced"] == {"left": ["other_leg"]}
    assert told["datum"] == "quiet standing"


def test_a_later_calibration_replaces_the_earlier_one(client, gateway, made):
    gateway.keeper.appeared(made.describe("a"))
    gateway.keeper.calibrated("a", calibration_of({Side.LEFT: [Misplacement.SWAPPED]}))
    gateway.keeper.calibrated("a", calibration_of({}))
    assert client.get("/v1/sessions/a").json()["misplaced"] == {}


def test_phases_come_back_with_their_length_and_its_deviation(client, gateway):
    session = start(client).json()["id"]
    phases = [
        phase_of(TaskPhaseKind.SIT_TO_STAND, 5.0, 6.5),
        phase_of(TaskPhaseKind.WALK_OUT, 6.5, None),
    ]
    gateway.keeper.measured(session, metrics_at(7.0, final=False).model_copy(update={"phases": phases}))
    told = client.get(f"/v1/sessions/{session}/phases").json()
    assert told["final"] is False
    ended, running = told["phases"]
    assert (ended["phase"], ended["start_s"], ended["end_s"], ended["duration_s"]) == ("sit_to_stand", 5.0, 6.5, 1.5)
    assert math.isclose(ended["duration_std_s"], 0.05)
    assert (ended["largest_turn_rate"], ended["largest_thigh_rate"], ended["steps"]) == (1.5, None, 4)
    assert (running["end_s"], running["duration_s"], running["duration_std_s"]) == (None, None, None)


def test_repetitions_come_back_as_they_were_measured(client, gateway):
    session = start(client).json()["id"]
    gateway.keeper.measured(
        session,
        metrics_at(9.0, final=True).model_copy(update={"repetitions": [repetition_of(0), repetition_of(1, 1.7)]}),
    )
    told = client.get(f"/v1/sessions/{session}/repetitions").json()["repetitions"]
    assert [each["turn_angle"] for each in told] == [1.9, 1.7]
    assert (told[1]["start_s"], told[1]["turn_s"], told[1]["end_s"]) == (3.0, 4.1, 5.4)


@pytest.mark.parametrize("part", ["phases", "repetitions"])
def test_a_walk_has_neither(client, gateway, part):
    session = start(client).json()["id"]
    assert client.get(f"/v1/sessions/{session}/{part}").status_code == HTTPStatus.NOT_FOUND
    gateway.keeper.measured(session, metrics_at(60.0, final=True))
    assert client.get(f"/v1/sessions/{session}/{part}").json()[part] == []


def test_the_feed_hands_phases_and_repetitions_to_those_who_watch(client, gateway, hub, made):
    feed = BusFeed(None, BusLink(), hub, gateway.keeper)
    gateway.keeper.appeared(made.describe("a"))
    for number, (signal, payload) in enumerate(
        [(TASK_PHASE, phase_of(TaskPhaseKind.TURN, 9.0, 10.0)), (REPETITION, repetition_of(4))]
    ):
        envelope = Envelope(epoch=1, sequence=number, captured_ns=0, final=False, schema_version="2026-11")
        feed.take("a", Message(Stream(signal, "segmentation"), envelope, payload))
    with client.websocket_connect("/v1/live/a") as socket:
        assert first_of(socket, "task_phase")["phase"] == "turn"
        assert first_of(socket, "repetition")["index"] == 4


def test_whoever_comes_late_is_told_the_phases_of_the_newest_attempt_only():
    memory = Memory()
    for attempt in (0, 1):
        for place, kind in enumerate(TASK_PHASES[Task.TIMED_UP_AND_GO]):
            start_s = 20.0 * attempt + place
            for end_s in (None, start_s + 1):
                memory.keep(views.phase_view(phase_of(kind, start_s, end_s, attempt)))
    memory.keep(views.phase_view(phase_of(TaskPhaseKind.TURN, 1.0, 2.0, attempt=0)))
    phases = memory.of("task_phase")
    assert [phase["phase"] for phase in phases] == list(TASK_PHASES[Task.TIMED_UP_AND_GO])
    assert all(phase["attempt"] == 1 and phase["end_s"] is not None for phase in phases)


def test_memory_does_not_grow_with_the_session():
    memory = Memory()
    for index in range(500):
        memory.keep(views.repetition_view(repetition_of(index)))
        memory.keep({"kind": "gait_event", "side": "left", "at_s": float(index)})
    assert [view["index"] for view in memory] == [499]


def test_whoever_comes_late_to_a_six_minute_walk_is_told_every_walk_turn_and_rest():
    memory = Memory()
    kinds = [TaskPhaseKind.WALK, TaskPhaseKind.TURN, TaskPhaseKind.WALK, TaskPhaseKind.REST, TaskPhaseKind.WALK]
    for place, kind in enumerate(kinds):
        for end_s in (None, place + 1.0):
            phase = phase_of(kind, float(place), end_s)
            memory.keep(views.phase_view(phase.model_copy(update={"task": Task.SIX_MINUTE_WALK, "distance_m": 7.0})))
    assert [(each["phase"], each["end_s"]) for each in memory.of("task_phase")] == [
        (kind, place + 1.0) for place, kind in enumerate(kinds)
    ]
    assert sum(each["distance_m"] for each in memory.of("task_phase")) == 35.0
    assert [each["start_s"] for each in memory.newest_phases(2)] == [3.0, 4.0]
