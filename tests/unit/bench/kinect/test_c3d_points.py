"""Points of C3D files, on a file written here as the format says."""

import struct

import numpy as np
import pytest

from services.bench.kinect.c3d_points import read_points


def record(group, name, body, *, last=False):
    text = name.encode()
    return struct.pack("<bb", len(text), group) + text + struct.pack("<h", 0 if last else len(body) + 2) + body


def words(*texts, width=32):
    return struct.pack("<bBBB", -1, 2, width, len(texts)) + b"".join(t.ljust(width).encode() for t in texts) + b"\0"


def c3d(points, labels, *, analogs=2, rate_hz=120.0, scale=-0.1, processor=84):
    """Header, one block of parameters, and the frames; `points` (n, m, 3), NaN where invalid."""
    n, m = points.shape[:2]
    header = bytearray(512)
    struct.pack_into("<BBHHHH", header, 0, 2, 0x50, m, analogs, 11, 10 + n)
    struct.pack_into("<fHHf", header, 12, scale, 3, 0, rate_hz)
    parameters = bytes([1, 0x50, 1, processor])
    parameters += record(-1, "POINT", b"\0") + record(-2, "ANALOG", b"\0")
    parameters += record(1, "LABELS", words(*labels[:2])) + record(2, "LABELS", words("force"))
    parameters += record(1, "LABELS2", words(*labels[2:]), last=True)
    frames = b""
    for frame in points:
        for x, y, z in frame:
            valid = np.isfinite(x)
            frames += struct.pack("<4f", x if valid else 0, y if valid else 0, z if valid else 0, 0.0 if valid else -1)
        frames += struct.pack(f"<{analogs}f", *range(analogs))
    return bytes(header) + parameters.ljust(512, b"\0") + frames


@pytest.fixture
def file(tmp_path):
    return tmp_path / "made.c3d"


def test_points_come_by_name_with_their_rate(file):
    points = np.random.default_rng(1).normal(0.0, 500.0, (7, 3, 3)).astype(np.float32).astype(float)
    points[4, 1] = np.nan
    file.write_bytes(c3d(points, ["RKneeAngles", "Somebody:LHipAngles", "LASI"]))
    read = read_points(file)
    assert read.rate_hz == 120.0
    assert read.names == ("RKneeAngles", "Somebody:LHipAngles", "LASI")
    assert np.array_equal(read.values, points, equal_nan=True)
    assert np.array_equal(read.of("LHipAngles"), points[:, 1], equal_nan=True)
    with pytest.raises(KeyError):
        read.of("RHipAngles")


def test_a_file_cut_short_gives_its_whole_frames(file):
    points = np.ones((6, 3, 3))
    file.write_bytes(c3d(points, ["a", "b", "c"])[:-10])
    assert len(read_points(file).values) == 5


@pytest.mark.parametrize(
    ("made", "word"),
    [
        (b"", "no C3D"),
        (b"x" * 2000, "no C3D"),
        (c3d(np.ones((2, 3, 3)), ["a", "b", "c"], scale=0.1), "whole numbers"),
        (c3d(np.ones((2, 3, 3)), ["a", "b", "c"], processor=85), "processor"),
    ],
)
def test_other_files_are_refused(file, made, word):
    file.write_bytes(made)
    with pytest.raises(ValueError, match=word):
        read_points(file)
