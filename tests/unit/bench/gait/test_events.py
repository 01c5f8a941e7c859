import numpy as np
import pytest

from schemas.vocabulary import GaitEventKind
from services.bench.gait.events import TEMPLATE, Judged, detected_share, event_rows, run
from services.bench.gait.force_plates import PlateWalk, manifest_of, settled_edges
from services.bench.gait.stride_scores import match
from services.ingest.manifest import load_manifest

IC = GaitEventKind.INITIAL_CONTACT
TIME_S = np.arange(1000) / 1000


def test_an_edge_is_where_the_force_stays():
    force = np.where((TIME_S >= 0.3) & (TIME_S < 0.7), 600.0, 0.0)
    force[200:203] = 50.0  # rings
    np.testing.assert_allclose(settled_edges(TIME_S, force, rising=True), [0.3])
    np.testing.assert_allclose(settled_edges(TIME_S, force, rising=False), [0.203, 0.7])


def test_the_end_of_the_file_decides_nothing():
    force = np.where(TIME_S < 0.995, 600.0, 0.0)
    assert len(settled_edges(TIME_S, force, rising=False)) == 0


def test_the_manifest_of_another_walk(tmp_path):
    walk = PlateWalk("S05", "Lmin_08", {})
    path = tmp_path / "recording.toml"
    path.write_text(manifest_of(TEMPLATE, walk))
    manifest = load_manifest(path)
    assert (manifest.data, manifest.imu.file) == ("zju_shank_imu_gait/S05", "Lmin_08_imu.csv.gz")
    assert walk.condition == "Lmin"


def judged(condition: str, true_s: float, *found_s: float) -> Judged:
    return Judged(condition, IC, match(np.array([true_s]), np.array(found_s)), [0.02] * len(found_s))


def test_late_events_count_in_the_spread_but_not_as_detected():
    late = match(np.array([1.0, 2.0, 3.0]), np.array([1.02, 2.3]))
    assert (late.missed, detected_share(late)) == (1, pytest.approx(1 / 3))


def test_rows_judge_the_whole_and_show_the_conditions():
    rows = event_rows("S05 contact", [judged("Slow", 1.0, 1.03), judged("Fast", 1.0, 1.01, 2.0), judged("Norm", 1.0)])
    by_name = {row.name: row for row in rows}
    assert by_name["S05 contact: detected of 3"].met is False
    assert by_name["S05 contact: bias"].met is False
    assert by_name["S05 contact: bias"].value == pytest.approx(20.0)
    assert by_name["S05 contact: SD"].met is True
    assert by_name["S05 contact, slow: bias of 1"].value == pytest.approx(30.0)
    assert by_name["S05 contact, usual: bias of 1"].value is None


def test_nothing_found_is_a_missed_row():
    assert [row.met for row in event_rows("x", [judged("Slow", 1.0)])] == [False]


def test_an_unknown_subject_is_refused():
    with pytest.raises(ValueError, match="choose zju, S01, S05, voisard, gaitmap, mobgap, stroke or all"):
        run(None, "S99")


def test_without_the_recordings_the_table_says_so(monkeypatch):
    monkeypatch.setattr("services.ingest.data.data_folders", list)
    for subject in ("S05", "voisard", "gaitmap", "mobgap", "stroke"):
        assert [(row.value, row.met) for row in run(None, subject).rows] == [(None, None)]
