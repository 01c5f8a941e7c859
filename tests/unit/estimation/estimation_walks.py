"""Sessions for the tests of estimation: descriptions, messages and a body that stands and walks."""

import json
from collections.abc import Iterable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ImuBatch, SensorSamples
from schemas.kinematics import Calibration, JointState, LivePose
from schemas.rhythm import Rhythm
from schemas.session import (
    Anthropometry,
    HubDescription,
    Placement,
    SensorDescription,
    SessionDescription,
    StandingInterval,
    WalkPath,
)
from schemas.signals import IMU
from schemas.vocabulary import LOWER_BODY, Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.biomech.pinocchio_model import PinocchioBody
from services.biomech.rotations import rotation_about
from services.estimation.lower_body.node import LowerBodyNode
from services.flow.message import Envelope, Message, Output, Stream

Array = NDArray[np.float64]

BODY = Anthropometry(
    height_m=1.75, mass_kg=70, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="measured"
)
MODEL = LowerBodyModel(BODY)
NAMES = [dof.name for dof in LOWER_BODY]
STANDING_S, RATE_HZ = 2.5, 100.0
PLACEMENTS = dict.fromkeys(SEGMENTS, Placement.ANTERIOR) | {Segment.PELVIS: Placement.POSTERIOR}


@cache
def mounting() -> dict[Segment, Array]:
    """R_segment_from_sensor: sensor z out of the skin (anterior, or posterior at the pelvis), turned about it."""
    frames = {}
    for k, segment in enumerate(SEGMENTS):
        # Columns are the sensor's axes in the segment: x down, y left, z forward for an anterior sensor.
        anterior = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
        around = rotation_about(np.array([0.0, 1.0, 0.0]), np.pi) if segment is Segment.PELVIS else np.eye(3)
        frames[segment] = around @ anterior @ rotation_about(np.array([0.0, 0.0, 1.0]), 0.3 * k - 0.5)
    return frames


def describe(
    *,
    hubs: Sequence[Sequence[Segment]] = (SEGMENTS,),
    estimator: str = "ekf",
    walk_path: WalkPath = "turning",
    standing: Sequence[StandingInterval] = (),
    placements: dict[Segment, Placement] | None = None,
) -> SessionDescription:
    sides = PLACEMENTS if placements is None else placements

    def sensor(segment: Segment) -> SensorDescription:
        return SensorDescription(
            name=segment.value, segment=segment, rate_hz=RATE_HZ, outward_axis=[0.0, 0.0, 1.0],
            placement=sides.get(segment, Placement.UNKNOWN), position_in_segment=None,
        )  # fmt: skip

    return SessionDescription(
        session="s", title="test", started_unix_ns=0, origin="synthetic", protocol="stand, walk", estimator=estimator,
        walk_path=walk_path,
        hubs=[HubDescription(name=f"hub{i}", sensors=[sensor(s) for s in names]) for i, names in enumerate(hubs)],
        anthropometry=BODY, standing=list(standing), reference=[], duration_s=None,
    )  # fmt: skip


def pose(t: float) -> Array:
    """Joint coordinates (3, 15) after t seconds: standing, then a stride a second, eased in over half a second."""
    x = np.zeros((3, 15))
    walked = t - STANDING_S
    if walked <= 0.0:
        return x
    step = 1e-3
    x[0] = _angles(walked)
    x[1] = (_angles(walked + step) - _angles(walked - step)) / (2 * step)
    x[2] = (_angles(walked + step) - 2 * _angles(walked) + _angles(walked - step)) / step**2
    return x


def _angles(walked: float) -> Array:
    ease = min(max(walked, 0.0) / 0.5, 1.0)
    ease = ease * ease * (3.0 - 2.0 * ease)
    angles = dict.fromkeys(NAMES, 0.0)
    for side, phase in (("right", 0.0), ("left", np.pi)):
        p = 2.0 * np.pi * walked + phase
        angles[f"hip_flexion_{side}"] = 0.15 + 0.4 * np.cos(p)
        # One large flexion in swing, a small one in stance; the swing comes before the thigh is farthest forward.
        angles[f"knee_flexion_{side}"] = 0.45 + 0.42 * np.cos(p + 1.1) + 0.18 * np.cos(2.0 * p + 2.6)
        angles[f"hip_adduction_{side}"] = 0.05 * np.sin(p)
    angles["pelvis_rotation"] = 0.06 * np.sin(2.0 * np.pi * walked)
    return ease * np.array(list(angles.values()))


@cache
def walk(seconds: float = 9.0, noise: float = 0.02, seed: int = 0) -> tuple[Array, Array]:
    """Truth (n, 15) rad and samples (n, 5, 6) of the sensors in the order of SEGMENTS; gyro bias included."""
    random = np.random.default_rng(seed)
    oracle = PinocchioBody(MODEL, [SensorMount(segment, mounting()[segment]) for segment in SEGMENTS])
    states = [pose(k / RATE_HZ) for k in range(int(seconds * RATE_HZ))]
    samples = np.array([[oracle.sample(s, x) for s in range(5)] for x in states])
    samples += noise * random.normal(size=samples.shape)
    samples[:, :, :3] += gyro_bias()
    return np.array([x[0] for x in states]), samples


def gyro_bias() -> Array:
    return np.random.default_rng(8).normal(size=(5, 3)) * 0.01


def messages(
    description: SessionDescription, samples: Array, *, ticks: int = 1, offset_ns: Sequence[int] = (0, 0, 0)
) -> list[Message]:
    """imu messages of all hubs in the order of capture."""
    rates, forces = samples[:, :, :3].tolist(), samples[:, :, 3:].tolist()
    result = []
    for i, hub in enumerate(description.hubs):
        rows = [SEGMENTS.index(sensor.segment) for sensor in hub.sensors]
        for sequence, start in enumerate(range(0, len(samples) - ticks + 1, ticks)):
            numbers = range(start, start + ticks)
            times = [k * 10_000_000 + offset_ns[i] for k in numbers]
            # Checking thousands of plain numbers costs more than what is tested with them.
            spoken = [
                SensorSamples.model_construct(
                    captured_ns=times,
                    angular_velocity=[rates[k][row] for k in numbers],
                    specific_force=[forces[k][row] for k in numbers],
                )
                for row in rows
            ]
            batch = ImuBatch.model_construct(sensors=spoken, marks=[])
            result.append(Message(Stream(IMU, hub.name), Envelope(0, sequence, times[-1]), batch))
    return sorted(result, key=lambda message: message.envelope.captured_ns)


def sensor_samples(times: Sequence[int], values: Array) -> SensorSamples:
    return SensorSamples(
        captured_ns=list(times), angular_velocity=values[:, :3].tolist(), specific_force=values[:, 3:].tolist()
    )


def run(node: LowerBodyNode, stream: Iterable[Message]) -> list[Output]:
    outputs = [output for message in stream for output in node.step(message)]
    return outputs + node.finish()


class Kept(NamedTuple):
    """A node that was frozen: after how many outputs, and its state as JSON text."""

    outputs: int
    state: str


def run_and_freeze(node: LowerBodyNode, stream: Sequence[Message], splits: Iterable[int]) -> tuple[list[Output], dict]:
    """All outputs of a node, and what was `Kept` of it before each of these messages."""
    outputs, kept = [], {}
    for number, message in enumerate(stream):
        if number in splits:
            kept[number] = Kept(len(outputs), json.dumps(node.snapshot()))
        outputs += node.step(message)
    return outputs + node.finish(), kept


def text(outputs: Iterable[Output]) -> list[tuple[str, int, str]]:
    return [(output.signal.name, output.captured_ns, output.payload.model_dump_json()) for output in outputs]


def joint_states(outputs: Iterable[Output]) -> list[JointState]:
    return [output.payload for output in outputs if isinstance(output.payload, JointState)]


def rhythms(outputs: Iterable[Output]) -> list[Rhythm]:
    return [output.payload for output in outputs if isinstance(output.payload, Rhythm)]


def calibrations(outputs: Iterable[Output]) -> list[Calibration]:
    return [output.payload for output in outputs if isinstance(output.payload, Calibration)]


def pictures(outputs: Iterable[Output]) -> list[LivePose]:
    return [output.payload for output in outputs if isinstance(output.payload, LivePose)]


def angles(outputs: Iterable[Output], name: str) -> dict[int, float]:
    """One degree of freedom by time, rad."""
    i = NAMES.index(name)
    return {
        captured_ns: row[i]
        for state in joint_states(outputs)
        for captured_ns, row in zip(state.captured_ns, state.position, strict=True)
    }
