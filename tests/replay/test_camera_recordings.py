"""Recorded skeletons of Kinects replay whole: a person upright before the camera, and the numbers of the files."""

import numpy as np
import pytest

from schemas.imu import ReferenceBatch
from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import JointCentre, SkeletonJoint, TrackingState
from services.ingest.data import find_data
from services.ingest.errors import MissingFile
from services.ingest.source import iter_messages, open_source
from tests.unit.ingest.test_mcap_file import archive

RECORDINGS = {"kimore_squat": 517, "kimore_arm_lift": 505, "keraal_hiding_face": 197, "keraal_torso_rotation": 193}
"""Frames of each at 30 Hz."""

ORDER = {
    "spine_base": 0,
    "spine_shoulder": 20,
    "shoulder_right": 8,
    "wrist_left": 6,
    "knee_right": 17,
    "ankle_left": 14,
}
"""A few joints by their number in the file: those of the Kinect for Windows SDK 2.0."""


def opened(name):
    try:
        return open_source(name, session="replay")
    except MissingFile as error:
        pytest.skip(str(error))


class Seen:
    """All frames of a recording, by joint."""

    def __init__(self, source):
        payloads = [message.payload for message in iter_messages(source)]
        frames = [payload for payload in payloads if isinstance(payload, SkeletonBatch)]
        self.joints = source.describe().cameras[0].joints
        self.captured_ns = [ns for frame in frames for ns in frame.captured_ns]
        self.states = [state for frame in frames for states in frame.state for state in states]
        unknown = [[np.nan] * 3] * len(self.joints)
        self.position = np.array(
            [[at or lost for at, lost in zip(row, unknown, strict=True)] for frame in frames for row in frame.position]
        )
        self.truth = [payload for payload in payloads if isinstance(payload, ReferenceBatch)]

    def __getitem__(self, joint):
        return self.position[:, self.joints.index(SkeletonJoint(joint))]


@pytest.mark.parametrize("name", RECORDINGS)
def test_a_camera_recording_replays_whole_and_upright(name):
    source = opened(name)
    seen, description = Seen(source), source.describe()
    assert seen.position.shape == (RECORDINGS[name], 25, 3)
    assert [str(joint) for joint in seen.joints[:15]] == list(JointCentre)
    assert (description.estimator, description.hubs, source.rejections()) == ("body_cekf", [], [])
    assert description.duration_s == pytest.approx((RECORDINGS[name] - 1) / 30)
    assert np.diff(seen.captured_ns) == pytest.approx(1e9 / 30, abs=2)
    # Before the camera, shoulders over hips, the right one on the right of who faces it.
    assert (seen["spine_base"][:, 0] < -1.5).all()
    assert np.median(seen["spine_shoulder"][:, 1] - seen["spine_base"][:, 1]) > 0.2
    assert np.median(seen["shoulder_right"][:, 2] - seen["shoulder_left"][:, 2]) > 0.15


@pytest.mark.parametrize(("name", "exercise"), [("kimore_squat", 5), ("kimore_arm_lift", 1)])
def test_kimore_frames_are_the_files_own(name, exercise):
    seen = Seen(opened(name))
    lines = (find_data("kimore_kinect_v2") / f"JointPositionExercise{exercise}.csv").read_text().split("\n")
    rows = np.array([line.rstrip(",\r").split(",") for line in lines if line.strip()], dtype=float).reshape(-1, 25, 4)
    for joint, number in ORDER.items():
        x, y, z = rows[:, number, :3].T
        assert np.array_equal(seen[joint], np.column_stack([-z, y, x])), joint
    assert seen.states.count(TrackingState.INFERRED) == (rows[:, :, 3] == 1).sum()
    assert seen.states.count(TrackingState.TRACKED) == (rows[:, :, 3] == 2).sum()


@pytest.mark.parametrize(("name", "rows"), [("keraal_hiding_face", 390), ("keraal_torso_rotation", 389)])
def test_keraal_truth_spans_the_same_time_in_our_axes(name, rows):
    source = opened(name)
    seen = Seen(source)
    channels = [channel.name for channel in source.describe().reference]
    values = np.array([row for batch in seen.truth for row in batch.values], dtype=float)
    times = [ns for batch in seen.truth for ns in batch.captured_ns]
    assert (len(times), times[0]) == (rows, 0)
    assert times[-1] == pytest.approx(seen.captured_ns[-1], abs=1000)
    target = {name: values[:, channels.index(f"{name}_x") :][:, :3] for name in ("target_chest", "target_hips")}
    trunk = target["target_chest"] - target["target_hips"]
    assert (trunk[:, 1] > 0.15).all()
    lean = values[:, channels.index("trunk_lean_right")]
    assert lean == pytest.approx(np.arctan2(trunk[:, 2], trunk[:, 1]))
    right = values[:, channels.index("target_thigh_right_z")] - values[:, channels.index("target_thigh_left_z")]
    assert (right > 0.1).all()


def test_trunk_lean_of_a_camera_follows_the_optical_one():
    """The bound is that of the bench, which removes the sideways direction of the thighs: r 0.79."""
    source = opened("keraal_torso_rotation")
    seen = Seen(source)
    channels = [channel.name for channel in source.describe().reference]
    values = np.array([row for batch in seen.truth for row in batch.values], dtype=float)
    times = [ns for batch in seen.truth for ns in batch.captured_ns]
    lean = np.interp(seen.captured_ns, times, values[:, channels.index("trunk_lean_right")])
    trunk = seen["spine_shoulder"] - seen["spine_base"]
    assert np.corrcoef(np.arctan2(trunk[:, 2], trunk[:, 1]), lean)[0, 1] > 0.7


@pytest.mark.parametrize("name", ["kimore_squat", "keraal_torso_rotation"])
def test_an_archived_camera_recording_replays_to_the_last_bit(name, tmp_path):
    source = opened(name)
    messages = list(iter_messages(source))
    archive(tmp_path / "first", messages, source.describe())
    again = open_source(str(tmp_path / "first"), session="replay")
    assert list(iter_messages(again)) == messages
    assert again.rejections() == []
