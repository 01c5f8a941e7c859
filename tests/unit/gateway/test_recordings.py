import hashlib
from http import HTTPStatus

import pytest

from schemas.archive_layout import MANIFEST_FILE, Manifest, RecordingState, SegmentEntry
from services.gateway.recordings.folder import list_recordings

RAW = b"\x89MCAP0\r\n raw bytes"


@pytest.fixture
def recorded(client, gateway, settings, made):
    gateway.keeper.appeared(made.describe("a"))
    folder = settings.data_dir / "a"
    folder.mkdir(parents=True)
    (folder / "raw.mcap").write_bytes(RAW)
    (folder / "derived-0.1.0.mcap.part").write_bytes(b"open")
    (folder / "checkpoint-estimation.json").write_text("{}")
    entry = SegmentEntry(
        name="raw.mcap",
        size_bytes=len(RAW),
        sha256=hashlib.sha256(RAW).hexdigest(),
        messages=1,
        streams=[],
        damage=None,
    )
    manifest = Manifest(
        session="a", title="Walk", protocol="walk", origin="synthetic", estimator="ekf", started_unix_ns=0,
        duration_s=1.0, state=RecordingState.RECORDING, state_reason=None, derived_version="0.1.0", files=[entry],
    )  # fmt: skip
    (folder / MANIFEST_FILE).write_text(manifest.model_dump_json())
    return folder


def test_files_are_listed_with_their_sums(client, recorded):
    derived, raw = client.get("/v1/sessions/a/recordings").json()
    assert (raw["name"], raw["kind"], raw["complete"], raw["size_bytes"]) == ("raw.mcap", "raw", True, len(RAW))
    assert raw["sha256"] == hashlib.sha256(RAW).hexdigest()
    assert (derived["kind"], derived["complete"], derived["sha256"]) == ("derived", False, None)


def test_a_file_is_downloaded_whole_under_a_telling_name(client, recorded):
    answer = client.get("/v1/sessions/a/recordings/raw.mcap")
    assert answer.content == RAW
    assert answer.headers["content-type"] == "application/vnd.mcap"
    assert answer.headers["content-disposition"] == 'attachment; filename="a-raw.mcap"'


def test_a_session_without_files_has_an_empty_list(client, gateway, made):
    gateway.keeper.appeared(made.describe("b"))
    assert client.get("/v1/sessions/b/recordings").json() == []


@pytest.mark.parametrize(
    "name",
    [
        "manifest.json",
        "checkpoint-estimation.json",
        "secret.mcap",
        "..%2fsecret.mcap",
        "%2e%2e%2fsecret.mcap",
        "..%5csecret.mcap",
        "%2fetc%2fpasswd",
        "raw.mcap%00.txt",
        "../a/raw.mcap/../../secret.mcap",
        "link.mcap",
        "raw_001.mcap",
    ],
)
def test_nothing_but_the_sessions_own_recordings_can_be_fetched(client, recorded, name):
    (recorded.parent / "secret.mcap").write_bytes(b"secret")
    (recorded / "raw_001.mcap").symlink_to(recorded.parent / "secret.mcap")
    answer = client.get(f"/v1/sessions/a/recordings/{name}")
    assert answer.status_code in (HTTPStatus.NOT_FOUND, HTTPStatus.UNPROCESSABLE_ENTITY)
    assert b"secret" not in answer.content


@pytest.mark.parametrize("session", ["..", "%2e%2e", "..%2f..", "a%2f..%2fa", ".", "%00"])
def test_a_session_id_cannot_leave_the_data_folder(client, recorded, session):
    answer = client.get(f"/v1/sessions/{session}/recordings/raw.mcap")
    assert answer.status_code in (HTTPStatus.NOT_FOUND, HTTPStatus.UNPROCESSABLE_ENTITY)
    assert RAW not in answer.content


def test_the_folder_itself_refuses_unsafe_ids(tmp_path):
    with pytest.raises(ValueError, match="session id"):
        list_recordings(tmp_path, "../elsewhere")


def test_a_broken_manifest_hides_only_the_sums(recorded):
    (recorded / MANIFEST_FILE).write_text("{broken")
    assert [(each.path.name, each.sha256) for each in list_recordings(recorded.parent, "a")] == [
        ("derived-0.1.0.mcap.part", None),
        ("raw.mcap", None),
    ]
