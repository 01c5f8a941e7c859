"""A synthetic session as a recording folder: the files that any laboratory could write, and a recording.toml."""

import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription, SessionDescription, WalkPath
from services.ingest.errors import InvalidOption
from services.ingest.manifest import FILE_NAME
from services.ingest.synthetic.block import Block
from services.ingest.synthetic.motions import parse_motion

TRUTH_FILE = "truth.csv"
_IMU_HEADER = ["time_s", "gyr_x", "gyr_y", "gyr_z", "acc_x", "acc_y", "acc_z"]


def write_recording(folder: Path, options: str = "", walk_path: WalkPath = "turning", *, motion: str = "walk") -> None:
    """Write the walk of `speed=1.1&seed=3`, or another motion, to a folder, which is made.

    `walk_path` is what the recording asks of an estimator; it does not make the walk straight. Raises SourceError for
    an unknown motion or option, or for one before a camera alone.
    """
    source = parse_motion(motion, options)
    if not source.description().hubs:
        raise InvalidOption(f"synthetic:{motion} has no inertial sensors; only their samples are written as files")
    folder.mkdir(parents=True, exist_ok=True)
    blocks = list(source.samples())
    description = source.description().model_copy(update={"walk_path": walk_path})
    for index, sensor in enumerate(description.hubs[0].sensors):
        _write(folder / f"imu_{sensor.name}.csv", _IMU_HEADER, [_imu_rows(block, index) for block in blocks])
    if description.reference:
        header = ["time_s", *(channel.name for channel in description.reference)]
        _write(folder / TRUTH_FILE, header, [_truth_rows(block) for block in blocks])
    (folder / FILE_NAME).write_text(_manifest(description, f'--{motion} "{options}"'), encoding="utf-8")


def _imu_rows(block: Block, sensor: int) -> NDArray[np.float64]:
    track = block.sensors[sensor]
    return np.column_stack([track.captured_ns * 1e-9, track.angular_velocity, track.specific_force])


def _truth_rows(block: Block) -> NDArray[np.float64]:
    return np.column_stack([block.reference.captured_ns * 1e-9, block.reference.values])


def _write(path: Path, header: list[str], parts: list[NDArray[np.float64]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for part in parts:
            writer.writerows([f"{value:.9g}" for value in row] for row in part)


def _manifest(description: SessionDescription, options: str) -> str:
    body = description.anthropometry
    lines = [
        f"# Written by `ambula synth {options}`; the truth beside it is exact.",
        f'title = "{description.title}"',
        f'protocol = "{description.protocol}"',
        f'task = "{description.task}"',
        *([] if description.walkway_m is None else [f"walkway_m = {description.walkway_m}"]),
        f'walk_path = "{description.walk_path}"',
        f"rate_hz = {description.hubs[0].sensors[0].rate_hz}",
        "",
        "[time]",
        'column = "time_s"',
        'unit = "s"',
        "",
        "[anthropometry]",
        f"thigh_length_m = {body.thigh_length_m}",
        f"shank_length_m = {body.shank_length_m}",
        f"hip_width_m = {body.hip_width_m}",
        "",
        "[imu]",
        'file = "imu_{sensor}.csv"',
        'specific_force = { columns = "acc_{axis}", unit = "m/s^2" }',
        'angular_velocity = { columns = "gyr_{axis}", unit = "rad/s" }',
        "",
        "[[hub]]",
        f'name = "{description.hubs[0].name}"',
    ]
    for sensor in description.hubs[0].sensors:
        lines += ["", *_sensor_lines(sensor)]
    if description.reference:
        lines += ["", "[[reference]]", f'file = "{TRUTH_FILE}"', "channel = ["]
        lines += [
            f'  {{ name = "{channel.name}", column = "{channel.name}", unit = "{channel.unit}" }},'
            for channel in description.reference
        ]
        lines.append("]")
    return "\n".join(lines) + "\n"


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
