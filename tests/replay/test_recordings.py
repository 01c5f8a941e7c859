"""The recordings that the software describes replay whole, in SI, with gravity where it belongs."""

import csv
import gzip

import numpy as np
import pytest

from schemas.imu import ImuBatch, ReferenceBatch
from services.ingest.data import find_data
from services.ingest.errors import MissingFile
from services.ingest.source import iter_messages, known_recordings, open_source

RECORDINGS = {
    # name: sensors, messages of the hub, sample rate in Hz
    "neura_s02_walk": (5, 2503, 100.0),
    "neura_s02_walk_midshank": (5, 2503, 100.0),
    "fan_knee_drop_landing_left": (2, 6671, 100.0),
    "alborno_sub03_sts1": (5, 1600, 40.0),
    "moving_reality_pp11": (5, 12482, 100.0),
    "zju_s01_norm_02": (2, 1655, 100.0),
    "gaitmap_feet": (2, 7928, 204.8),
}


def recording(name):
    try:
        return open_source(name, session="replay")
    except MissingFile as error:
        pytest.skip(str(error))


def samples(source):
    """Specific force and angular velocity, (samples, sensors, 3)."""
    payloads = [message.payload for message in iter_messages(source) if isinstance(message.payload, ImuBatch)]
    sensors = range(len(payloads[0].sensors))
    force = [[row for payload in payloads for row in payload.sensors[k].specific_force] for k in sensors]
    rate = [[row for payload in payloads for row in payload.sensors[k].angular_velocity] for k in sensors]
    return np.array(force).swapaxes(0, 1), np.array(rate).swapaxes(0, 1)


def truth(source):
    payloads = [message.payload for message in iter_messages(source) if isinstance(message.payload, ReferenceBatch)]
    values = np.array([row for payload in payloads for row in payload.values], dtype=float)
    return {channel.name: values[:, k] for k, channel in enumerate(source.describe().reference)}


def test_every_shipped_manifest_is_tried():
    assert set(RECORDINGS) <= set(known_recordings())


@pytest.mark.parametrize("name", RECORDINGS)
def test_a_recording_replays_whole(name):
    sensors, count, rate_hz = RECORDINGS[name]
    source = recording(name)
    description = source.describe()
    force, rate = samples(source)
    assert force.shape == rate.shape == (count, sensors, 3)
    assert description.duration_s == pytest.approx((count - 1) / rate_hz)
    assert source.rejections() == []
    # A swinging foot feels half a g more than gravity; a wrong unit would be off by ten times.
    assert np.median(np.linalg.norm(force, axis=2), axis=0) == pytest.approx(9.81, abs=1.5)
    assert np.isfinite(force).all()
    assert np.isfinite(rate).all()


@pytest.mark.parametrize("name", ["neura_s02_walk", "neura_s02_walk_midshank"])
def test_neura_stands_upright_and_walks(name):
    source = recording(name)
    force, rate = samples(source)
    standing = slice(200, 1000)
    assert np.linalg.norm(force[standing], axis=2).mean(axis=0) == pytest.approx(9.81, abs=0.2)
    assert np.linalg.norm(rate[standing], axis=2).mean() < 0.05
    # The x axis of every sensor runs up its segment.
    assert (force[standing].mean(axis=0)[:, 0] > 8.5).all()
    assert np.abs(rate[1119:2073]).max(axis=(0, 2))[[2, 4]] == pytest.approx(6.5, abs=2.5)


def test_neura_samples_are_the_files_own():
    source = recording("neura_s02_walk")
    with gzip.open(find_data("neura_s02_walk") / "imu_ankle_r.csv.gz", "rt") as file:
        row = list(csv.DictReader(file))[1500]
    names = [sensor.name for sensor in source.describe().hubs[0].sensors]
    force, rate = samples(source)
    assert force[1500, names.index("ankle_r")].tolist() == [float(row[f"acc_{axis}"]) for axis in "xyz"]
    assert rate[1500, names.index("ankle_r")].tolist() == [float(row[f"gyr_{axis}"]) for axis in "xyz"]


def test_neura_truth_is_in_our_units_and_axes():
    channels = truth(recording("neura_s02_walk"))
    for side in ("left", "right"):
        assert np.ptp(channels[f"knee_flexion_{side}"][1119:2073]) == pytest.approx(np.radians(68), abs=0.1)
        thigh = channels[f"hip_{side}_y"] - channels[f"knee_{side}_y"]
        assert thigh[500] == pytest.approx(0.40, abs=0.03)
        assert channels[f"ankle_{side}_y"][500] == pytest.approx(0.10, abs=0.02)
        assert set(channels[f"foot_contact_{side}"]) == {0.0, 1.0}
    # Right is right of left for somebody who looks along the pelvis.
    middle = {k: (channels[f"asis_left_{k}"] + channels[f"asis_right_{k}"]) / 2 for k in "xz"}
    back = {k: (channels[f"psis_left_{k}"] + channels[f"psis_right_{k}"]) / 2 for k in "xz"}
    forward = np.column_stack([middle[k] - back[k] for k in "xz"])
    across = np.column_stack([channels[f"hip_right_{k}"] - channels[f"hip_left_{k}"] for k in "xz"])
    # z is right: forward x up ... in the ground plane (x, z), right is forward turned by +90 degrees.
    assert (forward[:, 0] * across[:, 1] - forward[:, 1] * across[:, 0] > 0).all()


def test_neura_orientations_agree_with_the_joint_centres():
    """The thigh's own y axis, from the quaternions, points from the knee to the hip."""
    channels = truth(recording("neura_s02_walk"))
    w, x, y, z = (channels[f"quat_world_from_thigh_right_{k}"] for k in "wxyz")
    known = np.isfinite(w)
    assert known.sum() == 955
    up = np.column_stack([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)])
    line = np.column_stack([channels[f"hip_right_{k}"] - channels[f"knee_right_{k}"] for k in "xyz"])
    line /= np.linalg.norm(line, axis=1, keepdims=True)
    assert np.degrees(np.arccos((up * line).sum(axis=1)[known])).max() < 12
    pelvis = np.column_stack([channels[f"quat_world_from_pelvis_{k}"] for k in "wxyz"])[known]
    assert np.linalg.norm(pelvis, axis=1) == pytest.approx(1.0, abs=1e-4)


def test_fan_flexes_positively():
    channels = truth(recording("fan_knee_drop_landing_left"))
    assert np.degrees(channels["knee_flexion_left"].max()) > 90
