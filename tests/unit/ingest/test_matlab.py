"""Columns out of a MATLAB file, and what is wrong with the others."""

import numpy as np
import pytest
from scipy.io import savemat

from services.ingest.errors import EmptyFile, MissingColumn, MissingFile, UnreadableFile, WrongFieldCount
from services.ingest.table import read_table

SAMPLES = np.arange(12.0).reshape(4, 3)


@pytest.fixture
def file(tmp_path):
    data = {"samples": SAMPLES, "time": np.array([0.0, 0.1, np.nan, 0.3]), "name": "hinge", "short": np.ones(2)}
    savemat(tmp_path / "a.mat", {"data": data, "bare": SAMPLES[:, 0], "empty": {"none": np.zeros((0, 2))}})
    return tmp_path / "a.mat"


def test_columns_are_counted_from_one(file):
    table = read_table(file, ["data.samples.3", "data.samples.1", "data.time.1", "bare.1"])
    np.testing.assert_array_equal(table.values[:, 0], SAMPLES[:, 2])
    np.testing.assert_array_equal(table.values[:, 1], SAMPLES[:, 0])
    np.testing.assert_array_equal(table.values[:, 2], [0.0, 0.1, np.nan, 0.3])
    np.testing.assert_array_equal(table.values[:, 3], SAMPLES[:, 0])
    np.testing.assert_array_equal(table.rows, range(4))
    assert table.malformed == 0


@pytest.mark.parametrize(
    ("column", "error", "words"),
    [
        ("data.force.1", MissingColumn, "samples, time, name, short"),
        ("other.samples.1", MissingColumn, "no 'other'"),
        ("data.samples.0", MissingColumn, "from 1 to 3"),
        ("data.samples.4", MissingColumn, "from 1 to 3"),
        ("data.samples.x", MissingColumn, "from 1 to 3"),
        ("data.name.1", MissingColumn, "no table of numbers"),
        ("samples", MissingColumn, "variable.field.number"),
        ("__header__.1", MissingColumn, "no '__header__'"),
        ("data.samples.1.2.3", MissingColumn, "no '1'"),
        ("empty.none.1", EmptyFile, "no rows"),
    ],
)
def test_what_is_not_there_is_named(file, column, error, words):
    with pytest.raises(error, match=words):
        read_table(file, [column])


def test_columns_of_different_length_make_no_table(file):
    with pytest.raises(WrongFieldCount, match=r"\[2, 4\] rows"):
        read_table(file, ["data.samples.1", "data.short.1"])


def test_a_damaged_file_and_a_missing_one(file, tmp_path):
    damaged = tmp_path / "b.mat"
    damaged.write_bytes(file.read_bytes()[:200])
    with pytest.raises(UnreadableFile, match=r"b\.mat"):
        read_table(damaged, ["data.samples.1"])
    damaged.write_text("time,x\n1,2\n")
    with pytest.raises(UnreadableFile, match=r"b\.mat"):
        read_table(damaged, ["data.samples.1"])
    with pytest.raises(MissingFile):
        read_table(tmp_path / "c.mat", ["data.samples.1"])
