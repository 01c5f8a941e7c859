"""A small recording folder to spoil in every way."""

import csv
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

HEADER = ["t", "ax", "ay", "az", "gx", "gy", "gz"]
TOML = """
title = "two sensors"
rate_hz = 50.0

[time]
column = "t"
unit = "s"

[anthropometry]
thigh_length_m = 0.4
shank_length_m = 0.4
hip_width_m = 0.18

[imu]
file = "{sensor}.csv"
specific_force = { columns = "a{axis}", unit = "m/s^2" }
angular_velocity = { columns = "g{axis}", unit = "rad/s" }

[[hub]]
name = "hub"

[[hub.sensor]]
name = "thigh"
segment = "thigh_right"
outward_axis = [0, 0, 2]

[[hub.sensor]]
name = "shank"
segment = "shank_right"
outward_axis = [0, 0, 1]

[[reference]]
file = "truth.csv"
channel = [{ name = "knee_flexion_right", column = "knee", unit = "deg", sign = -1 }]
point = [{ name = "ankle_right", columns = "p{AXIS}", unit = "mm", axes = ["x", "z", "-y"] }]
"""


def still_rows(count: int = 200) -> list[list[str]]:
    """A sensor that lies still for two seconds and then turns a little about x."""
    rng = np.random.default_rng(0)
    rows = []
    for k in range(count):
        turning = 1.0 if k > 120 else 0.0
        force, rate = rng.normal([0, 9.81, 0], 0.02), rng.normal([turning, 0, 0], 0.005)
        values = [k / 50, *force, *rate]
        rows.append([f"{value:.6g}" for value in values])
    return rows


class Folder:
    """The recording as text, to be changed before it is written."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.toml = TOML
        self.tables = {"thigh.csv": [HEADER, *still_rows()], "shank.csv": [HEADER, *still_rows()]}
        self.tables["truth.csv"] = [["t", "knee", "pX", "pY", "pZ"]]
        self.tables["truth.csv"] += [[f"{k / 50:.2f}", "-30", "1000", "2000", "500"] for k in range(200)]

    def write(self) -> Path:
        self.path.mkdir(exist_ok=True)
        (self.path / "recording.toml").write_text(self.toml)
        for name, rows in self.tables.items():
            with (self.path / name).open("w", newline="") as file:
                csv.writer(file).writerows(rows)
        return self.path

    def scaled(self, name: str, columns: slice, factor: float) -> None:
        for row in self.tables[name][1:]:
            row[columns] = [f"{float(text) * factor:.9g}" for text in row[columns]]


@pytest.fixture
def folder(tmp_path):
    return Folder(tmp_path / "recording")


@pytest.fixture
def columns():
    return SimpleNamespace(time=slice(0, 1), force=slice(1, 4), rate=slice(4, 7))
