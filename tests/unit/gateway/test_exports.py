"""Exports by REST: of a session whose recording lies in the archive's folder."""

from http import HTTPStatus

import pytest

from schemas.signals import GAIT_EVENT, JOINT_STATE
from schemas.vocabulary import LOWER_BODY
from services.exports.formats import FORMATS
from services.flow.message import encode_payload
from services.gateway.access.scope import EVERYTHING
from services.gateway.exports import writing
from services.gateway.sessions import records

NS = 10_000_000


def joint_state(captured_ns):
    row = [0.3] * len(LOWER_BODY)
    nothing = [[0.0] * len(LOWER_BODY)]
    return JOINT_STATE.model(
        model="lower_body", captured_ns=[captured_ns], position=[row], velocity=nothing, acceleration=nothing,
        position_std=nothing, velocity_std=nothing, valid=[True] * len(LOWER_BODY), observed=[],
    )  # fmt: skip


@pytest.fixture
def exported(client, gateway, settings, made, recorded, tape):
    """Session `a`, recorded and over."""
    gateway.keeper.appeared(made.describe("a"))
    with gateway.database.transaction(EVERYTHING) as database:
        records.record_metrics(database, "a", made.metrics_at(9.0, final=True))
    folder = settings.data_dir / "a"
    folder.mkdir(parents=True)
    messages = [
        tape.record(tape.joints, n, payload=encode_payload(joint_state(n * NS)), captured_ns=n * NS) for n in range(50)
    ]
    event = GAIT_EVENT.model(kind="toe_off", side="left", captured_ns=20 * NS, time_std_s=0.01)
    messages.append(tape.record(tape.events, 0, payload=encode_payload(event), captured_ns=20 * NS))
    return recorded(messages, folder=folder)


def listed(client, session="a"):
    return {item["format"]: item for item in client.get(f"/v1/sessions/{session}/exports").json()["items"]}


def test_every_format_is_listed_with_the_reason_why_it_cannot_be_had(client, exported):
    items = listed(client)
    assert list(items) == list(FORMATS)
    assert [name for name, item in items.items() if item["available"]] == [
        "events.csv", "joint_angles.csv", "c3d", "mot", "sto", "trc", "mcap",
    ]  # fmt: skip
    assert items["phases.csv"]["reason"] == "the session holds no task_phase messages: phases of a timed test"
    assert all((item["reason"] is None) == item["available"] for item in items.values())
    assert client.get("/v1/sessions/a/exports").json()["software"] == "ambula 0.1.0"


@pytest.mark.parametrize(
    ("name", "begins", "file_name"),
    [
        ("events.csv", b"# written by: ambula", "ambula-a-events.csv"),
        ("c3d", b"\x02\x50", "ambula-a.c3d"),
        ("mot", b"Coordinates\nversion=1\nnRows=50\n", "ambula-a.mot"),
        ("trc", b"PathFileType\t4", "ambula-a.trc"),
        ("mcap", b"\x89MCAP0\r\n", "ambula-a-foxglove.mcap"),
    ],
)
def test_a_file_comes_whole_under_a_name_without_a_person(client, exported, name, begins, file_name):
    answer = client.get(f"/v1/sessions/a/exports/{name}")
    assert answer.status_code == HTTPStatus.OK
    assert answer.content.startswith(begins)
    assert int(answer.headers["content-length"]) == len(answer.content)
    assert answer.headers["content-disposition"] == f'attachment; filename="{file_name}"'
    assert answer.headers["content-type"] == listed(client)[name]["media_type"]


def test_the_opensim_model_may_be_chosen(client, exported):
    planar = client.get("/v1/sessions/a/exports/mot", params={"model": "gait10dof18musc"}).text
    assert "hip_adduction_r" not in planar.partition("endheader")[2]
    answer = client.get("/v1/sessions/a/exports/mot", params={"model": "other"})
    assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def problem(answer, status):
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    return answer.json()


def test_one_file_is_written_at_a_time(client, exported):
    with writing._busy:
        told = problem(client.get("/v1/sessions/a/exports/c3d"), HTTPStatus.SERVICE_UNAVAILABLE)
    assert "Try again" in told["next_step"]
    assert client.get("/v1/sessions/a/exports/c3d").status_code == HTTPStatus.OK


def test_what_cannot_be_had_is_a_conflict_with_its_reason(client, exported):
    told = problem(client.get("/v1/sessions/a/exports/strides.csv"), HTTPStatus.CONFLICT)
    assert "the session holds no stride messages" in told["detail"]


def test_what_is_not_known_is_not_found(client, exported):
    assert "no format" in problem(client.get("/v1/sessions/a/exports/xls"), HTTPStatus.NOT_FOUND)["detail"]
    problem(client.get("/v1/sessions/b/exports"), HTTPStatus.NOT_FOUND)
    problem(client.get("/v1/sessions/b/exports/c3d"), HTTPStatus.NOT_FOUND)


def test_a_session_that_runs_is_not_exported(client, gateway, made):
    gateway.keeper.appeared(made.describe("b"))
    assert {item["reason"] for item in listed(client, "b").values()} == {
        "the session still runs; stop it or wait for its end"
    }
    problem(client.get("/v1/sessions/b/exports/c3d"), HTTPStatus.CONFLICT)


def test_a_session_without_a_recording_says_so(client, gateway, made, exported):
    for path in exported.iterdir():
        path.unlink()
    assert "no closed recording" in listed(client)["c3d"]["reason"]


def test_a_damaged_recording_is_told_and_frees_the_way(client, exported):
    path = exported / "derived-0.1.0.mcap"
    path.write_bytes(path.read_bytes()[:-2000])
    told = problem(client.get("/v1/sessions/a/exports/c3d"), HTTPStatus.CONFLICT)
    assert "backup" in told["next_step"]
    assert not writing._busy.locked()


def test_a_full_disk_is_told_and_frees_the_way(client, exported, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(writing, "write", full)
    told = problem(client.get("/v1/sessions/a/exports/c3d"), HTTPStatus.SERVICE_UNAVAILABLE)
    assert "Make room" in told["next_step"]
    assert not writing._busy.locked()
