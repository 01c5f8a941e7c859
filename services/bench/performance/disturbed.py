"""One walk estimated again and again under faults, and how far its joints are then from the truth."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ReferenceBatch
from schemas.kinematics import Calibration, JointState
from schemas.rhythm import Rhythm
from schemas.session import SessionDescription
from schemas.signals import IMU
from schemas.vocabulary import LOWER_BODY, Side
from services.bench.accuracy.neura_truth import collect_truth
from services.estimation.lower_body.node import LowerBodyNode
from services.faults.faults import SampleFault
from services.faults.inject import Injection
from services.flow.message import Message
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

COLUMN = {dof.name: i for i, dof in enumerate(LOWER_BODY)}
FLEXIONS = tuple(f"{joint}_flexion_{side}" for joint in ("knee", "hip") for side in Side)


@dataclass(frozen=True)
class Walk:
    """A session's samples and what the joints really did."""

    name: str
    description: SessionDescription
    messages: tuple[Message, ...]  # of the first hub, its end included
    truth_s: Array  # (m,)
    truth: dict[str, Array]  # joint -> (m,) deg, NaN where unknown
    walking_s: tuple[float, float]  # what is scored

    @property
    def sensors(self) -> list[str]:
        """Sensors of the first hub."""
        return [sensor.name for sensor in self.description.hubs[0].sensors]


@dataclass(frozen=True)
class Estimated:
    """Joint angles of one run; columns are those of LOWER_BODY."""

    time_s: Array  # (n,)
    position: Array  # (n, 15) deg
    std: Array  # (n, 15) deg
    valid: Flags  # (n, 15)
    calibration: Calibration
    locked_from_s: float
    """When the rhythm was locked first; infinite if it never was."""
    lost_share: float
    """Of the samples that were sent."""

    def error(self, walk: Walk, joint: str) -> Array:
        """(n,) deg; NaN where the truth is not known."""
        return self.position[:, COLUMN[joint]] - np.interp(self.time_s, walk.truth_s, walk.truth[joint])


def synthetic_walk(query: str) -> Walk:
    """A simulated walk with the truth that belongs to it; scored from the first step to the last."""
    source = open_source(f"synthetic:walk?{query}", session="loss")
    description = source.describe()
    imu: list[Message] = []
    times: list[int] = []
    values: list[list[float | None]] = []
    for message in iter_messages(source):
        if message.stream.signal is IMU:
            imu.append(message)
        elif isinstance(message.payload, ReferenceBatch):
            times += message.payload.captured_ns
            values += message.payload.values
    table = np.array(values, dtype=np.float64)
    columns = {channel.name: i for i, channel in enumerate(description.reference)}
    truth = {joint: np.degrees(table[:, columns[joint]]) for joint in FLEXIONS}
    time_s = np.array(times) * 1e-9
    moving = time_s[1:][np.abs(np.diff(truth["knee_flexion_left"])) > 0.1]
    return Walk(query, description, tuple(imu), time_s, truth, (float(moving[0]), float(moving[-1])))


def recorded_walk(spec: str, walking_s: tuple[float, float]) -> Walk:
    """The recorded walk with optical truth: Plug-in-Gait knees, hips from segment orientations."""
    truth = collect_truth(spec)
    angles = {f"knee_flexion_{side}": truth.knee_plug_in_gait[side] for side in Side}
    angles |= {f"hip_flexion_{side}": truth.hip_segments[side] for side in Side}
    source = open_source(spec, session="loss")
    imu = tuple(message for message in iter_messages(source) if message.stream.signal is IMU)
    rate_hz = source.describe().hubs[0].sensors[0].rate_hz
    time_s = np.arange(len(angles["knee_flexion_left"])) / rate_hz
    return Walk(spec, source.describe(), imu, time_s, angles, walking_s)


def estimate(walk: Walk, estimator: str, faults: Sequence[SampleFault] = ()) -> Estimated:
    """The walk through estimation, with faults in its samples. Raises ValueError when it does not calibrate."""
    node = LowerBodyNode(walk.description.model_copy(update={"estimator": estimator}))
    injection = Injection(walk.sensors, faults)
    calibration: Calibration | None = None
    rows: list[tuple[int, list[float], list[float], list[bool]]] = []
    locked: list[int] = []
    for message in injection.apply(walk.messages):
        for output in node.finish() if message.envelope.final else node.step(message):
            state = output.payload
            if isinstance(state, JointState):
                valid = [state.valid] * len(state.captured_ns)
                rows += zip(state.captured_ns, state.position, state.position_std, valid, strict=True)
            elif isinstance(state, Rhythm):
                locked += [ns for ns, is_locked in zip(state.captured_ns, state.locked, strict=True) if is_locked]
            elif isinstance(state, Calibration):
                calibration = state
    if calibration is None:
        raise ValueError(f"{walk.name} does not calibrate with {faults}")
    times, position, std, flags = zip(*rows, strict=True)
    lost = sum(len(times) for times in injection.lost.values()) / sum(injection.sent.values())
    angles, deviations = np.degrees(np.array(position)), np.degrees(np.array(std))
    from_s = min(locked) * 1e-9 if locked else math.inf
    return Estimated(np.array(times) * 1e-9, angles, deviations, np.array(flags), calibration, from_s, lost)
