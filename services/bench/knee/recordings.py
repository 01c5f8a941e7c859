"""Recordings of thigh and shank sensor with a measured knee, each as plain arrays."""

import csv
import gzip
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat
from scipy.spatial.transform import Rotation

from schemas.imu import ImuBatch
from schemas.signals import IMU
from schemas.vocabulary import Segment, Side
from services.bench.accuracy.neura_truth import reference_channels
from services.bench.knee.agreement import unwrapped_error
from services.biomech.two_sensor_knee.mcgrath import segment_frame
from services.ingest.data import find_data
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

FASTEST_BODY = 3.0
"""m/s. Hand-moved bodies of the hinge recordings stay below 1.7; above, markers were taken for others."""
MARKER_SPAN = 1
"""Frames left out on either side of such a jump."""


class KneeRecording(NamedTuple):
    """One knee: samples, truth, and where the truth holds."""

    name: str
    rate_hz: float
    rate: Array  # (n, 2, 3) rad/s, thigh first
    force: Array  # (n, 2, 3) m/s^2
    flexion: Array  # (n,) rad
    holds: Mask  # (n,) the truth can be believed
    axes: Array | None  # (2, 3) the true axis in each sensor, up to a common sign
    orientations: tuple[Array, Array] | None = (
        None  # R_world_from_sensor (n, 3, 3) of both in one world, not from the truth
    )


def weygers(trial: str) -> KneeRecording:
    """A mechanical hinge moved by hand; the truth's angle is in McGrath's datum (`segment_frame`) about its own axis.

    Raises MissingFile without the data.
    """
    data = loadmat(
        find_data("weygers_hinge") / f"data_1D_{trial}.mat", squeeze_me=True, struct_as_record=False
    )["data"]  # fmt: skip
    samples, truth = np.asarray(data.sensorData, dtype=np.float64), np.asarray(data.ref, dtype=np.float64)
    first, second = (Rotation.from_quat(truth[:, k : k + 4], scalar_first=True) for k in (0, 4))
    relative = first.inv() * second
    axes = _hinge_axes(relative)
    R = segment_frame(axes[0]).T @ relative.as_matrix() @ segment_frame(axes[1])
    flexion = np.arctan2(R[:, 1, 0] - R[:, 0, 1], R[:, 0, 0] + R[:, 1, 1])
    return KneeRecording(
        f"weygers {trial}", float(data.rate), np.stack([samples[:, 3:6], samples[:, 9:12]], axis=1),
        np.stack([samples[:, 0:3], samples[:, 6:9]], axis=1), flexion, ~swapped_markers(truth[:, 8:14], data.rate),
        axes,
    )  # fmt: skip


def swapped_markers(positions: Array, rate_hz: float) -> Mask:
    """Frames (n,) at a jump of either optical body, positions (n, 6) m: faster than any hand moved them."""
    jumps = np.zeros(len(positions), dtype=np.bool_)
    for body in (positions[:, :3], positions[:, 3:]):
        too_fast = np.linalg.norm(np.diff(body, axis=0), axis=1) * rate_hz > FASTEST_BODY
        jumps[:-1] |= too_fast
        jumps[1:] |= too_fast
    reach = np.ones(2 * MARKER_SPAN + 1)
    return np.convolve(jumps, reach, mode="same") > 0.0


def _hinge_axes(relative: Rotation) -> Array:
    """Principal direction (2, 3) of the turns since the first frame, in either sensor, of equal sense."""
    axes = []
    for turns in (relative * relative[0].inv(), relative[0].inv() * relative):
        quat = turns.as_quat(scalar_first=True)
        vectors = quat[:, 1:] * np.sign(quat[:, :1])
        axes.append(np.linalg.eigh(vectors.T @ vectors)[1][:, 2])
    carried = relative[0].apply(axes[1])
    return np.stack([axes[0], axes[1] * np.sign(carried @ axes[0])])


def from_manifest(spec: str, side: Side) -> KneeRecording:
    """A recording with a manifest; its truth is the knee's flexion as the laboratory gives it.

    Raises MissingFile without the data.
    """
    source = open_source(spec, session="knee")
    description = source.describe()
    wanted = {Segment(f"thigh_{side}"): 0, Segment(f"shank_{side}"): 1}
    rows: dict[int, list[list[float]]] = {0: [], 1: []}
    sensors = {hub.name: hub.sensors for hub in description.hubs}
    rate_hz = 0.0
    for message in iter_messages(source):
        if message.stream.signal is not IMU or not isinstance(message.payload, ImuBatch):
            continue
        for sensor, batch in zip(sensors[message.stream.source], message.payload.sensors, strict=True):
            place = wanted.get(sensor.segment)
            if place is not None:
                rate_hz = sensor.rate_hz
                pairs = zip(batch.angular_velocity, batch.specific_force, strict=True)
                rows[place] += [[*rate, *force] for rate, force in pairs]
    flexion = reference_channels(spec)[f"knee_flexion_{side}"]
    n = min(len(rows[0]), len(rows[1]), len(flexion))
    samples = np.stack([np.array(rows[0][:n]), np.array(rows[1][:n])], axis=1)
    flexion = np.asarray(flexion[:n])
    return KneeRecording(
        spec, rate_hz, samples[:, :, :3], samples[:, :, 3:], flexion, np.isfinite(flexion), None,
        delivered_orientations(spec, side, n),
    )  # fmt: skip


DELIVERED = {
    "fan_knee_drop_landing_left": ("fan_knee_drop_landing_left", "imu_thigh_{side}.csv.gz", "imu_shank_{side}.csv.gz"),
    "alborno_sub03_sts1": (
        "alborno_sub03_sit_to_stand", "sts1_imu_thigh_{side}.csv.gz", "sts1_imu_shank_{side}.csv.gz"
    ),
    "neura_s02_walk": ("neura_s02_walk", "imu_thigh_{side}.csv.gz", "imu_ankle_{side}.csv.gz"),
    "neura_s02_walk_midshank": ("neura_s02_walk", "imu_thigh_{side}.csv.gz", "imu_shank_{side}.csv.gz"),
}  # fmt: skip
"""Folder and files of thigh and shank that hold the orientations of the sensors' maker, magnetometer included."""


def delivered_orientations(spec: str, side: Side, count: int) -> tuple[Array, Array] | None:
    """R_world_from_sensor (count, 3, 3) of thigh and shank by the maker's own filter; None where it is not known."""
    if spec not in DELIVERED:
        return None
    folder, *files = DELIVERED[spec]
    thigh, shank = (_orientations_in(find_data(folder) / file.format(side=side[0])) for file in files)
    return thigh[:count], shank[:count]


def _orientations_in(path: Path) -> Array:
    with gzip.open(path, "rt") as file:
        rows = [[float(row[f"q_{part}"]) for part in "wxyz"] for row in csv.DictReader(file)]
    return np.asarray(Rotation.from_quat(np.array(rows), scalar_first=True).as_matrix())


def clock_lag(recording: KneeRecording, parts: int) -> Array:
    """Samples by which the gyroscopes come later than the truth, in `parts` equal parts of the recording.

    Told by the rates alone, no estimate is involved: the shift at which (w_shank - w_thigh) along the true axes agrees
    best with the truth's derivative, beyond the half sample that a difference lies before its second frame.

    Raises:
        ValueError: the true axes are not known.
    """
    if recording.axes is None:
        raise ValueError(f"{recording.name} has no true axis")
    rate = recording.rate[:, 1] @ recording.axes[1] - recording.rate[:, 0] @ recording.axes[0]
    measured = unwrapped_error(recording.flexion[1:], recording.flexion[:-1]) * recording.rate_hz
    frames = np.arange(len(measured))
    lags = np.arange(-1.0, 2.0, 0.05)
    result = []
    for part in np.array_split(frames[4:-4], parts):
        part = part[recording.holds[part] & recording.holds[part + 1]]
        misfits = [
            np.mean((np.interp(part + 1.0 + lag, np.arange(len(rate)), rate) - measured[part]) ** 2) for lag in lags
        ]
        result.append(lags[int(np.argmin(misfits))])
    return np.array(result)
