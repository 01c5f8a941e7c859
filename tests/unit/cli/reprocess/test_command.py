"""What the command says, stores and never overwrites."""

import json
import shutil

import pytest
from typer.testing import CliRunner

from schemas.archive_layout import SegmentName
from schemas.metrics import SessionMetrics
from services.archive.disk import Disk
from services.cli.__main__ import app
from services.cli.reprocess.recompute import CannotRecompute, open_archived
from services.cli.reprocess.sessions import outcomes
from services.cli.reprocess.storing import WORK_FOLDER, DerivedFile
from services.flow.software import SOFTWARE, VERSION
from services.gateway.access.scope import EVERYTHING
from services.gateway.database import open_database
from services.gateway.sessions.records import record_metrics, record_start
from services.gateway.tables import FormerMetricsRow, MetricsRow
from services.recordings.folder import read_manifest, verify
from services.recordings.reader import open_recording

NEW = SegmentName("derived", VERSION, 0, part=False).file_name
OLD = "ambula 0.0.9"


def run(data_dir, *arguments):
    options = ["reprocess", *arguments, "--data-dir", str(data_dir), "--jobs", "1"]
    result = CliRunner().invoke(app, options, env={"COLUMNS": "200", "AMBULA_DATABASE": ""})
    return result.exit_code, " ".join(result.output.split())


@pytest.fixture
def older(walked, archiving, tmp_path):
    """The walk as an older software would have stored it: faster, without one metric, with one that is gone since."""
    description, messages = walked
    said = []
    for message in messages:
        if isinstance(message.payload, SessionMetrics):
            metrics = [
                metric.model_copy(update={"value": 9.9}) if metric.name == "walking_speed" else metric
                for metric in message.payload.metrics
                if metric.name != "cadence"
            ]
            metrics.append(metrics[0].model_copy(update={"name": "forgotten_measure"}))
            payload = message.payload.model_copy(update={"metrics": metrics, "software": OLD})
            message = type(message)(message.stream, message.envelope, payload)
        said.append(message)
    archiving(tmp_path / "data" / description.session, said, description, version="0.0.9")
    return tmp_path / "data"


@pytest.fixture
def database(older, walked):
    """The gateway's database beside it."""
    description, _ = walked
    stored = open_database(f"sqlite:///{older / 'ambula.sqlite'}")
    last = [message.payload for message in open_recording(older / description.session).messages()
            if isinstance(message.payload, SessionMetrics)][-1]  # fmt: skip
    with stored.transaction(EVERYTHING) as transaction:
        record_start(transaction, description, "main")
        record_metrics(transaction, description.session, last)
    yield stored
    stored.close()


def test_what_another_software_stored_is_shown_metric_by_metric(older, walked, tmp_path):
    file = tmp_path / "rows.json"
    code, said = run(older, "--all", "--json", str(file))
    assert code == 0
    assert f"{OLD} -> {SOFTWARE}" in said
    (row,) = json.loads(file.read_text())
    kinds = {change["name"]: change["kind"] for change in row["metrics"]}
    assert kinds == {"walking_speed": "changed", "cadence": "new", "forgotten_measure": "gone"}
    speed = next(change for change in row["metrics"] if change["name"] == "walking_speed")
    assert speed["change"] == pytest.approx(speed["after"]["value"] - 9.9)
    assert (row["stored_software"], row["software"], row["identical_metrics"]) == (OLD, SOFTWARE, False)
    assert "walking speed" in said
    assert "forgotten measure" in said
    assert not (older / walked[0].session / NEW).exists()


def test_storing_adds_a_file_and_keeps_the_former_result(older, walked, database):
    folder = older / walked[0].session
    before = (folder / "derived-0.0.9.mcap").read_bytes()
    (folder / WORK_FOLDER).mkdir()
    (folder / WORK_FOLDER / f"{NEW}.part").write_bytes(b"what a kill left")
    assert open_recording(folder).problem is None
    code, said = run(older, "--all", "--store")
    assert (code, f"stored: {folder.name}/{NEW}" in said) == (0, True)
    assert (folder / "derived-0.0.9.mcap").read_bytes() == before
    assert verify(folder) == []
    assert NEW in [entry.name for entry in read_manifest(folder).files]
    assert not (folder / WORK_FOLDER).exists()
    assert len(list(open_recording(folder, VERSION).messages())) == len(walked[1])
    with database.transaction(EVERYTHING) as transaction:
        current = transaction.get(MetricsRow, folder.name)
        former = transaction.get(FormerMetricsRow, (folder.name, OLD))
        assert (current.software, current.final) == (SOFTWARE, True)
        assert [metric["value"] for metric in former.body["metrics"] if metric["name"] == "walking_speed"] == [9.9]
    assert "identical" in run(older, "--all", "--store")[1]
    with database.transaction(EVERYTHING) as transaction:
        assert transaction.query(FormerMetricsRow).count() == 1


def test_a_file_that_is_there_is_never_overwritten(older, walked):
    folder = older / walked[0].session
    recording = open_archived(folder).recording
    with DerivedFile.begun(folder, recording.description) as draft:
        for record in recording.records():
            if record.stream.signal.archived == "derived":
                draft.add(record)
        (folder / NEW).write_bytes(b"somebody else's")
        with pytest.raises(FileExistsError):
            draft.finish()
    assert (folder / NEW).read_bytes() == b"somebody else's"


def test_two_at_once_do_not_share_a_draft(older, walked):
    folder = older / walked[0].session
    description = walked[0]
    with (
        DerivedFile.begun(folder, description),
        pytest.raises(CannotRecompute, match="another process"),
        DerivedFile.begun(folder, description),
    ):
        pass


def test_a_full_disk_leaves_the_session_as_it_was(older, walked, monkeypatch):
    folder = older / walked[0].session
    before = sorted(path.name for path in folder.iterdir())

    def full(self, descriptor, data):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Disk, "write", full)
    code, said = run(older, "--all", "--store")
    assert (code, "No space left" in said) == (1, True)
    assert sorted(path.name for path in folder.iterdir()) == before


def test_a_damaged_session_is_skipped_and_the_others_are_identical(data_dir, session):
    shutil.copytree(session, data_dir / "damaged")
    (data_dir / "damaged" / "raw.mcap").write_bytes(b"\x89MCAP0\r\n")
    code, said = run(data_dir, "--all")
    assert code == 1
    assert "damaged: not recomputed" in said
    assert f"identical, computed by {SOFTWARE}" in said


def test_several_processes_say_the_same(data_dir, session):
    (data_dir / "nothing").mkdir()
    (data_dir / "nothing" / "raw.mcap").write_bytes(b"nothing")
    told = {}
    found = list(outcomes(sorted(data_dir.iterdir()), 2, False, told.__setitem__))
    by_name = {outcome.session: outcome for outcome in found}
    assert by_name[session.name].result.metrics.final
    assert by_name["nothing"].result is None
    assert told[session.name] == 1.0


@pytest.mark.parametrize("arguments", [(), ("--all", "x"), ("nobody",)])
def test_what_cannot_be_asked_is_told_in_a_line(data_dir, arguments):
    code, said = run(data_dir, *arguments)
    assert code == 1
    assert said.startswith("Error:")


def test_an_empty_folder_is_told(tmp_path):
    code, said = run(tmp_path, "--all")
    assert (code, said.startswith("Error: no recorded session")) == (1, True)
