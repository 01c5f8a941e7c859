import pytest

from schemas.conditions import SpeedInstruction
from schemas.population import Population
from schemas.vocabulary import Task
from services.definitions.table import BY_NAME
from services.progress.thresholds import BY_KEY, THRESHOLDS, Occasion, in_band, usable

COMFORTABLE = SpeedInstruction.COMFORTABLE


def chosen(measure, task, occasion, speed, population=Population.STROKE_CHRONIC, instruction=COMFORTABLE):
    return in_band(usable(measure, task, occasion, population, instruction), speed)


@pytest.mark.parametrize(
    ("speed", "between", "within"),
    [(0.39, 0.10, 0.05), (0.4, 0.15, 0.11), (0.8, 0.15, 0.11), (0.81, 0.18, 0.21)],
)
def test_bands_of_the_conventions(speed, between, within):
    task, name = Task.TEN_METRE_WALK, "ten_metre_walk_speed"
    assert chosen(name, task, Occasion.BETWEEN_DAYS, speed).value == between
    assert chosen(name, task, Occasion.WITHIN_OCCASION, speed).value == within


def test_a_fast_walk_and_a_time_have_their_own_rows():
    fast = chosen("ten_metre_walk_speed", Task.TEN_METRE_WALK, Occasion.WITHIN_OCCASION, 0.5,
                  instruction=SpeedInstruction.FAST)  # fmt: skip
    assert fast.value == 0.12
    assert chosen("ten_metre_walk_time", Task.TEN_METRE_WALK, Occasion.WITHIN_OCCASION, 0.5).value == 2.83
    none = chosen("ten_metre_walk_speed", Task.TEN_METRE_WALK, Occasion.BETWEEN_DAYS, 0.5,
                  instruction=SpeedInstruction.FAST)  # fmt: skip
    assert none is None


def test_without_a_speed_there_is_no_band():
    assert chosen("walking_speed", Task.WALK, Occasion.BETWEEN_DAYS, None) is None


@pytest.mark.parametrize("measure", ["tug_time", "hip_extension_peak", "stance_fraction", "step_length", "cadence"])
def test_rows_that_a_verdict_may_not_rest_on_are_never_chosen(measure):
    for occasion in Occasion:
        for population in Population:
            for task in Task:
                assert usable(measure, task, occasion, population, COMFORTABLE) == []


def test_what_matters_to_people_is_no_measurement_error():
    assert usable("walking_speed", Task.WALK, Occasion.NOT_STATED, Population.STROKE_SUBACUTE, COMFORTABLE) == []
    assert BY_KEY["tilson_2010_comfortable_speed"].unusable_because


def test_every_row_has_source_people_and_a_known_measure():
    assert len(BY_KEY) == len(THRESHOLDS)
    for row in THRESHOLDS:
        assert row.value > 0
        assert row.source
        assert row.people
        for measure in row.measures:
            if measure in BY_NAME:
                assert BY_NAME[measure].unit == row.unit, row.key
