"""A synthetic session as a recording folder: the files that any laboratory could write, and a recording.toml."""

import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from schemas.session import CameraDescription, HubDescription, SensorDescription, SessionDescription, WalkPath
from services.ingest.manifest import FILE_NAME
from services.ingest.skeleton import KINECT_V2_JOINTS
from services.ingest.synthetic.block import Block, SeenFrames
from services.ingest.synthetic.motions import parse_motion

TRUTH_FILE = "truth.csv"
_AXES = ("x", "y", "z")
_FRAME_HEADER = ["time_s", *(f"{joint}_{what}" for joint in KINECT_V2_JOINTS for what in (*_AXES, "state"))]
_IMU_HEADER = ["time_s", "gyr_x", "gyr_y", "gyr_z", "acc_x", "acc_y", "acc_z"]


def write_recording(folder: Path, options: str = "", walk_path: WalkPath = "turning", *, motion: str = "walk") -> None:
    """Write the walk of `speed=1.1&seed=3`, or another motion, to a folder, which is made.

    `walk_path` is what the recording asks of an estimator; it does not make the walk straight. Raises SourceError for
    an unknown motion or option.
    """
    source = parse_motion(motion, options)
    folder.mkdir(parents=True, exist_ok=True)
    blocks = list(source.samples())
    description = source.description().model_copy(update={"walk_path": walk_path})
    for hub in description.hubs:
        for index, sensor in enumerate(hub.sensors):
            _write(folder / f"imu_{sensor.name}.csv", _IMU_HEADER, [_imu_rows(block, index) for block in blocks])
    for camera in description.cameras:
        frames = [block.skeleton for block in blocks if block.skeleton is not None]
        _write(folder / f"{camera.name}.csv", _FRAME_HEADER, [_frame_rows(camera, part) for part in frames])
    if description.reference:
        header = ["time_s", *(channel.name for channel in description.reference)]
        _write(folder / TRUTH_FILE, header, [_truth_rows(block) for block in blocks])
    (folder / FILE_NAME).write_text(_manifest(description, f'--{motion} "{options}"'), encoding="utf-8")


def _imu_rows(block: Block, sensor: int) -> NDArray[np.float64]:
    track = block.sensors[sensor]
    return np.column_stack([track.captured_ns * 1e-9, track.angular_velocity, track.specific_force])


def _frame_rows(camera: CameraDescription, frames: SeenFrames) -> NDArray[np.float64]:
    """In the SDK's axes: x to the sensor's left, y up, z where it looks. A joint that is not tracked has no numbers."""
    order = [camera.joints.index(joint) for joint in KINECT_V2_JOINTS]
    x, y, z = np.moveaxis(frames.position[:, order], 2, 0)
    values = np.stack([z, y, -x, frames.state[:, order]], axis=2)
    return np.column_stack([frames.captured_ns * 1e-9, values.reshape(len(values), -1)])


def _truth_rows(block: Block) -> NDArray[np.float64]:
    return np.column_stack([block.reference.captured_ns * 1e-9, block.reference.values])


def _write(path: Path, header: list[str], parts: list[NDArray[np.float64]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for part in parts:
            writer.writerows(["" if value != value else f"{value:.9g}" for value in row] for row in part)


def _manifest(description: SessionDescription, options: str) -> str:
    body = description.anthropometry
    rate_hz = description.hubs[0].sensors[0].rate_hz if description.hubs else description.cameras[0].rate_hz
    lines = [
        f"# Written by `ambula synth {options}`; the truth beside it is exact.",
        f'title = "{description.title}"',
        f'protocol = "{description.protocol}"',
        f'task = "{description.task}"',
        *([] if description.walkway_m is None else [f"walkway_m = {description.walkway_m}"]),
        f'walk_path = "{description.walk_path}"',
        f"rate_hz = {rate_hz}",
        "",
        "[time]",
        'column = "time_s"',
        'unit = "s"',
        "",
        "[anthropometry]",
        f"thigh_length_m = {body.thigh_length_m}",
        f"shank_length_m = {body.shank_length_m}",
        f"hip_width_m = {body.hip_width_m}",
        *([] if body.height_m is None else [f"height_m = {body.height_m}"]),
        f'source = "{body.source}"',
    ]
    for hub in description.hubs:
        lines += _hub_lines(hub)
    for camera in description.cameras:
        lines += _camera_lines(camera)
    if description.reference:
        lines += ["", "[[reference]]", f'file = "{TRUTH_FILE}"', "channel = ["]
        lines += [
            f'  {{ name = "{channel.name}", column = "{channel.name}", unit = "{channel.unit}" }},'
            for channel in description.reference
        ]
        lines.append("]")
    return "\n".join(lines) + "\n"


def _hub_lines(hub: HubDescription) -> list[str]:
    lines = [
        "",
        "[imu]",
        'file = "imu_{sensor}.csv"',
        'specific_force = { columns = "acc_{axis}", unit = "m/s^2" }',
        'angular_velocity = { columns = "gyr_{axis}", unit = "rad/s" }',
        "",
        "[[hub]]",
        f'name = "{hub.name}"',
    ]
    for sensor in hub.sensors:
        lines += ["", *_sensor_lines(sensor)]
    return lines


def _camera_lines(camera: CameraDescription) -> list[str]:
    names = ", ".join(f'"{joint}"' for joint in KINECT_V2_JOINTS)
    return [
        "",
        "[[camera]]",
        f'name = "{camera.name}"',
        f'kind = "{camera.kind}"',
        f'file = "{camera.name}.csv"',
        f'columns = {{ position = "{{joint}}_{{axis}}", state = "{{joint}}_state", names = [{names}] }}',
        f"rate_hz = {camera.rate_hz}",
        f"floor_m = {camera.floor_m}",
    ]


def _sensor_lines(sensor: SensorDescription) -> list[str]:
    upward = [] if sensor.upward_axis is None else [f"upward_axis = {sensor.upward_axis}"]
    return [
        "[[hub.sensor]]",
        f'name = "{sensor.name}"',
        f'segment = "{sensor.segment}"',
        f"outward_axis = {sensor.outward_axis}",
        *upward,
        f'placement = "{sensor.placement}"',
        f"position_in_segment = {sensor.position_in_segment}",
    ]
