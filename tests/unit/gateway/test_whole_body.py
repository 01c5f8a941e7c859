"""A body before a camera: joint centres, cameras, lengths and repetitions of both sides, live and by REST; devices."""

from http import HTTPStatus

import pytest

from schemas.kinematics import CameraStatus
from schemas.session import CameraDescription
from schemas.tasks import Repetition
from schemas.vocabulary import (
    CAMERA_ESTIMATORS,
    FUSION_ESTIMATORS,
    CameraKind,
    JointCentre,
    SensorState,
    Side,
    SkeletonJoint,
    Task,
)
from services.gateway.control import ControlUnavailable, worn_by
from services.gateway.live import views
from services.gateway.live.memory import Memory
from tests.unit.gateway.conftest import CAMERA
from tests.unit.gateway.test_tasks import first_of
from tests.unit.gateway.walk import calibration_of, describe, metrics_at, pose_at

KINECT = CameraDescription(
    name="kinect", kind=CameraKind.KINECT_V2, rate_hz=30.0, joints=list(SkeletonJoint)[:25], floor_m=-0.9
)
LENGTHS = {"thigh_right": 0.42131, "thigh_left": 0.42}


def of_a_camera(session: str):
    return describe(session, title="Squats", hubs=[], cameras=[KINECT], task=Task.SQUAT, estimator="body_cekf")


def tilt(side: Side | None, index: int) -> Repetition:
    return Repetition(
        degree_of_freedom="trunk_lean_right", side=side, index=index, start_ns=0, turn_ns=10**9, end_ns=2 * 10**9,
        start_angle=0.0, turn_angle=-0.4 if side is Side.LEFT else 0.4, end_angle=0.01, angle_std=0.02,
        largest_velocity=0.8, hold_s=0.35, ranges={"hip_adduction_left": 0.31234567}, valid=True, rejected_because=None,
    )  # fmt: skip


def test_a_page_is_told_the_cameras_before_anything_else():
    [camera] = views.session_view(of_a_camera("a"), None)["cameras"]
    assert camera == {"name": "kinect", "kind": "kinect_v2", "rate_hz": 30.0, "floor_m": -0.9}


def test_a_picture_holds_joint_centres_and_what_cameras_see():
    status = CameraStatus(camera="kinect", state=SensorState.OK, people=2, since_ns=1_500_000_000)
    centres = {JointCentre.SPINE_BASE: [-2.51234567, 0.1, 0.2]}
    pose = pose_at(2.0).model_copy(update={"centres": centres, "cameras": [status]})
    view = views.pose_view([pose], 0.01)
    assert view["centres"] == {"spine_base": [-2.5123, 0.1, 0.2]}
    assert view["cameras"] == [{"camera": "kinect", "state": "ok", "people": 2, "since_s": 1.5}]
    assert views.pose_view([pose_at(2.0)], 0.01)["centres"] == {}


def test_lengths_and_whether_angles_are_absolute_are_told_live_and_kept(client, gateway):
    gateway.keeper.appeared(of_a_camera("a"))
    untold = client.get("/v1/sessions/a").json()
    assert (untold["absolute"], untold["lengths"]) == (None, {})
    gateway.keeper.calibrated("a", calibration_of({}).model_copy(update={"lengths": LENGTHS, "absolute": False}))
    with client.websocket_connect("/v1/live/a") as socket:
        told = first_of(socket, "calibration")
    assert told["absolute"] is False
    assert told["lengths"] == {"thigh_right": 0.4213, "thigh_left": 0.42}
    stored = client.get("/v1/sessions/a").json()
    assert (stored["absolute"], stored["lengths"]) == (False, LENGTHS)


def test_repetitions_of_both_sides_and_of_none_come_back_as_measured(client, gateway):
    gateway.keeper.appeared(of_a_camera("a"))
    repetitions = [tilt(Side.RIGHT, 0), tilt(Side.LEFT, 0), tilt(None, 1)]
    final = metrics_at(60.0, final=True).model_copy(update={"repetitions": repetitions})
    gateway.keeper.measured("a", final)
    told = client.get("/v1/sessions/a/repetitions").json()["repetitions"]
    assert [each["side"] for each in told] == ["right", "left", None]
    assert {each["hold_s"] for each in told} == {0.35}
    assert told[0]["ranges"] == {"hip_adduction_left": 0.31234567}


def test_who_comes_late_is_told_the_newest_of_each_side():
    memory = Memory()
    for side, index in [(Side.RIGHT, 0), (Side.LEFT, 0), (Side.RIGHT, 1)]:
        memory.keep(views.repetition_view(tilt(side, index)))
    assert [(each["side"], each["index"]) for each in memory.of("repetition")] == [("right", 1), ("left", 0)]


def test_the_floor_says_what_cameras_see(client, gateway):
    gateway.keeper.appeared(of_a_camera("a"))
    status = CameraStatus(camera="kinect", state=SensorState.MISSING, people=0, since_ns=0)
    gateway.live.pose("a", pose_at(1.0).model_copy(update={"cameras": [status]}).model_dump_json().encode())
    with client.websocket_connect("/v1/live") as socket:
        [card] = first_of(socket, "floor")["sessions"]
    assert card["cameras"] == [{"camera": "kinect", "state": "missing", "people": 0, "since_s": 0.0}]


@pytest.mark.parametrize(("worn", "names"), [("camera", CAMERA_ESTIMATORS), ("camera_and_sensors", FUSION_ESTIMATORS)])
def test_estimators_say_that_they_need_a_camera(client, worn, names):
    offered = client.get("/v1/sources").json()["estimators"]
    assert {each["name"] for each in offered if each["worn"] == worn} == set(names)
    assert {worn_by(name) for name in names} == {worn}


@pytest.mark.parametrize("source", [CAMERA, f"{CAMERA}&height=1.71"])
def test_a_camera_that_sends_can_be_started(client, control, source):
    assert client.post("/v1/sessions", json={"source": source, "task": "squat"}).status_code == HTTPStatus.CREATED
    assert control.started[-1].source == source


@pytest.mark.parametrize("source", ["device:kinect?port=22", "device:kinect", f"{CAMERA}8", "device:kinect?port=778"])
def test_nothing_listens_where_no_camera_is_offered(client, control, source):
    answer = client.post("/v1/sessions", json={"source": source})
    assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert "switch the camera" in answer.json()["detail"]
    assert control.started == []


def test_a_device_without_any_ingest_is_unavailable(client, control):
    control.trouble = ControlUnavailable("gone")
    assert client.post("/v1/sessions", json={"source": CAMERA}).status_code == HTTPStatus.SERVICE_UNAVAILABLE
