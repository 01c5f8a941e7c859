"""Whatever stands in a camera's file: frames whose numbers are finite and whose states fit, or a typed error."""

import math
import tempfile
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import TrackingState
from services.ingest.errors import SourceError
from services.ingest.source import iter_messages, open_source

MANIFEST = """
title = "fuzz"
rate_hz = 30.0
[[camera]]
kind = "other"
file = "c.csv"
numbers = { each = 4, state = 4 }
format = { header = false }
joints = ["spine_base", "spine_shoulder", "shoulder_left", "shoulder_right"]
axes = ["x", "y", "z"]
"""
QUIET = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
PERSON = [-2.0, 0.0, 0.0, 2.0, -2.0, 0.5, 0.0, 2.0, -2.0, 0.5, -0.2, 2.0, -2.0, 0.5, 0.2, 2.0]

odd = st.sampled_from(["nan", "inf", "-inf", "1e400", "-1e308", "", "0", "2.5", "-1", "3", "x", "1_0", "-", "\u0664"])
damage = st.lists(st.tuples(st.integers(0, 39), st.integers(0, 15), odd), max_size=60)
anything = st.one_of(st.floats().map(str), odd)
rows = st.lists(st.lists(anything, min_size=15, max_size=17).map(",".join), max_size=30)


def read(manifest: bytes, table: bytes) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "recording.toml").write_bytes(manifest)
        (folder / "c.csv").write_bytes(table)
        try:
            source = open_source(str(folder))
        except SourceError:
            return
        last = -1
        for message in iter_messages(source):
            if not isinstance(message.payload, SkeletonBatch):
                continue
            (now,) = message.payload.captured_ns
            assert last < now
            last = now
            for at, state in zip(message.payload.position[0], message.payload.state[0], strict=True):
                assert (at is None) == (state is TrackingState.NOT_TRACKED)
                assert at is None or (math.hypot(*at) <= 20.001 and all(math.isfinite(value) for value in at))


@QUIET
@given(damage)
def test_a_person_with_any_damage(spoilt):
    table = [[str(value) for value in PERSON] for _ in range(40)]
    for row, column, text in spoilt:
        table[row][column] = text
    read(MANIFEST.encode(), "\n".join(",".join(row) for row in table).encode())


@QUIET
@given(rows)
def test_any_table(lines):
    read(MANIFEST.encode(), "\n".join(lines).encode())


@QUIET
@given(st.binary(max_size=400))
def test_any_bytes(data):
    read(MANIFEST.encode(), data)


@QUIET
@given(st.text(max_size=200))
def test_any_camera_entry(text):
    read((MANIFEST + text).encode("utf-8", "ignore"), (",".join(map(str, PERSON)) + "\n").encode() * 3)
