import math
import sys
from pathlib import Path

import numpy as np
import pytest

from schemas.session import Placement
from schemas.vocabulary import Segment
from services.biomech.rotations import angle_between
from services.estimation.lower_body.axis_search import AxisSearch, placed_right, principal_direction, walking_signs
from services.estimation.parameters import AlignmentParameters
from services.estimation.standing import StandingReference

sys.path.insert(0, str(Path(__file__).parent))
from tests.unit.estimation import estimation_walks as walks

LEG_SENSORS = range(1, 5)


def search(placements: dict[Segment, Placement] | None = None) -> AxisSearch:
    sensors = walks.describe(placements=placements).hubs[0].sensors
    up = np.array([walks.mounting()[segment].T @ [0.0, 9.81, 0.0] for segment in walks.SEGMENTS])
    everyone = np.ones(5, dtype=np.bool_)
    reference = StandingReference(0, 2.0, up, walks.gyro_bias(), everyone, ~everyone)
    return AxisSearch(sensors, reference, AlignmentParameters())


def walked(seconds: float):
    samples = walks.walk()[1][250 : 250 + int(seconds * 100)]
    return samples, np.ones(samples.shape[:2], dtype=np.bool_)


@pytest.mark.parametrize("placements", [None, {}], ids=["placed", "unknown placement"])
def test_axes_point_to_the_right(placements) -> None:
    axes = search(placements).axes(*walked(5.0))
    for s in LEG_SENSORS:
        truth = walks.mounting()[walks.SEGMENTS[s]][2]
        assert angle_between(axes[s].right, truth) < math.radians(5)
        assert axes[s].sign_is_placed == (placements is None)


def test_clear_only_after_enough_walking_and_a_steady_axis() -> None:
    subject = search()
    early, late, later = (subject.axes(*walked(seconds)) for seconds in (0.8, 4.5, 5.0))
    assert not subject.is_clear(early, early)
    assert subject.is_clear(later, late)
    assert not subject.is_clear(later, {}), "one look is not enough"


def test_a_sensor_without_standing_gets_no_frame() -> None:
    subject = search()
    subject.reference.usable[2] = False
    alignment = subject.align(subject.axes(*walked(4.0)))
    np.testing.assert_array_equal(alignment.aligned, [True, True, False, True, True])
    assert alignment.quality[2] == 0.0


def test_without_an_axis_the_placement_serves_with_low_quality() -> None:
    subject = search()
    alignment = subject.align({})
    assert alignment.aligned.all()
    for s in LEG_SENSORS:
        np.testing.assert_allclose(alignment.R_segment_from_sensor[s], walks.mounting()[walks.SEGMENTS[s]], atol=1e-9)
        assert alignment.quality[s] < 0.5


def test_pelvis_frame_comes_from_its_placement() -> None:
    alignment = search().align({})
    np.testing.assert_allclose(alignment.R_segment_from_sensor[0], walks.mounting()[Segment.PELVIS], atol=1e-9)


@pytest.mark.parametrize(
    ("segment", "placement", "right"),
    [
        # Sensor y up, z out of the skin. Right is forward x up: z x y = -x for an anterior sensor.
        (Segment.THIGH_LEFT, Placement.ANTERIOR, [-1, 0, 0]),
        (Segment.THIGH_LEFT, Placement.POSTERIOR, [1, 0, 0]),
        (Segment.SHANK_RIGHT, Placement.LATERAL, [0, 0, 1]),
        (Segment.SHANK_LEFT, Placement.LATERAL, [0, 0, -1]),
        (Segment.SHANK_RIGHT, Placement.MEDIAL, [0, 0, -1]),
        (Segment.SHANK_LEFT, Placement.MEDIAL, [0, 0, 1]),
    ],
)
def test_what_a_placement_tells(segment: Segment, placement: Placement, right: list[float]) -> None:
    sensor = walks.describe(hubs=[[segment]], placements={segment: placement}).hubs[0].sensors[0]
    found = placed_right(sensor, np.array([0.0, 1.0, 0.0]))
    np.testing.assert_allclose(found, right, atol=1e-12)


def test_a_placement_that_tells_nothing() -> None:
    sensor = walks.describe(hubs=[[Segment.PELVIS]], placements={}).hubs[0].sensors[0]
    assert placed_right(sensor, np.array([0.0, 1.0, 0.0])) is None
    facing_up = sensor.model_copy(update={"placement": Placement.ANTERIOR})
    assert placed_right(facing_up, np.array([0.0, 0.0, 1.0])) is None


def test_turning_about_the_vertical_does_not_move_the_axis() -> None:
    """A turn is much faster than the flexion, yet the projection takes it out."""
    random = np.random.default_rng(0)
    up, right = np.array([0.0, 0.6, 0.8]), np.array([1.0, 0.0, 0.0])
    rate = random.normal(size=(500, 1)) * right + 5.0 * up + 0.05 * random.normal(size=(500, 3))
    axis, ratio, moving = principal_direction(rate, up, 0.5)
    assert abs(axis @ right) > 0.999
    assert ratio < 0.05
    assert 200 < moving < 400


def test_signs_from_the_walk_alone() -> None:
    t = np.arange(0, 4, 0.01)
    shank = np.maximum(np.sin(2 * np.pi * t), 0) ** 3 * 5.0 - 0.8
    thigh = 2.0 * np.sin(2 * np.pi * (t + 0.15))
    assert walking_signs(thigh, shank, 100.0) == (1.0, 1.0)
    assert walking_signs(-thigh, shank, 100.0) == (-1.0, 1.0)
    assert walking_signs(thigh, -shank, 100.0) == (1.0, -1.0)
    assert walking_signs(None, -shank, 100.0) == (1.0, -1.0)


def test_a_sensor_that_fell_silent_is_not_waited_for() -> None:
    subject = search()
    samples, fresh = walked(5.0)
    fresh[100:, 2] = False
    axes = subject.axes(samples, fresh)
    assert sorted(axes) == [1, 3, 4]
    assert subject.is_clear(axes, axes)
    assert subject.align(axes).aligned.all(), "its placement serves"
