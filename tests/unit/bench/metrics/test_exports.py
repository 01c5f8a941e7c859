import numpy as np
import pytest

from schemas.vocabulary import LOWER_BODY, JointCentre
from services.bench.metrics import exports
from services.exports.joint_positions import LEG_CENTRES, Positions
from services.exports.motion import Motion, Track

TIMES = np.arange(20) * 10_000_000


class Table:
    """What OpenSim would have read."""

    def __init__(self, labels, columns):
        self.labels, self.columns = labels, columns

    def getColumnLabels(self):
        return self.labels

    def getNumRows(self):
        return len(TIMES)

    def getDependentColumn(self, label):
        return self.columns[self.labels.index(label)].tolist()

    def getMatrix(self):
        return self

    def to_numpy(self):
        return np.stack(self.columns, axis=1)


class OpenSim:
    def __init__(self, table):
        self.TimeSeriesTable = self.TimeSeriesTableVec3 = lambda _: table


@pytest.fixture
def knee(tmp_path):
    value, valid = np.zeros((20, len(LOWER_BODY), 1)), np.zeros((20, len(LOWER_BODY)), dtype=bool)
    value[:, 6, 0], valid[:, 6] = np.linspace(0.1, 1.0, 20), True
    return Motion("lower_body", Track(TIMES, value, valid), None)


@pytest.mark.parametrize(("model", "sign"), [("rajagopal", 1), ("gait10dof18musc", -1)])
def test_the_error_of_coordinates_is_the_largest_of_all(tmp_path, knee, model, sign):
    read = sign * np.degrees(knee.angles.value[:, 6, 0])
    read[7] += np.degrees(0.02)
    found = OpenSim(Table(["knee_angle_r"], [read]))
    assert exports.storage_error(found, tmp_path, knee, model, in_degrees=True) == pytest.approx(0.02)


def test_a_column_too_many_is_no_round_trip(tmp_path, knee):
    found = OpenSim(Table(["knee_angle_r", "more"], [np.zeros(20), np.zeros(20)]))
    with pytest.raises(ValueError, match="has the columns"):
        exports.storage_error(found, tmp_path, knee, "rajagopal", in_degrees=True)


def legs(bent):
    """Hip, knee and ankle of both legs, (20, 6, 3) m, knees bent by (20,) rad."""
    shank = np.stack([-np.sin(bent), -np.cos(bent), 0 * bent], axis=1)
    knee = np.broadcast_to([0.0, -0.4, 0.1], (20, 3))
    leg = np.stack([np.broadcast_to([0.0, 0.0, 0.1], (20, 3)), knee, knee + 0.4 * shank], axis=1)
    return np.concatenate([leg, leg * [1, 1, -1]], axis=1)


def test_the_error_of_joint_centres_is_that_of_the_knee(tmp_path):
    bent = np.linspace(0.0, 1.2, 20)
    np.testing.assert_allclose(exports.knee_angles(legs(bent)[:, :3]), bent, atol=1e-12)
    positions = Positions(LEG_CENTRES, Track(TIMES, legs(bent), np.ones((20, 6), dtype=bool)), "")
    labels = [exports.LABELS[JointCentre(centre)] for centre in LEG_CENTRES]
    read = legs(bent + 0.01 * (np.arange(20) == 5)) * 1000
    found = OpenSim(Table(labels, list(read.transpose(1, 0, 2))))
    assert exports.marker_error(found, tmp_path, positions, 100.0) == pytest.approx(0.01)
    read[3, 2] = np.nan
    with pytest.raises(ValueError, match="other frames of the right leg are valid"):
        exports.marker_error(found, tmp_path, positions, 100.0)


def test_without_the_other_program_the_row_says_why():
    (row,) = exports._against("a_program_that_is_not_here", "walk: .mot", lambda _: 0.0)
    assert (row.value, row.met) == (None, None)
    assert "not installed" in row.target


def test_an_error_above_the_limit_is_missed():
    (row,) = exports._against("json", "walk: .mot", lambda _: 2e-4)
    assert row.met is False
