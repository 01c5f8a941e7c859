"""The file of a depth camera becomes frames of the room, or an error that says where and what to do."""

import math

import pytest

from schemas.health import Reason
from schemas.imu import ReferenceBatch
from schemas.skeleton import SkeletonBatch
from schemas.standing import StandingMark
from schemas.vocabulary import JointCentre, SkeletonJoint, TrackingState
from services.ingest.errors import ClockError, EmptyFile, WrongAxes, WrongFieldCount, WrongUnits
from services.ingest.source import in_batches, iter_messages, open_source
from tests.unit.ingest.camera_scene import AZURE, HEAD_TOML, HUB, KINECT, Scene
from tests.unit.ingest.posed_person import STANDING, in_room

J = SkeletonJoint


@pytest.fixture
def scene(tmp_path):
    return Scene(tmp_path / "scene")


def frames(source):
    return [m.payload for m in iter_messages(source) if isinstance(m.payload, SkeletonBatch)]


def counted(source):
    return {(found.subject, found.reason): found.count for found in source.rejections()}


def test_a_camera_alone_is_a_session_of_its_own(scene):
    source = scene.opened()
    description = source.describe()
    assert (description.estimator, description.hubs, description.anthropometry.source) == ("body_cekf", [], "default")
    (camera,) = description.cameras
    assert (camera.name, camera.kind, camera.rate_hz, camera.floor_m) == ("kinect", "kinect_v2", 30.0, None)
    assert camera.joints[:15] == list(JointCentre)
    assert description.duration_s == pytest.approx(59 / 30)
    messages = list(iter_messages(source))
    assert [m.stream.name for m in messages] == ["skeleton/kinect"] * 61
    assert [m.envelope.sequence for m in messages] == list(range(61))
    assert messages[-1].payload is None
    assert source.rejections() == []


def test_frames_are_the_person_in_the_room(scene):
    first = frames(scene.opened())[0]
    joints = [SkeletonJoint(joint) for joint in scene.opened().describe().cameras[0].joints]
    for joint, position, state in zip(joints, first.position[0], first.state[0], strict=True):
        assert position == pytest.approx(in_room(joint), abs=1e-5), joint
        assert state == TrackingState.TRACKED
    assert (first.body, first.people, first.captured_ns) == ([1], [1], [0])


def test_joints_may_be_named_by_the_file_in_any_unit_and_time(scene):
    scene.toml = HEAD_TOML + AZURE
    source = scene.opened()
    joints = source.describe().cameras[0].joints
    batches = frames(source)
    assert len(batches) == 60
    assert batches[1].captured_ns == [33_333_000]
    wrist = joints.index(J.WRIST_RIGHT)
    assert batches[0].position[0][wrist] == pytest.approx(STANDING[J.WRIST_RIGHT], abs=1e-3)


def test_a_hub_and_two_cameras_share_one_clock(scene):
    scene.toml = HEAD_TOML + HUB + KINECT.replace('"kinect"', '"front"') + AZURE
    source = scene.opened()
    description = source.describe()
    assert description.estimator == "fusion"
    assert {m.stream.name for m in iter_messages(source)} == {"imu/hub", "skeleton/front", "skeleton/azure"}
    assert open_source(scene.write(), estimator="ekf").describe().estimator == "ekf"


def test_a_row_of_orientations_and_no_states_is_all_tracked(scene):
    """Seven numbers a joint, blanks between, as KERAAL has them."""
    scene.rows = [
        [" ".join(" ".join(row[4 * j : 4 * j + 3]) + " 0.5 0.5 0.5 0.5" for j in range(25))] for row in scene.rows
    ]
    scene.toml = scene.toml.replace("{ each = 4, state = 4 }", "{ each = 7 }")
    scene.toml = scene.toml.replace("header = false", 'header = false, delimiter = " "')
    batch = frames(scene.opened())[0]
    assert set(batch.state[0]) == {TrackingState.TRACKED}


def test_joints_may_begin_later_in_a_row_that_has_a_time(scene):
    """A counter in ms before the joints, which then lie one column later each."""
    scene.rows = [[str(40 * k), *row] for k, row in enumerate(scene.rows)]
    scene.toml = scene.toml.replace(
        "state = 4 }", 'state = 4, first_column = 2 }\ntime = { column = "1", unit = "ms" }'
    )
    batches = frames(scene.opened())
    assert batches[10].captured_ns == [400_000_000]
    assert batches[0].position[0][0] == pytest.approx(STANDING[J.SPINE_BASE], abs=1e-4)


def test_truth_beside_a_camera_may_be_a_lean(scene):
    """The upper point is 10 cm to the front and 20 cm to the left of one that is 40 cm below; z is up, mm."""
    scene.toml += """
[[reference]]
file = "truth.csv"
rate_hz = 60.0
point = [{ name = "hips", columns = "h{axis}", unit = "mm", axes = ["x", "z", "-y"] }]
inclination = [{ name = "trunk_lean", lower = "h{axis}", upper = ["cx", "cy", "cz"], axes = ["x", "z", "-y"] }]
"""
    folder = scene.write()
    lines = "hx,hy,hz,cx,cy,cz\n" + "1000,500,700,1100,700,1100\n" * 117 + "1000,500,700,,700,1100\n" * 2
    (scene.path / "truth.csv").write_text(lines)
    source = open_source(folder)
    channels = [(channel.name, channel.unit) for channel in source.describe().reference]
    assert channels[3:] == [("trunk_lean_forward", "rad"), ("trunk_lean_right", "rad")]
    batches = [m.payload for m in iter_messages(source) if isinstance(m.payload, ReferenceBatch)]
    assert batches[0].values[0] == pytest.approx([1.0, 0.7, -0.5, math.atan2(1, 4), -math.atan2(2, 4)])
    assert batches[-1].values[-1][3] is None
    assert batches[-1].captured_ns[-1] == pytest.approx(118e9 / 60, abs=1)


def test_a_frame_without_anybody_is_a_frame(scene):
    for at in range(3, 100, 4):
        scene.rows[7][at] = "0"
    source = scene.opened()
    batch = frames(source)[7]
    assert (batch.body, batch.people) == ([None], [0])
    assert all(position is None for position in batch.position[0])
    assert set(batch.state[0]) == {TrackingState.NOT_TRACKED}
    assert len(frames(source)) == 60
    assert source.rejections() == []


def test_what_is_no_place_is_counted_and_not_tracked(scene):
    scene.rows[3][0] = "nan"
    scene.rows[4][4] = "2500"
    scene.rows[5][8] = "-"
    scene.rows[6] = scene.rows[6][:50]
    scene.rows[8][3] = "7"
    source = scene.opened()
    assert counted(source) == {
        ("kinect", Reason.MALFORMED_ROW): 1,
        ("kinect", Reason.NOT_FINITE): 2,
        ("kinect", Reason.OUT_OF_RANGE): 1,
    }
    batches = frames(source)
    assert len(batches) == 59
    assert (batches[3].position[0][0], batches[3].state[0][0]) == (None, TrackingState.NOT_TRACKED)
    assert batches[7].state[0][0] == TrackingState.NOT_TRACKED
    # The row that was left out leaves its time out.
    assert batches[6].captured_ns[0] - batches[5].captured_ns[0] == pytest.approx(2e9 / 30, abs=2)


def test_times_that_go_back_are_counted(scene):
    scene.toml = HEAD_TOML + AZURE
    scene.azure_rows[31][0] = "1"
    source = scene.opened()
    assert counted(source) == {("azure", Reason.CLOCK_BACKWARDS): 1}
    assert len(frames(source)) == 59
    for row in scene.azure_rows[1:]:
        row[0] = "5"
    with pytest.raises(ClockError, match="check column and unit of time"):
        scene.opened()


@pytest.mark.parametrize(("factor", "unit"), [(1000, "mm"), (100, "cm")])
def test_millimetres_taken_for_metres_are_named(scene, factor, unit):
    scene.scaled(factor)
    with pytest.raises(WrongUnits, match=f'kinect.csv, camera kinect: a trunk .* write unit = "{unit}"'):
        scene.opened()
    scene.toml = scene.toml.replace('name = "kinect"', f'name = "kinect"\nunit = "{unit}"')
    assert frames(scene.opened())[0].position[0][0] == pytest.approx(STANDING[J.SPINE_BASE], abs=1e-4)


def test_metres_taken_for_millimetres_are_named(scene):
    scene.toml = scene.toml.replace('name = "kinect"', 'name = "kinect"\nunit = "mm"')
    with pytest.raises(WrongUnits, match='write unit = "m" for the camera'):
        scene.opened()


@pytest.mark.parametrize(
    ("axes", "words"),
    [
        ('["-z", "-y", "-x"]', "the shoulders are below the hips"),
        ('["-z", "x", "-y"]', "the trunk lies across the direction up"),
        ('["z", "y", "-x"]', "the right shoulder is on the left"),
    ],
)
def test_wrong_axes_are_named(scene, axes, words):
    scene.toml = scene.toml.replace('name = "kinect"', f'name = "kinect"\naxes = {axes}')
    with pytest.raises(WrongAxes, match=f"kinect.csv, camera kinect: {words}"):
        scene.opened()


def test_a_few_frames_upside_down_are_the_cameras_fault_not_the_manifests(scene):
    for row in scene.rows[:5]:
        for at in range(1, 100, 4):
            row[at] = f"{-float(row[at]):.6g}"
    assert len(frames(scene.opened())) == 60


def test_a_floor_plane_levels_and_tells_the_floor(scene):
    scene.toml = scene.toml.replace('name = "kinect"', 'name = "kinect"\nfloor_plane = [0.0, 2.0, 0.0, 1.8]')
    source = scene.opened()
    assert source.describe().cameras[0].floor_m == pytest.approx(-0.9)
    assert frames(source)[0].position[0][0] == pytest.approx(STANDING[J.SPINE_BASE], abs=1e-4)


def test_many_short_rows_are_refused_with_their_line(scene):
    for k in range(20, 30):
        scene.rows[k] = scene.rows[k][:40]
    with pytest.raises(WrongFieldCount, match=r"kinect\.csv, line 21: 40 fields where 101 are expected"):
        scene.opened()


def test_an_empty_file_is_refused(scene):
    scene.rows = []
    with pytest.raises(EmptyFile, match=r"kinect\.csv"):
        scene.opened()


def test_joined_frames_keep_their_marks(scene):
    mark = StandingMark(from_ns=0, to_ns=50_000_000, given_ns=60_000_000)
    messages = [
        m._replace(payload=m.payload.model_copy(update={"marks": [mark] if k in (2, 3) else []}))
        for k, m in enumerate(scene.opened().messages())
    ]
    joined = [m.payload.marks for m in in_batches(iter(messages), 5)]
    assert joined == [[mark, mark]] + [[]] * 11


def test_frames_joined_and_split_are_the_same(scene):
    source = scene.opened()
    joined = [m.payload for m in in_batches(source.messages(), 7)]
    assert [len(payload.captured_ns) for payload in joined] == [7] * 8 + [4]
    single = frames(source)
    for field in ("captured_ns", "body", "people", "position", "state"):
        assert [row for payload in joined for row in getattr(payload, field)] == [
            row for payload in single for row in getattr(payload, field)
        ]
