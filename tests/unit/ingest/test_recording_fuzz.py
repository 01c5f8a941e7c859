"""Whatever stands in a recording folder: samples that are finite, or a typed error."""

import math
import tempfile
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from schemas.imu import ImuBatch
from services.ingest.errors import SourceError
from services.ingest.source import iter_messages, open_source

HEADER = "t,ax,ay,az,gx,gy,gz\n"
MANIFEST = """
title = "fuzz"
rate_hz = 10.0
[time]
column = "t"
unit = "s"
[anthropometry]
thigh_length_m = 0.4
shank_length_m = 0.4
hip_width_m = 0.2
[imu]
file = "s.csv"
specific_force = { columns = "a{axis}", unit = "m/s^2" }
angular_velocity = { columns = "g{axis}", unit = "rad/s" }
[[hub]]
[[hub.sensor]]
name = "s"
segment = "pelvis"
outward_axis = [1, 0, 0]
"""
QUIET = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])

numbers = st.one_of(
    st.floats(-20, 20).map(str),
    st.sampled_from(["nan", "inf", "-inf", "1e400", "", "1_0", "0x1", "9.81", "-", "x", "1;2", '"', "\u0664"]),
)
rows = st.lists(st.lists(numbers, min_size=6, max_size=8).map(",".join), max_size=40)


def read(manifest: str | bytes, table: str | bytes) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "recording.toml").write_bytes(manifest if isinstance(manifest, bytes) else manifest.encode())
        (folder / "s.csv").write_bytes(table if isinstance(table, bytes) else table.encode())
        try:
            source = open_source(str(folder))
        except SourceError:
            return
        last = -1
        for message in iter_messages(source):
            if isinstance(message.payload, ImuBatch):
                (samples,) = message.payload.sensors
                assert all(last < time for time in samples.captured_ns)
                last = samples.captured_ns[-1]
                vectors = samples.angular_velocity + samples.specific_force
                assert all(math.isfinite(value) for vector in vectors for value in vector)


@QUIET
@given(rows)
def test_any_table(lines):
    read(MANIFEST, HEADER + "\n".join(f"{k / 10},{line}" for k, line in enumerate(lines)))


@QUIET
@given(st.one_of(st.binary(max_size=400), st.text(max_size=400).map(lambda text: text.encode("utf-8", "ignore"))))
def test_any_bytes_as_table(data):
    read(MANIFEST, data)
    read(MANIFEST, HEADER.encode() + data)


@QUIET
@given(st.one_of(st.binary(max_size=300), st.text(max_size=300).map(lambda text: text.encode("utf-8", "ignore"))))
def test_any_bytes_as_manifest(data):
    read(data, HEADER)


values = st.recursive(
    st.one_of(
        st.integers(-(2**63), 2**63 - 1),
        st.floats(width=32),
        st.booleans(),
        st.sampled_from(['"x"', '"deg"', '"frame"']),
    ).map(lambda value: value if isinstance(value, str) else str(value).lower()),
    lambda inner: st.lists(inner, max_size=4).map(lambda items: f"[{', '.join(items)}]"),
    max_leaves=6,
)
keys = [line.partition(" =")[0] for line in MANIFEST.splitlines() if " =" in line]


@QUIET
@given(st.sampled_from(keys), values)
def test_any_value_in_the_manifest(key, value):
    lines = [f"{key} = {value}" if line.startswith(f"{key} =") else line for line in MANIFEST.splitlines()]
    table = HEADER + "\n".join(f"{k / 10},0,9.81,0,0,0,0" for k in range(30))
    read("\n".join(lines), table)
