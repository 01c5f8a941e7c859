"""A hand-posed person before each camera stands in the room as it should."""

import math

import numpy as np
import pytest

from schemas.vocabulary import CameraKind, JointCentre, SkeletonJoint, TrackingState
from services.ingest.errors import InvalidManifest, UnknownUnit, WrongAxes
from services.ingest.skeleton import (
    AZURE_KINECT_JOINTS,
    KINECT_V2_JOINTS,
    frames_in_room,
    plane_of_floor,
    skeleton_batch,
    view_of,
)
from services.ingest.skeleton.spine import along, with_interpolated
from tests.unit.ingest.posed_person import STANDING, in_room, seen_by_azure, seen_by_kinect_v2

J = SkeletonJoint
V2, AZURE = CameraKind.KINECT_V2, CameraKind.AZURE_KINECT


def column(frames, joint):
    return frames.position[0, frames.joints.index(joint)]


def test_kinect_v2_joints_are_those_of_the_sdk():
    """JointType of the Kinect for Windows SDK 2.0, by value."""
    sdk = "SpineBase SpineMid Neck Head ShoulderLeft ElbowLeft WristLeft HandLeft ShoulderRight ElbowRight " \
          "WristRight HandRight HipLeft KneeLeft AnkleLeft FootLeft HipRight KneeRight AnkleRight FootRight " \
          "SpineShoulder HandTipLeft ThumbLeft HandTipRight ThumbRight"  # fmt: skip
    assert ["".join(part.title() for part in joint.split("_")) for joint in KINECT_V2_JOINTS] == sdk.split()


def test_azure_kinect_joints_are_those_of_the_sdk():
    """k4abt_joint_id_t of the Azure Kinect Body Tracking SDK, by value; its pelvis is our spine_base."""
    sdk = "PELVIS SPINE_NAVEL SPINE_CHEST NECK CLAVICLE_LEFT SHOULDER_LEFT ELBOW_LEFT WRIST_LEFT HAND_LEFT " \
          "HANDTIP_LEFT THUMB_LEFT CLAVICLE_RIGHT SHOULDER_RIGHT ELBOW_RIGHT WRIST_RIGHT HAND_RIGHT HANDTIP_RIGHT " \
          "THUMB_RIGHT HIP_LEFT KNEE_LEFT ANKLE_LEFT FOOT_LEFT HIP_RIGHT KNEE_RIGHT ANKLE_RIGHT FOOT_RIGHT HEAD NOSE " \
          "EYE_LEFT EAR_LEFT EYE_RIGHT EAR_RIGHT"  # fmt: skip
    names = [
        joint.upper().replace("HAND_TIP", "HANDTIP").replace("SPINE_BASE", "PELVIS") for joint in AZURE_KINECT_JOINTS
    ]
    assert names == sdk.split()


@pytest.mark.parametrize(
    ("kind", "joints", "seen"), [(V2, KINECT_V2_JOINTS, seen_by_kinect_v2), (AZURE, AZURE_KINECT_JOINTS, seen_by_azure)]
)
def test_who_raises_the_right_hand_raises_it_on_the_right(kind, joints, seen):
    frames = frames_in_room(view_of(kind), np.array([[seen(in_room(joint)) for joint in joints]]))
    assert column(frames, J.WRIST_RIGHT) == pytest.approx([-2.5, 0.5, 0.7])
    assert column(frames, J.HEAD)[1] > column(frames, J.ANKLE_LEFT)[1] + 1.5
    for joint in frames.joints:
        assert column(frames, joint) == pytest.approx(in_room(joint), abs=1e-4), joint
    assert (frames.state == 2).all()
    assert frames.not_finite == frames.out_of_range == 0


@pytest.mark.parametrize("kind", [V2, AZURE])
def test_every_camera_gives_the_fifteen_centres_first(kind):
    room = view_of(kind).room_joints
    assert [str(joint) for joint in room[:15]] == list(JointCentre)
    assert len(set(room)) == len(room)


def test_a_tilted_camera_is_levelled_by_its_floor():
    """A Kinect v2 that looks down by 20 deg from 0.9 m sees the floor as a slanted plane."""
    pitch = math.radians(20)
    up = [0.0, math.cos(pitch), -math.sin(pitch)]
    found, floor_m = plane_of_floor([*up, 0.9])
    assert (found, floor_m) == (pytest.approx(up), pytest.approx(-0.9))
    assert plane_of_floor([-value for value in [*up, 0.9]]) == (pytest.approx(up), pytest.approx(-0.9))

    def seen(point):
        forward, above, right = -point[0], point[1], point[2]
        return [right, above * up[1] + forward * -up[2], forward * up[1] + above * up[2]]

    view = view_of(V2, up=found)
    assert view.R_room_from_camera @ view.R_room_from_camera.T == pytest.approx(np.eye(3))
    assert np.linalg.det(view.R_room_from_camera) == pytest.approx(1.0)
    frames = frames_in_room(view, np.array([[seen(in_room(joint)) for joint in KINECT_V2_JOINTS]]))
    for joint in KINECT_V2_JOINTS:
        assert column(frames, joint) == pytest.approx(in_room(joint)), joint


def test_a_program_that_turns_the_axes_does_not_turn_the_camera():
    """Written with y up and z to the camera, m, what an Azure Kinect sees still comes from a lens that looks down."""
    as_seen = np.array([[seen_by_azure(in_room(joint)) for joint in AZURE_KINECT_JOINTS]])
    rewritten = as_seen * [1.0, -1.0, -1.0] / 1000
    usual = frames_in_room(view_of(AZURE), as_seen)
    other = frames_in_room(view_of(AZURE, axes=["z", "y", "-x"], unit="m"), rewritten)
    assert other.position == pytest.approx(usual.position)


def test_spine_centres_of_an_azure_kinect_lie_on_its_spine():
    assert {J.SPINE_MID, J.SPINE_SHOULDER}.isdisjoint(AZURE_KINECT_JOINTS)
    bent = dict(STANDING) | {J.SPINE_CHEST: (-2.4, 0.38, 0.0)}
    positions = np.array([[seen_by_azure(bent.get(joint, STANDING[J.HEAD])) for joint in AZURE_KINECT_JOINTS]])
    frames = frames_in_room(view_of(AZURE), positions)
    middle = column(frames, J.SPINE_MID)
    navel, chest = np.array(bent[J.SPINE_NAVEL]), np.array(bent[J.SPINE_CHEST])
    assert np.linalg.norm(middle - navel) + np.linalg.norm(chest - middle) == pytest.approx(
        np.linalg.norm(chest - navel), abs=1e-5
    )


def test_the_way_along_a_chain_is_measured_on_its_bones():
    chain = np.array([[[0.0, 0, 0], [1, 0, 0], [1, 3, 0]], [[0, 0, 0], [2, 0, 0], [2, 0, 2]]])
    assert along(chain, 0.5) == pytest.approx(np.array([[1.0, 1, 0], [2, 0, 0]]))
    assert along(chain, 0.0) == pytest.approx(chain[:, 0])
    assert along(chain, 1.0) == pytest.approx(chain[:, -1])


def test_what_is_interpolated_is_known_as_well_as_what_it_comes_from():
    positions = np.array([[seen_by_azure(in_room(joint)) for joint in AZURE_KINECT_JOINTS]] * 3)
    codes = np.full(positions.shape[:2], 2)
    codes[1, AZURE_KINECT_JOINTS.index(J.CLAVICLE_LEFT)] = 1
    codes[2, AZURE_KINECT_JOINTS.index(J.SPINE_NAVEL)] = 0
    frames = frames_in_room(view_of(AZURE), positions, codes)
    mid, top = frames.joints.index(J.SPINE_MID), frames.joints.index(J.SPINE_SHOULDER)
    assert frames.state[:, top].tolist() == [2, 1, 2]
    assert frames.state[:, mid].tolist() == [2, 1, 0]
    assert np.isnan(frames.position[2, mid]).all()


@pytest.mark.parametrize(("kind", "expected"), [(V2, [0, 1, 2, 0, 0]), (AZURE, [0, 1, 2, 2, 0])])
def test_states_of_the_vendor_become_ours(kind, expected):
    """0 to 4 and a code that no SDK has."""
    view = view_of(kind)
    codes = np.array([[0], [1], [2], [3], [-1]]) * np.ones(len(view.joints), dtype=np.int64)
    assert view.state_numbers(codes)[:, 0].tolist() == expected


def test_what_is_no_place_is_not_tracked_and_counted():
    positions = np.array([[seen_by_kinect_v2(in_room(joint)) for joint in KINECT_V2_JOINTS]] * 2)
    positions[0, 3] = [np.nan, 0, 0]
    positions[0, 4] = [0, 0, 2500.0]
    positions[0, 5] = 0.0
    positions[1, 6] = np.inf
    codes = np.full(positions.shape[:2], 2)
    codes[1, 6] = 0
    frames = frames_in_room(view_of(V2), positions, codes)
    assert (frames.not_finite, frames.out_of_range) == (1, 2)
    lost = {str(frames.joints[j]) for k, j in np.argwhere(frames.state == 0) if k == 0}
    assert lost == {"head", "shoulder_left", "elbow_left"}
    batch = skeleton_batch([0, 33_000_000], [1, None], [1, 0], frames)
    head = frames.joints.index(J.HEAD)
    assert (batch.position[0][head], batch.state[0][head]) == (None, TrackingState.NOT_TRACKED)
    assert batch.state[1][head] == TrackingState.TRACKED
    assert batch.position[1][head] == pytest.approx([-2.5, 0.78, 0.0])


def test_another_camera_says_its_joints_and_axes():
    joints = [J.HIP_LEFT, J.HIP_RIGHT, J.SHOULDER_LEFT, J.SHOULDER_RIGHT, J.KNEE_LEFT]
    view = view_of(CameraKind.OTHER, joints=joints, axes=["x", "z", "-y"], unit="cm")
    position = np.array([[[-250, 9, 0], [-250, -9, 0], [-250, 18, 50], [-250, -18, 50], [-250, 10, -42.0]]])
    frames = frames_in_room(view, position)
    assert frames.joints == with_interpolated(joints)
    assert set(frames.joints) - set(joints) == {J.SPINE_BASE, J.SPINE_MID, J.SPINE_SHOULDER}
    assert column(frames, J.HIP_RIGHT) == pytest.approx([-2.5, 0.0, 0.09])
    assert column(frames, J.SPINE_BASE) == pytest.approx([-2.5, 0.0, 0.0])
    assert column(frames, J.SPINE_SHOULDER) == pytest.approx([-2.5, 0.5, 0.0])


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"up": [0, 1.0, 0]}, WrongAxes, "180 deg from the camera's own upward axis"),
        ({"up": [0, 0, 0]}, WrongAxes, "is no direction"),
        ({"up": [0, math.nan, 0]}, WrongAxes, "is no direction"),
        ({"up": [0, 1.0]}, WrongAxes, "is no direction"),
        ({"axes": ["x", "y", "-z"]}, InvalidManifest, "no right-handed rotation"),
        ({"unit": "ft"}, UnknownUnit, "write one of m, cm, mm"),
    ],
)
def test_a_view_that_cannot_be_is_refused(given, error, words):
    with pytest.raises(error, match=words):
        view_of(AZURE, **given)


def test_up_that_points_down_is_refused_for_both_cameras():
    with pytest.raises(WrongAxes, match="check its sign"):
        view_of(V2, up=[0, -1, 0])
    with pytest.raises(WrongAxes, match="check its sign"):
        view_of(AZURE, up=[0, 1, 0])


@pytest.mark.parametrize("plane", [[0, 0, 0, 0.9], [0, 1, 0, 0.0], [0, 1, 0, math.inf], [0, 0, 0, 0]])
def test_no_floor_is_no_plane(plane):
    with pytest.raises(WrongAxes, match="floor plane"):
        plane_of_floor(plane)


def test_an_unknown_camera_must_say_what_it_is():
    with pytest.raises(WrongAxes, match="give its joints in order, and its axes"):
        view_of(CameraKind.OTHER, joints=[J.HEAD])
