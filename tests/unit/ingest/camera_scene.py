"""A recording of depth cameras as text, to be spoilt before it is written."""

import numpy as np

from services.ingest.skeleton import AZURE_KINECT_JOINTS, KINECT_V2_JOINTS
from services.ingest.source import open_source
from tests.unit.ingest.posed_person import in_room, seen_by_azure, seen_by_kinect_v2

HEAD_TOML = 'title = "a person"\nrate_hz = 30.0\n'
KINECT = """
[[camera]]
name = "kinect"
kind = "kinect_v2"
file = "kinect.csv"
numbers = { each = 4, state = 4 }
format = { header = false }
"""
AZURE = """
[[camera]]
name = "azure"
kind = "azure_kinect"
file = "azure.csv"
columns = { position = "{joint}_{AXIS}", state = "{joint}_CONFIDENCE", names = [NAMES] }
time = { column = "t", unit = "us" }
""".replace("NAMES", ", ".join(f'"J{k}"' for k in range(32)))
HUB = """
[anthropometry]
thigh_length_m = 0.4
shank_length_m = 0.4
hip_width_m = 0.18

[[hub]]
name = "hub"

[[hub.sensor]]
name = "thigh"
segment = "thigh_right"
outward_axis = [0, 0, 1]
file = "thigh.csv"
specific_force = { columns = "a{axis}", unit = "m/s^2" }
angular_velocity = { columns = "g{axis}", unit = "rad/s" }
"""


class Scene:
    """A recording of a camera as text, to be spoilt before it is written."""

    def __init__(self, path):
        self.path = path
        self.toml = HEAD_TOML + KINECT
        self.rows = [[*self.kinect_row(k)] for k in range(60)]
        self.azure_rows = [["t", *(f"J{j}_{name}" for j in range(32) for name in ("X", "Y", "Z", "CONFIDENCE"))]]
        self.azure_rows += [[str(33_333 * k), *self.azure_row()] for k in range(60)]

    @staticmethod
    def kinect_row(k):
        """The person sways by 3 cm, so that frames differ; a trailing comma as in KIMORE."""
        sway = np.array([0.0, 0.0, 0.03 * np.sin(k)])
        numbers = [(*seen_by_kinect_v2(in_room(joint) + sway), 2) for joint in KINECT_V2_JOINTS]
        return [f"{value:.6g}" for joint in numbers for value in joint] + [""]

    @staticmethod
    def azure_row():
        numbers = [(*seen_by_azure(in_room(joint)), 2) for joint in AZURE_KINECT_JOINTS]
        return [f"{value:.6g}" for joint in numbers for value in joint]

    def write(self):
        self.path.mkdir(exist_ok=True)
        (self.path / "recording.toml").write_text(self.toml)
        (self.path / "kinect.csv").write_text("".join(",".join(row) + "\n" for row in self.rows))
        (self.path / "azure.csv").write_text("".join(",".join(row) + "\n" for row in self.azure_rows))
        still = "ax,ay,az,gx,gy,gz\n" + "".join(f"0,9.81,{0.001 * (k % 3)},0,0,0.001\n" for k in range(60))
        (self.path / "thigh.csv").write_text(still)
        return str(self.path)

    def opened(self, **choices):
        return open_source(self.write(), session="s1", **choices)

    def scaled(self, factor):
        for row in self.rows:
            for at in range(100):
                if at % 4 < 3:
                    row[at] = f"{float(row[at]) * factor:.9g}"
