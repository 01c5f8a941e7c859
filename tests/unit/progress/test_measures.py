import pytest

from services.definitions.definition import Basis
from services.definitions.table import BY_NAME, DEFINITIONS
from services.progress.measures import ORDER, SMALLEST_KNEE_CHANGE, Better, is_followed, measure_of


def test_what_comes_first_and_what_has_a_better_side_exists():
    assert set(ORDER) <= set(BY_NAME)
    better = {name: measure_of(name).better for name in BY_NAME}
    assert {name for name, way in better.items() if way is Better.LOWER} == {"tug_time", "ten_metre_walk_time"}
    assert better["six_minute_walk_distance"] is better["walking_speed"] is Better.HIGHER


def test_counts_and_what_is_for_files_alone_are_not_followed():
    for definition in DEFINITIONS:
        if definition.export_only or definition.basis is Basis.COUNT:
            assert not is_followed(definition.name), definition.name
    assert is_followed("walking_speed")
    assert is_followed("step_length_ratio_paretic_to_non_paretic")


@pytest.mark.parametrize("name", ["knee_flexion_range", "marching_knee_flexion_range"])
def test_small_changes_of_a_knees_range_are_no_progress(name):
    assert measure_of(name).smallest_change == SMALLEST_KNEE_CHANGE


def test_scatter_needs_ten_strides():
    assert {measure_of(name).least_strides for name in BY_NAME if name.endswith(("_sd", "_cv"))} == {10}
    assert measure_of("walking_speed").least_strides == 0
