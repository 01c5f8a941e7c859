"""Motion of the segments whose lone sensor tells gait events: the lower back, and feet.

Acceleration without gravity and angular velocity, in the segment's heading frame (x forward, y up, z right). Only the
vertical has to be known for it. For the pelvis it is the filter's; a foot is no part of the body model, and its
vertical is followed here.
"""

import math
from collections.abc import Sequence

import numpy as np

from schemas.kinematics import SegmentMotion, SegmentSamples
from schemas.session import SensorDescription
from schemas.vocabulary import Segment
from services.biomech.rotations import Array
from services.estimation.parameters import SegmentMotionParameters
from services.estimation.samples import Tick
from services.flow.node import State

Vector = tuple[float, float, float]
UPRIGHT: Vector = (0.0, 1.0, 0.0)


def pelvis_up(tilt: float, obliquity: float) -> Vector:
    """The vertical in the pelvis frame, for its angles in rad.

    R_heading_from_pelvis = R(-z, tilt) R(-x, obliquity); the vertical is its second row.
    """
    return (-math.sin(tilt), math.cos(tilt) * math.cos(obliquity), math.cos(tilt) * math.sin(obliquity))


def into_heading(up: Vector, vector: Vector) -> Vector:
    """A vector of the segment frame in its heading frame; `up` is the vertical in the segment frame.

    forward = up x z / |up x z|, right = forward x up. With the right axis upright there is no heading, and any will do.
    """
    x, y, z = up
    level = math.hypot(x, y)
    fx, fy = (y / level, -x / level) if level > 1e-6 else (1.0, 0.0)
    a, b, c = vector
    return (fx * a + fy * b, x * a + y * b + z * c, fy * z * a - fx * z * b + (fx * y - fy * x) * c)


class Vertical:
    """The vertical in the frame of a segment: turned by the gyroscope, drawn slowly to the specific force."""

    def __init__(self, parameters: SegmentMotionParameters) -> None:
        self._parameters = parameters
        self.up: Vector = UPRIGHT
        self.last_ns: int | None = None

    def step(self, captured_ns: int, rate: Vector, force: Vector) -> Vector:
        """Take a sample, rad/s and m/s^2 in the segment frame. d(up)/dt = up x rate."""
        p = self._parameters
        dt_s = 0.0 if self.last_ns is None else (captured_ns - self.last_ns) * 1e-9
        self.last_ns = captured_ns
        if dt_s > p.longest_step_s:
            self.up, dt_s = UPRIGHT, 0.0
        up = _turned(self.up, rate, -dt_s)
        pull = dt_s / (p.tilt_time * p.gravity)
        x, y, z = (u + pull * f for u, f in zip(up, force, strict=True))
        length = math.sqrt(x * x + y * y + z * z)
        self.up = (x / length, y / length, z / length) if length > 0.1 else UPRIGHT
        return self.up


def _turned(vector: Vector, rate: Vector, seconds: float) -> Vector:
    """Rodrigues: the vector turned about `rate` for some seconds."""
    speed = math.sqrt(sum(r * r for r in rate))
    if speed * abs(seconds) < 1e-12:
        return vector
    x, y, z = (r / speed for r in rate)
    a, b, c = vector
    cos, sin = math.cos(speed * seconds), math.sin(speed * seconds)
    along = (x * a + y * b + z * c) * (1.0 - cos)
    return (
        a * cos + (y * c - z * b) * sin + x * along,
        b * cos + (z * a - x * c) * sin + y * along,
        c * cos + (x * b - y * a) * sin + z * along,
    )


class LoneSegments:
    """Gathers the motion of some sensors' segments between two messages."""

    def __init__(
        self,
        sensors: Sequence[SensorDescription],
        segments: Sequence[Segment],
        R_segment_from_sensor: Array,
        gyro_bias: Array,
        aligned: Sequence[bool],
        parameters: SegmentMotionParameters,
    ) -> None:
        self._gravity = parameters.gravity
        wanted = [s for s, sensor in enumerate(sensors) if sensor.segment in segments and aligned[s]]
        self._segments = {s: sensors[s].segment for s in wanted}
        self._frames = {s: R_segment_from_sensor[s] for s in wanted}
        self._bias = {s: gyro_bias[s] for s in wanted}
        self._verticals = {s: Vertical(parameters) for s in wanted if sensors[s].segment is not Segment.PELVIS}
        self._rows: dict[int, list[tuple[int, Vector, Vector]]] = {s: [] for s in wanted}

    def believe(self, gyro_bias: Array) -> None:
        """From now on these are the biases (S, 3) of all sensors, rad/s."""
        self._bias = {s: gyro_bias[s] for s in self._bias}

    def take(self, tick: Tick, tilt: float, obliquity: float) -> None:
        """Take the fresh samples of a tick, with the pelvis angles (rad) at that time."""
        for s, rows in self._rows.items():
            if not tick.fresh[s]:
                continue
            frame, sample = self._frames[s], tick.samples[s]
            rate = _vector(frame @ (sample[:3] - self._bias[s]))
            force = _vector(frame @ sample[3:])
            vertical = self._verticals.get(s)
            up = pelvis_up(tilt, obliquity) if vertical is None else vertical.step(tick.captured_ns, rate, force)
            forward, upward, right = into_heading(up, force)
            rows.append((tick.captured_ns, (forward, upward - self._gravity, right), into_heading(up, rate)))

    def collect(self, captured_ns: list[int]) -> SegmentMotion:
        """What was gathered, for the joint states of the given times."""
        segments = [
            SegmentSamples(
                segment=self._segments[s],
                captured_ns=[row[0] for row in rows],
                acceleration=[list(row[1]) for row in rows],
                angular_velocity=[list(row[2]) for row in rows],
            )
            for s, rows in self._rows.items()
        ]
        self._rows = {s: [] for s in self._rows}
        return SegmentMotion(captured_ns=captured_ns, segments=segments)

    def snapshot(self) -> State:
        """The verticals of the feet; between messages nothing else is kept."""
        return {"verticals": [[vertical.last_ns, *vertical.up] for vertical in self._verticals.values()]}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        for vertical, (last_ns, x, y, z) in zip(self._verticals.values(), state["verticals"], strict=True):
            vertical.last_ns, vertical.up = last_ns, (x, y, z)


def _vector(values: Array) -> Vector:
    x, y, z = np.asarray(values).tolist()
    return (x, y, z)
