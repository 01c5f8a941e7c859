import pytest

from schemas.session import CameraDescription
from schemas.vocabulary import CameraKind, EventSource, Segment, Side, SkeletonJoint
from services.biomech.event_sources import (
    event_source,
    event_sources,
    lone_segments,
    session_event_sources,
    session_lone_segments,
    used_segments,
    uses_camera,
    whole_legs,
)
from services.ingest.source import open_source

LEFT_LEG = {Segment.THIGH_LEFT, Segment.SHANK_LEFT}
FEET = {Segment.FOOT_LEFT, Segment.FOOT_RIGHT}


@pytest.mark.parametrize(
    ("worn", "source"),
    [
        ({Segment.PELVIS, *LEFT_LEG, *FEET}, EventSource.FULL_LEG),
        ({*LEFT_LEG, *FEET}, EventSource.SHANK),
        ({Segment.PELVIS, Segment.SHANK_LEFT, *FEET}, EventSource.SHANK),
        ({Segment.PELVIS, Segment.THIGH_LEFT, *FEET}, EventSource.FOOT),
        ({Segment.PELVIS, Segment.THIGH_LEFT}, EventSource.LOWER_BACK),
        ({Segment.PELVIS, Segment.FOOT_RIGHT}, EventSource.LOWER_BACK),
        ({Segment.THIGH_LEFT, Segment.FOOT_RIGHT, Segment.TORSO}, EventSource.NOTHING),
        (set(), EventSource.NOTHING),
    ],
)
def test_the_best_that_is_worn_tells_a_leg(worn, source):
    assert event_source(worn, Side.LEFT) is source


def test_an_estimator_of_knees_uses_whole_legs_alone():
    assert whole_legs({*LEFT_LEG, Segment.SHANK_RIGHT}) == (Side.LEFT,)
    everyone = "synthetic:walk?duration=5&feet=1"
    assert len(used_segments(open_source(everyone, estimator="ekf").describe())) == 7
    used = used_segments(open_source(everyone, estimator="knee_axis").describe())
    assert event_sources(used) == dict.fromkeys(Side, EventSource.SHANK)
    assert not lone_segments(used)


def test_each_leg_has_its_own_source():
    sources = event_sources({Segment.PELVIS, *LEFT_LEG, Segment.FOOT_RIGHT})
    assert sources == {Side.LEFT: EventSource.FULL_LEG, Side.RIGHT: EventSource.FOOT}


def test_only_what_tells_events_alone_is_followed_alone():
    assert lone_segments({Segment.PELVIS, *LEFT_LEG, *FEET}) == (Segment.FOOT_RIGHT,)
    assert lone_segments({Segment.PELVIS, Segment.SHANK_LEFT}) == (Segment.PELVIS,)
    assert lone_segments({Segment.SHANK_LEFT, Segment.SHANK_RIGHT, *FEET}) == ()


CAMERA = CameraDescription(
    name="camera", kind=CameraKind.KINECT_V2, rate_hz=30, joints=list(SkeletonJoint)[:25], floor_m=None
)


@pytest.mark.parametrize(
    ("spec", "estimator", "expected"),
    [
        ("synthetic:walk?worn=0", "body_cekf", EventSource.CAMERA),
        ("synthetic:walk?worn=0", "fusion", EventSource.FULL_LEG),
        ("synthetic:walk?worn=3", "fusion", EventSource.CAMERA),
    ],
)
def test_a_camera_tells_events_where_no_leg_wears_sensors_that_are_used(spec, estimator, expected):
    description = open_source(spec, estimator="ekf").describe()
    seen = description.model_copy(update={"estimator": estimator, "cameras": [CAMERA]})
    assert uses_camera(seen)
    assert session_event_sources(seen) == dict.fromkeys(Side, expected)
    assert session_lone_segments(seen) == ()


def test_a_camera_that_is_not_used_tells_nothing():
    description = open_source("synthetic:walk?worn=3", estimator="ekf").describe()
    seen = description.model_copy(update={"cameras": [CAMERA]})
    assert not uses_camera(seen)
    assert (
        session_event_sources(seen) == session_event_sources(description) == dict.fromkeys(Side, EventSource.LOWER_BACK)
    )
    assert session_lone_segments(seen) == (Segment.PELVIS,)
