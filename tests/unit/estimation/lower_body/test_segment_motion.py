"""The vertical of a lone segment, and its motion in the heading frame."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from schemas.session import Placement, SensorDescription
from schemas.vocabulary import Segment
from services.biomech.rotations import rotation_about
from services.estimation.lower_body.segment_motion import LoneSegments, Vertical, into_heading, pelvis_up
from services.estimation.parameters import SegmentMotionParameters
from services.estimation.samples import Tick

PARAMETERS = SegmentMotionParameters()
X, Y, Z = np.eye(3)
small = st.floats(-1.2, 1.2)


@given(small, small)
def test_the_vertical_of_the_pelvis_is_that_of_its_angles(tilt, obliquity):
    R_heading_from_pelvis = rotation_about(-Z, tilt) @ rotation_about(-X, obliquity)
    np.testing.assert_allclose(pelvis_up(tilt, obliquity), R_heading_from_pelvis.T @ Y, atol=1e-12)


@given(small, small, st.floats(-3.0, 3.0))
def test_the_heading_frame_knows_level_and_upright(tilt, obliquity, turned):
    R = rotation_about(Y, turned) @ rotation_about(Z, tilt) @ rotation_about(X, obliquity)
    up = tuple((R.T @ Y).tolist())
    np.testing.assert_allclose(into_heading(up, up), Y, atol=1e-9)
    right = into_heading(up, (0.0, 0.0, 1.0))
    assert right[0] == pytest.approx(0.0, abs=1e-9)
    assert right[2] == pytest.approx(math.hypot(up[0], up[1]))
    vector = (0.3, -1.1, 0.7)
    assert math.hypot(*into_heading(up, vector)) == pytest.approx(math.hypot(*vector))


def test_a_segment_that_lies_on_its_side_gives_numbers():
    assert all(map(math.isfinite, into_heading((0.0, 0.0, 1.0), (1.0, 2.0, 3.0))))


@pytest.mark.parametrize("rate_hz", [50.0, 200.0])
def test_the_vertical_follows_a_foot_that_turns(rate_hz):
    """A foot that rocks about its right axis while the accelerometer says nothing but noise of walking."""
    vertical, angle = Vertical(PARAMETERS), 0.0
    random = np.random.default_rng(2)
    for k in range(int(20 * rate_hz)):
        time_s = k / rate_hz
        pitch = 0.8 * math.sin(2 * math.pi * time_s) * min(time_s, 1.0)
        rate, angle = (pitch - angle) * rate_hz, pitch
        force = rotation_about(Z, -pitch) @ (9.81 * Y + random.normal(size=3) * 3.0)
        up = vertical.step(round(time_s * 1e9), (0.0, 0.0, rate), tuple(force.tolist()))
    expected = rotation_about(Z, -angle) @ Y
    assert math.acos(min(1.0, float(np.dot(up, expected)))) < 0.1


def test_after_a_gap_the_foot_is_taken_to_be_flat():
    vertical = Vertical(PARAMETERS)
    vertical.step(0, (0.0, 0.0, 0.0), (0.0, 9.81, 0.0))
    for k in range(1, 30):
        vertical.step(k * 10_000_000, (0.0, 0.0, 3.0), (0.0, 9.81, 0.0))
    assert vertical.up[1] < 0.8
    assert vertical.step(2_000_000_000, (0.0, 0.0, 3.0), (0.0, 9.81, 0.0))[1] == pytest.approx(1.0)


def lone() -> LoneSegments:
    def sensor(segment: Segment) -> SensorDescription:
        return SensorDescription(
            name=segment.value, segment=segment, rate_hz=100.0, outward_axis=[0, 0, 1],
            placement=Placement.UNKNOWN, position_in_segment=None,
        )  # fmt: skip

    worn = [sensor(Segment.PELVIS), sensor(Segment.SHANK_LEFT), sensor(Segment.FOOT_RIGHT)]
    frames = np.tile(np.eye(3), (3, 1, 1))
    segments = (Segment.PELVIS, Segment.FOOT_RIGHT, Segment.FOOT_LEFT)
    return LoneSegments(worn, segments, frames, np.full((3, 3), 0.01), [True, True, True], PARAMETERS)


def tick(k: int, fresh: tuple[bool, bool, bool] = (True, True, True)) -> Tick:
    samples = np.random.default_rng(k).normal(size=(3, 6)) + np.array([0, 0, 0, 0, 9.81, 0])
    return Tick(k * 10_000_000, samples, np.array(fresh))


def test_only_fresh_samples_of_the_wanted_segments_are_gathered():
    followed = lone()
    followed.take(tick(0), 0.0, 0.0)
    followed.take(tick(1, (True, True, False)), 0.0, 0.0)
    motion = followed.collect([0, 10_000_000])
    assert [samples.segment for samples in motion.segments] == [Segment.PELVIS, Segment.FOOT_RIGHT]
    assert [samples.captured_ns for samples in motion.segments] == [[0, 10_000_000], [0]]
    sample = tick(0).samples[0]
    np.testing.assert_allclose(motion.segments[0].acceleration[0], sample[3:] - [0, 9.81, 0])
    np.testing.assert_allclose(motion.segments[0].angular_velocity[0], sample[:3] - 0.01)
    assert all(not samples.captured_ns for samples in followed.collect([20_000_000]).segments)


def test_the_vertical_survives_a_snapshot():
    whole, first = lone(), lone()
    for k in range(40):
        whole.take(tick(k), 0.0, 0.0)
        first.take(tick(k), 0.0, 0.0)
    for followed in (whole, first):
        followed.collect([0])
    resumed = lone()
    resumed.restore(json.loads(json.dumps(first.snapshot())))
    for followed in (whole, resumed):
        followed.take(tick(40), 0.1, 0.0)
    assert whole.collect([0]) == resumed.collect([0])
