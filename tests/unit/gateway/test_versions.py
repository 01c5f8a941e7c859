"""Results of a session by the software that computed them: another algorithm is told from another patient."""

from datetime import UTC, datetime
from http import HTTPStatus

import pytest

from schemas.archive_layout import SegmentName
from schemas.session import SessionDescription
from services.gateway.access.scope import EVERYTHING
from services.gateway.tables import FormerMetricsRow, SessionRow
from services.gateway.versions.records import replace_metrics

OLD, NEW, NEWER = (f"ambula 0.1.0+{digit * 8}" for digit in "123")


@pytest.fixture
def result(made):
    """The walk's final metrics as a software computed them, with a walking speed."""

    def by(software, speed):
        metrics = made.metrics_at(30.0, final=True).model_copy(update={"software": software})
        numbers = [
            metric.model_copy(update={"value": speed}) if metric.name == "walking_speed" else metric
            for metric in metrics.metrics
        ]
        return metrics.model_copy(update={"metrics": numbers})

    return by


@pytest.fixture
def measured(client, gateway, made, result):
    gateway.keeper.appeared(made.describe("a"))
    gateway.keeper.measured("a", result(OLD, 1.0))
    return gateway


def replace(gateway, metrics, session="a"):
    with gateway.database.transaction(EVERYTHING) as database:
        return replace_metrics(database, session, metrics)


def test_a_session_has_one_version_until_it_is_reprocessed(client, measured):
    (version,) = client.get("/v1/sessions/a/versions").json()["versions"]
    assert (version["software"], version["current"], version["identical"]) == (OLD, True, True)
    assert (version["replaced"], version["metrics"], version["files"]) == (None, [], [])


def test_a_replaced_result_is_kept_and_compared(client, measured, result, settings):
    assert replace(measured, result(NEW, 1.2))
    folder = settings.data_dir / "a"
    folder.mkdir(parents=True)
    for software in (OLD, NEW):
        version = software.removeprefix("ambula ")
        (folder / SegmentName("derived", version, 0, part=False).file_name).write_bytes(b"x")
    newest, older = client.get("/v1/sessions/a/versions").json()["versions"]
    assert (newest["software"], newest["current"], newest["metrics"]) == (NEW, True, [])
    assert (older["software"], older["current"], older["identical"]) == (OLD, False, False)
    assert newest["files"] == ["derived-0.1.0+22222222.mcap"]
    (change,) = older["metrics"]
    assert (change["name"], change["kind"], change["unit"]) == ("walking_speed", "changed", "m/s")
    assert (change["before"]["value"], change["after"]["value"]) == (1.0, 1.2)
    assert change["change"] == pytest.approx(0.2)
    speeds = {each["name"]: each["value"] for each in client.get("/v1/sessions/a/metrics").json()["metrics"]}
    assert speeds["walking_speed"] == 1.2


def test_versions_come_back_and_each_is_kept_once(client, measured, result):
    for software, speed in ((NEW, 1.2), (NEWER, 1.3), (OLD, 1.0), (NEWER, 1.3)):
        replace(measured, result(software, speed))
    versions = client.get("/v1/sessions/a/versions").json()["versions"]
    assert [version["software"] for version in versions] == [NEWER, OLD, NEW]
    with measured.database.transaction(EVERYTHING) as database:
        assert database.query(FormerMetricsRow).count() == 2


def test_a_result_that_was_not_final_is_not_kept(client, gateway, made, result):
    gateway.keeper.appeared(made.describe("a"))
    gateway.keeper.measured("a", result(OLD, 1.0).model_copy(update={"final": False}))
    assert replace(gateway, result(NEW, 1.1))
    assert [version["software"] for version in client.get("/v1/sessions/a/versions").json()["versions"]] == [NEW]


def test_unknown_sessions(client, measured, result):
    assert not replace(measured, result(NEW, 1.1), session="nobody")
    assert client.get("/v1/sessions/nobody/versions").status_code == HTTPStatus.NOT_FOUND


def test_a_session_without_metrics_has_no_version(client, gateway, made):
    gateway.keeper.appeared(made.describe("a"))
    assert client.get("/v1/sessions/a/versions").json() == {"session": "a", "versions": []}


def test_a_former_result_of_an_older_schema_is_still_shown(client, measured, result):
    replace(measured, result(NEW, 1.0))
    later = ("low", "high", "grade", "doubts")
    with measured.database.transaction(EVERYTHING) as database:
        newest = database.get(FormerMetricsRow, ("a", OLD)).body
        metrics = [{key: value for key, value in each.items() if key not in later} for each in newest["metrics"]]
        body = {"captured_ns": newest["captured_ns"], "final": True, "metrics": metrics, "curves": newest["curves"]}
        now = datetime.now(UTC)
        database.merge(
            FormerMetricsRow(session_id="a", software="ambula 0.1.0", received=now, replaced=now, body=body)
        )  # fmt: skip
    versions = client.get("/v1/sessions/a/versions").json()["versions"]
    assert {version["software"] for version in versions} == {OLD, NEW, "ambula 0.1.0"}


def test_a_session_from_before_descriptions_were_kept_gets_its_own(client, measured, result, made):
    described = made.describe("a")
    with measured.database.transaction(EVERYTHING) as database:
        database.get(SessionRow, "a").description = None
    with measured.database.transaction(EVERYTHING) as database:
        assert replace_metrics(database, "a", result(NEW, 1.1), described)
    with measured.database.transaction(EVERYTHING) as database:
        stored = database.get(SessionRow, "a").description
    assert SessionDescription.model_validate(stored) == described
