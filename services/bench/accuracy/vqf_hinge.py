"""A strong baseline: VQF on each sensor by itself, headings tied together at the joint (needs the `vqf` package).

Each segment's orientation has its own heading. It is turned about the vertical so that its flexion axis agrees with
that of its parent, the turn averaged as a vector over 3 s; the joint angle is the first of the flexion-first Euler
angles. Frames and biases are those of our own alignment.
"""

import importlib.util
import math

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ImuBatch
from schemas.kinematics import Calibration, SensorAlignment
from schemas.signals import CALIBRATION, IMU
from schemas.vocabulary import LOWER_BODY, Segment, Side
from services.biomech.rotations import matrix_from_quaternion
from services.estimation.node import build
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]

HEADING_TIME_S = 3.0


def is_installed() -> bool:
    """Whether the baseline can be computed here."""
    return importlib.util.find_spec("vqf") is not None


def vqf_hinge_angles(spec: str) -> Array:
    """Hip and knee flexion (frames, 15) in degrees in the order of LOWER_BODY, NaN for the others.

    For a recording whose sensors share their ticks. Raises ValueError when it cannot be calibrated.
    """
    calibration, samples, rate_hz = _read(spec)
    R = {s.segment: _orientations(s, samples[s.sensor], rate_hz) for s in calibration.sensors}
    angles = np.full((len(next(iter(R.values()))), len(LOWER_BODY)), np.nan)
    for side in Side:
        thigh, shank = R.get(Segment(f"thigh_{side}")), R.get(Segment(f"shank_{side}"))
        if thigh is not None and Segment.PELVIS in R:
            hip = flexion_about_right(R[Segment.PELVIS], thigh, rate_hz)
            angles[:, _column(f"hip_flexion_{side}")] = np.degrees(hip)
        if thigh is not None and shank is not None:
            angles[:, _column(f"knee_flexion_{side}")] = -np.degrees(flexion_about_right(thigh, shank, rate_hz))
    return angles


def _column(name: str) -> int:
    return next(i for i, dof in enumerate(LOWER_BODY) if dof.name == name)


def _read(spec: str) -> tuple[Calibration, dict[str, Array], float]:
    """Our calibration, and the samples (frames, 6) of each sensor."""
    source = open_source(spec, session="vqf", estimator="ekf")
    description = source.describe()
    chain = Chain([HostedNode("estimation", description.session, build(description))])
    calibration: Calibration | None = None
    sensors = {hub.name: hub.sensors for hub in description.hubs}
    samples: dict[str, list[list[float]]] = {s.name: [] for hub in description.hubs for s in hub.sensors}
    for message in iter_messages(source):
        for produced in chain.push(message):
            if produced.stream.signal is CALIBRATION and isinstance(produced.payload, Calibration):
                calibration = calibration or produced.payload
        if message.stream.signal is IMU and isinstance(message.payload, ImuBatch):
            for sensor, batch in zip(sensors[message.stream.source], message.payload.sensors, strict=True):
                pairs = zip(batch.angular_velocity, batch.specific_force, strict=True)
                samples[sensor.name] += [[*rate, *force] for rate, force in pairs]
    if calibration is None:
        raise ValueError(f"{spec} has no standing and walking to calibrate on")
    return calibration, {name: np.array(rows) for name, rows in samples.items()}, description.hubs[0].sensors[0].rate_hz


def _orientations(alignment: SensorAlignment, samples: Array, rate_hz: float) -> Array:
    """R_world_from_segment (frames, 3, 3), world z up, heading arbitrary."""
    from vqf import VQF

    rates = np.ascontiguousarray(samples[:, :3] - np.array(alignment.gyro_bias))
    quaternions = VQF(1.0 / rate_hz).updateBatch(rates, np.ascontiguousarray(samples[:, 3:]))["quat6D"]
    R_segment_from_sensor = matrix_from_quaternion(np.array(alignment.quat_segment_from_sensor))
    return np.stack([matrix_from_quaternion(q) @ R_segment_from_sensor.T for q in quaternions])


def flexion_about_right(R_world_from_parent: Array, R_world_from_child: Array, rate_hz: float) -> Array:
    """Flexion-first Euler angle (n,) of the child in the parent, rad about +right, headings tied at the right axes."""
    parent, child = R_world_from_parent[:, :2, 2], R_world_from_child[:, :2, 2]
    turn = (parent[:, 0] + 1j * parent[:, 1]) * np.conj(child[:, 0] + 1j * child[:, 1])
    gain, mean = 1.0 / (rate_hz * HEADING_TIME_S), turn[0]
    angles = np.empty(len(turn))
    for i, value in enumerate(turn):
        mean += gain * (value - mean)
        c, s = math.cos(np.angle(mean)), math.sin(np.angle(mean))
        R = R_world_from_parent[i].T @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ R_world_from_child[i]
        angles[i] = math.atan2(-R[0, 1], R[1, 1])
    return angles
