import numpy as np
import pytest

from schemas.session import Anthropometry
from schemas.vocabulary import Side
from services.segmentation.batch import DOFS, INDEX
from services.segmentation.gait.history import Instant
from services.segmentation.gait.step_length import step_length

BODY = Anthropometry(
    height_m=None, mass_kg=None, thigh_length_m=0.4, shank_length_m=0.4, hip_width_m=0.2, source="measured"
)


def instant(std: float = 0.0, invalid: str | None = None, **angles: float) -> Instant:
    position, valid = np.zeros(DOFS), np.ones(DOFS, dtype=bool)
    for name, value in angles.items():
        position[INDEX[name]] = value
    if invalid:
        valid[INDEX[invalid]] = False
    return Instant(position, np.full(DOFS, std), valid, None)


SPLIT = {"hip_flexion_left": 0.4, "hip_flexion_right": -0.4}


def test_stiff_legs_apart():
    found = step_length(Side.LEFT, instant(**SPLIT), instant(), 0.0, BODY, foot_roll_share=0.0)
    assert found.length_m == pytest.approx(2 * 0.8 * np.sin(0.4))
    assert found.std_m == 0.0


def test_the_foot_behind_has_a_negative_step():
    found = step_length(Side.RIGHT, instant(**SPLIT), instant(), 0.0, BODY, foot_roll_share=0.0)
    assert found.length_m == pytest.approx(-2 * 0.8 * np.sin(0.4))


def test_foot_roll_adds_what_the_trailing_shank_leaned():
    then = instant(hip_flexion_right=0.3)
    found = step_length(Side.LEFT, instant(**SPLIT), then, 0.0, BODY, foot_roll_share=0.1)
    assert found.length_m == pytest.approx(2 * 0.8 * np.sin(0.4) + 0.08 * (0.4 + 0.3))


def test_heading_does_not_matter_but_turning_away_from_the_walk_does():
    turned = instant(pelvis_rotation=2.0, **SPLIT)
    straight = step_length(Side.LEFT, turned, turned, 2.0, BODY, 0.0)
    assert straight.length_m == pytest.approx(2 * 0.8 * np.sin(0.4))
    # A pelvis rotated to the right carries its left hip forward.
    rotated = instant(pelvis_rotation=-0.1)
    assert step_length(Side.LEFT, rotated, rotated, 0.0, BODY, 0.0).length_m == pytest.approx(0.2 * np.sin(0.1))


def test_deviation_by_hand():
    found = step_length(Side.LEFT, instant(std=0.02), instant(), 0.0, BODY, 0.0)
    # Standing, each hip and the tilt, which moves both ankles alike, act with 0.8 m, each knee with 0.4 m, and the
    # heading with the hip width.
    expected = 0.02 * np.sqrt(2 * 0.8**2 + 2 * 0.4**2 + 0.2**2)
    assert found.std_m == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("name", ["pelvis_tilt", "hip_flexion_left", "knee_flexion_right", "hip_adduction_left"])
def test_without_an_angle_no_length(name):
    assert step_length(Side.LEFT, instant(invalid=name), instant(), 0.0, BODY, 0.0) is None
    assert step_length(Side.LEFT, instant(), instant(invalid=name), 0.0, BODY, 0.0) is None
