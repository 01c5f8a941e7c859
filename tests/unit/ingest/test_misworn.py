"""Sensors worn otherwise than declared: what they say is the other segment's, or upside down."""

import numpy as np
import pytest

from schemas.vocabulary import Segment
from services.ingest.synthetic.motions import parse_motion

QUIET = "duration=6&worn=1&gyro_noise=0&accel_noise=0&gyro_bias=0&accel_bias=0"


def tracks(options: str):
    session = parse_motion("walk", options)
    names = [sensor.name for sensor in session.description().hubs[0].sensors]
    return dict(zip(names, next(iter(session.samples())).sensors, strict=True))


def test_swapped_sensors_keep_their_names_and_say_what_the_other_segment_does():
    declared, swapped = tracks(QUIET), tracks(QUIET + "&misworn=1")
    assert list(swapped) == list(declared) == ["thigh_left", "shank_left"]
    for name, other in (("thigh_left", "shank_left"), ("shank_left", "thigh_left")):
        np.testing.assert_array_equal(swapped[name].angular_velocity, declared[other].angular_velocity)
        np.testing.assert_array_equal(swapped[name].specific_force, declared[other].specific_force)


@pytest.mark.parametrize(("misworn", "turned"), [(2, "thigh_left"), (3, "shank_left")])
def test_a_sensor_upside_down_is_turned_about_the_way_out_of_the_skin(misworn, turned):
    declared, worn = tracks(QUIET), tracks(f"{QUIET}&misworn={misworn}")
    for name, track in worn.items():
        sign = [-1.0, -1.0, 1.0] if name == turned else [1.0, 1.0, 1.0]
        np.testing.assert_allclose(track.specific_force, declared[name].specific_force * sign, atol=1e-12)


@pytest.mark.parametrize("misworn", [1, 2, 3])
def test_the_description_is_what_was_declared(misworn):
    sensors = parse_motion("walk", f"{QUIET}&misworn={misworn}").description().hubs[0].sensors
    assert [sensor.segment for sensor in sensors] == [Segment.THIGH_LEFT, Segment.SHANK_LEFT]
    assert sensors == parse_motion("walk", QUIET).description().hubs[0].sensors
