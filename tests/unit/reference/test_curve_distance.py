import math

import pytest

from services.reference.curve_distance import VARIABLES, curve_distance, root_mean_square


def test_one_variable_apart_counts_a_quarter_of_its_square():
    curves = {name: [0.1] * 101 for name in VARIABLES}
    other = curves | {"knee_flexion": [0.3] * 101}
    found = curve_distance(curves, other)
    assert found.by_variable["knee_flexion"] == pytest.approx(0.2)
    assert found.distance == pytest.approx(0.1)
    assert curve_distance(curves, curves).distance == 0.0


def test_a_sine_lies_its_amplitude_over_root_two_from_its_mean():
    sine = [math.sin(2 * math.pi * k / 100) for k in range(100)]
    assert root_mean_square(sine, [0.0] * 100) == pytest.approx(1 / math.sqrt(2))


def test_without_all_four_there_is_no_distance():
    found = curve_distance({"knee_flexion": [0.1] * 101}, {"knee_flexion": [0.2] * 101, "hip_flexion": [0.0] * 101})
    assert found.distance is None
    assert found.missing == ("pelvis_tilt", "hip_flexion", "ankle_dorsiflexion")


def test_curves_of_different_length_are_a_bug():
    with pytest.raises(ValueError, match="shorter"):
        root_mean_square([0.1] * 101, [0.1] * 51)
