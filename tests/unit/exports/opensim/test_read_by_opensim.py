"""Files are read back with OpenSim itself, which takes seconds to load: everything about it is in this module."""

import numpy as np
import pytest

from services.exports.facts import Facts
from services.exports.joint_positions import joint_positions
from services.exports.motion import gather_motion
from services.exports.opensim.coordinates import to_coordinates
from services.exports.opensim.marker_file import marker_file
from services.exports.opensim.models import GAIT_10DOF, RAJAGOPAL, known_model
from services.exports.opensim.storage_file import storage_file
from services.exports.session import facts_of


@pytest.fixture(scope="module")
def opensim():
    library = pytest.importorskip("opensim")
    library.Logger.removeFileSink()  # else it writes opensim.log into the folder that the tests run in
    return library


def markers(opensim, path):
    """Labels and (n, m, 3) mm."""
    table = opensim.TimeSeriesTableVec3(str(path))
    labels = list(table.getColumnLabels())
    columns = [table.getDependentColumn(label) for label in labels]
    rows = range(table.getNumRows())
    return labels, np.array([[[column[row][axis] for axis in range(3)] for column in columns] for row in rows])


@pytest.mark.parametrize("in_degrees", [True, False])
@pytest.mark.parametrize("name", [RAJAGOPAL, GAIT_10DOF])
def test_coordinates_come_back_within_a_ten_thousandth_of_a_radian(opensim, tmp_path, about, made, name, in_degrees):
    motion = gather_motion(made.joint_states())
    model = known_model(name)
    coordinates = to_coordinates(motion, model)
    path = tmp_path / ("session.mot" if in_degrees else "session.sto")
    path.write_bytes(b"".join(storage_file(Facts(about), model, coordinates, in_degrees=in_degrees)))
    table = opensim.TimeSeriesTable(str(path))
    values = table.getMatrix().to_numpy()
    assert tuple(table.getColumnLabels()) == coordinates.names
    assert table.getTableMetaDataString("inDegrees") == ("yes" if in_degrees else "no")
    assert np.abs((np.radians(values) if in_degrees else values) - coordinates.values).max() < 1e-4
    np.testing.assert_allclose(table.getIndependentColumn(), coordinates.times_ns * 1e-9, atol=1e-7)
    assert opensim.Storage(str(path)).isInDegrees() is in_degrees


def test_the_head_says_session_datum_signs_and_what_is_missing(walk):
    model = known_model(GAIT_10DOF)
    motion = gather_motion(walk.payloads(*_motion()))
    coordinates = to_coordinates(motion, model)
    head = next(storage_file(facts_of(walk), model, coordinates, in_degrees=True)).decode()
    assert "datum of angles: quiet standing" in head
    assert "knee_angle_r -knee_flexion_right" in head
    assert "not told: ankle_angle_r, ankle_angle_l" in head
    assert head.index("inDegrees=yes") < head.index("endheader\ntime\tpelvis_tilt")


def test_joint_centres_come_back_in_millimetres(opensim, tmp_path, about, made):
    motion = gather_motion(made.joint_states(count=60))
    path = tmp_path / "session.trc"
    path.write_bytes(b"".join(marker_file(Facts(about), motion, path.name)))
    labels, found = markers(opensim, path)
    assert labels == ["RHJC", "RKJC", "RAJC", "LHJC", "LKJC", "LAJC"]
    expected = joint_positions(motion, about.anthropometry).track.value * 1000
    np.testing.assert_allclose(found, expected, atol=1e-4)
    assert opensim.MarkerData(str(path)).getUnits().getLabel() == "millimeters"


def test_a_centre_that_is_not_seen_is_empty(opensim, tmp_path, seen):
    """The last column is the left ankle: an empty end of a line must still be a column."""
    motion = gather_motion(seen.payloads(*_motion()))
    motion.centres.valid[10:20, -1] = False
    path = tmp_path / "session.trc"
    path.write_bytes(b"".join(marker_file(facts_of(seen), motion, path.name)))
    labels, found = markers(opensim, path)
    assert np.isnan(found[:, labels.index("LWJC")]).all()
    assert np.flatnonzero(np.isnan(found[:, labels.index("LAJC"), 0])).tolist() == list(range(10, 20))
    assert opensim.MarkerData(str(path)).getNumFrames() == 120


def _motion():
    from schemas.signals import JOINT_CENTRES, JOINT_STATE

    return JOINT_STATE, JOINT_CENTRES
