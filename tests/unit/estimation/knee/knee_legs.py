"""A synthetic leg in a session of its own: description, messages, and what the node says of them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from schemas.imu import ImuBatch, SensorSamples
from schemas.kinematics import Calibration, JointState, LivePose
from schemas.session import (
    Anthropometry,
    HubDescription,
    Placement,
    SensorDescription,
    SessionDescription,
)
from schemas.signals import IMU
from schemas.standing import StandingMark
from schemas.vocabulary import LOWER_BODY, Segment, Side, Task
from services.bench.knee.legs import LegRecording, Motion, Sensors, record, walking
from services.estimation.knee.node import KneeNode
from services.flow.message import Envelope, Message, Output, Stream
from services.flow.node import Node

NAMES = [dof.name for dof in LOWER_BODY]
RATE_HZ = 50.0
OUT_OF_THE_LEFT_LEG, UP = np.array([0.0, 0.0, -1.0]), np.array([0.0, 1.0, 0.0])
HALF_TURN = np.diag([-1.0, -1.0, 1.0])
"""About the axis out of the skin: how a sensor is put on upside down."""


def mounting(seed: int = 0, spread: float = 0.2) -> np.ndarray:
    """R_sensor_from_segment (2, 3, 3): x of the case up the left leg, z out of its outer side, put on by hand."""
    nominal = np.column_stack([UP, np.cross(OUT_OF_THE_LEFT_LEG, UP), OUT_OF_THE_LEFT_LEG])
    rng = np.random.default_rng(seed)
    turns = Rotation.from_rotvec(rng.uniform(-spread, spread, (2, 3))).as_matrix()
    return np.stack([(turn @ nominal).T for turn in turns])


def leg(motion: Motion | None = None, seconds: float = 16.0, seed: int = 0, rate_hz: float = RATE_HZ) -> LegRecording:
    """Samples with noise, biases and a little soft tissue."""
    bias = np.random.default_rng([seed, 1]).normal(0.0, 0.01, (2, 3))
    sensors = Sensors(mounting(seed), bias, 0.005, 0.05, 0.02)
    return record(motion or walking(), seconds, rate_hz, sensors, seed)


def describe(
    side: Side = Side.LEFT,
    *,
    estimator: str = "knee_axis",
    placement: Placement = Placement.LATERAL,
    upward: Sequence[float] | None = (1.0, 0.0, 0.0),
    hubs: Sequence[Sequence[Segment]] | None = None,
    rates_hz: Sequence[float] | None = None,
) -> SessionDescription:
    """Thigh and shank of one leg, on one hub or as `hubs` says."""
    worn = hubs or [[Segment(f"thigh_{side}"), Segment(f"shank_{side}")]]
    rates = list(rates_hz or [RATE_HZ] * sum(map(len, worn)))

    def sensor(segment: Segment) -> SensorDescription:
        return SensorDescription(
            name=segment.value, segment=segment, rate_hz=rates.pop(0), outward_axis=[0.0, 0.0, 1.0],
            upward_axis=None if upward is None else list(upward), placement=placement, position_in_segment=None,
        )  # fmt: skip

    described = [
        HubDescription(name=f"hub_{i}", sensors=[sensor(segment) for segment in each]) for i, each in enumerate(worn)
    ]
    body = Anthropometry(
        height_m=None, mass_kg=None, thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="default"
    )
    return SessionDescription(
        session="knee", title="", started_unix_ns=0, origin="synthetic", protocol="", task=Task.WALK, walkway_m=None,
        estimator=estimator, walk_path="turning", hubs=described, anthropometry=body, standing=[], reference=[],
        duration_s=None, known_rhythms=[],
    )  # fmt: skip


def samples(recording: LegRecording, s: int, rows: slice, rate_hz: float = RATE_HZ) -> SensorSamples:
    """Some rows of one sensor."""
    numbers = range(*rows.indices(len(recording.rate)))
    return SensorSamples(
        captured_ns=[time_ns(k, rate_hz) for k in numbers],
        angular_velocity=recording.rate[rows, s].tolist(),
        specific_force=recording.force[rows, s].tolist(),
    )


def time_ns(k: int, rate_hz: float = RATE_HZ) -> int:
    """When sample k was captured."""
    return round((k + 1) * 1e9 / rate_hz)


def messages(recording: LegRecording, ticks: int = 1, rate_hz: float = RATE_HZ) -> list[Message]:
    """Both sensors on one hub, `ticks` samples a message."""
    starts = range(0, len(recording.rate), ticks)
    stream = Stream(IMU, "hub_0")
    made = []
    for number, k in enumerate(starts):
        rows = slice(k, min(k + ticks, len(recording.rate)))
        batch = ImuBatch(sensors=[samples(recording, s, rows, rate_hz) for s in range(2)], marks=[])
        made.append(Message(stream, Envelope(0, number, time_ns(rows.stop - 1, rate_hz)), batch))
    return made


def marked(stream: Sequence[Message], from_s: float, to_s: float, given_s: float) -> list[Message]:
    """The messages, with a mark in the first one later than it was given."""
    mark = StandingMark(from_ns=round(from_s * 1e9), to_ns=round(to_s * 1e9), given_ns=round(given_s * 1e9))
    first = next(i for i, message in enumerate(stream) if message.envelope.captured_ns > mark.given_ns)
    batch = stream[first].payload
    assert isinstance(batch, ImuBatch)
    with_mark = replace(stream[first], payload=batch.model_copy(update={"marks": [mark]}))
    return [*stream[:first], with_mark, *stream[first + 1 :]]


def run(node: Node, stream: Sequence[Message]) -> list[Output]:
    """All outputs, those of the end included."""
    return [output for message in stream for output in node.step(message)] + node.finish()


def node(description: SessionDescription | None = None) -> KneeNode:
    """Of a knee session."""
    return KneeNode(description or describe())


def states(outputs: Sequence[Output]) -> list[JointState]:
    """Joint states among the outputs."""
    return [output.payload for output in outputs if isinstance(output.payload, JointState)]


def calibrations(outputs: Sequence[Output]) -> list[Calibration]:
    """Calibrations among the outputs."""
    return [output.payload for output in outputs if isinstance(output.payload, Calibration)]


def pictures(outputs: Sequence[Output]) -> list[LivePose]:
    """Live poses among the outputs."""
    return [output.payload for output in outputs if isinstance(output.payload, LivePose)]


def series(outputs: Sequence[Output], name: str, quantity: str = "position") -> dict[int, float]:
    """One coordinate by captured time."""
    i = NAMES.index(name)
    return {
        t: row[i] for s in states(outputs) for t, row in zip(s.captured_ns, getattr(s, quantity), strict=True)
    }  # fmt: skip


def valid_times(outputs: Sequence[Output], name: str) -> set[int]:
    """Captured times at which a coordinate is valid."""
    i = NAMES.index(name)
    return {t for s in states(outputs) if s.valid[i] for t in s.captured_ns}


def errors_deg(outputs: Sequence[Output], recording: LegRecording, side: Side = Side.LEFT) -> np.ndarray:
    """Of the valid flexions, deg."""
    name = f"knee_flexion_{side}"
    estimate, valid = series(outputs, name), valid_times(outputs, name)
    truth = {time_ns(k): flexion for k, flexion in enumerate(recording.flexion)}
    return np.degrees([estimate[t] - truth[t] for t in sorted(valid)])


def text(outputs: Sequence[Output]) -> list[tuple[str, int, str]]:
    """To the bit."""
    return [(o.signal.name, o.captured_ns, o.payload.model_dump_json()) for o in outputs]
