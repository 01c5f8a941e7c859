import numpy as np
import pytest

from services.exports.c3d.parameter_section import BLOCK, Group, Parameter, encode_groups, encode_value
from services.exports.errors import ExportError


def test_a_section_is_whole_blocks_and_says_how_many():
    data = encode_groups([Group("POINT", [Parameter("USED", 3), Parameter("TEXT", "x" * 200)])] * 3)
    assert len(data) % BLOCK == 0
    assert data[2] == len(data) // BLOCK
    assert data[3] == 84


@pytest.mark.parametrize(
    ("value", "data"),
    [
        (258, bytes([2, 0, 2, 1])),
        (-1.0, b"\x04\x00\x00\x00\x80\xbf"),
        ("ab", b"\xff\x01\x02ab"),
        (["a", "bcd"], b"\xff\x02\x03\x02a  bcd"),
        (np.array([[1, 2], [3, 4]], dtype="<i2"), bytes([2, 2, 2, 2, 1, 0, 3, 0, 2, 0, 4, 0])),
    ],
)
def test_values_are_encoded_as_the_format_says(value, data):
    assert encode_value(Parameter("X", value)) == data


def test_a_text_beyond_ascii_stays_readable():
    assert encode_value(Parameter("X", "5°")) == b"\xff\x01\x025?"


def test_too_many_entries_are_refused_by_name():
    with pytest.raises(ExportError, match=r"c3d.LABELS: 300 entries, more than 255"):
        encode_value(Parameter("LABELS", ["a"] * 300))


def test_too_much_for_the_section_is_refused():
    many = [Parameter(f"P{n}", ["x" * 200] * 100) for n in range(10)]
    with pytest.raises(ExportError, match="blocks, more than 255"):
        encode_groups([Group("G", many)])
    with pytest.raises(ExportError, match=r"c3d.P0: 40\d+ bytes, more than 32000"):
        encode_groups([Group("G", [Parameter("P0", ["x" * 200] * 200)])])
