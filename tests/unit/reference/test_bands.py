import pytest

from schemas.population import Sex
from services.reference.bands import Extent, NoBand, Person, Position, band, position
from services.reference.folders import read_set, read_shelf
from tests.unit.reference.folder import write_set


@pytest.fixture(scope="module")
def sets(tmp_path_factory):
    return [read_set(write_set(tmp_path_factory.mktemp("sets")), own=True)]


def of(sets, measure="walking_speed", unit="m/s", age=30.0, sex=Sex.FEMALE, speed=1.2, datum="quiet standing"):
    return band(sets, measure, unit, Person(age, sex, speed), datum)


def test_a_band_says_whose_it_is(sets):
    found = of(sets)
    assert (found.mean, found.n, found.sex, found.extent) == (1.30, 12, Sex.FEMALE, Extent.NORMAL)
    assert (found.low, found.high) == pytest.approx((1.30 - 1.645 * 0.15, 1.30 + 1.645 * 0.15), abs=1e-3)
    assert (found.citation, found.set_version, found.licence) == ("us, 2026", "3", "ours")


def test_published_percentiles_are_taken_as_they_are(sets):
    found = of(sets, sex=Sex.MALE)
    assert (found.low, found.high, found.extent) == (1.10, 1.65, Extent.PERCENTILES)


@pytest.mark.parametrize(("speed", "mean"), [(0.8, 0.50), (1.2, 0.62), (1.6, 0.74)])
def test_a_line_over_speed_gives_the_mean_at_the_persons_speed(sets, speed, mean):
    found = of(sets, "step_length", "m", sex=None, speed=speed)
    assert found.mean == pytest.approx(mean)
    assert found.high - found.mean == pytest.approx(1.644854 * 0.03)
    assert found.speed_matched


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"age": 41.0}, NoBand.AGE_OUTSIDE),
        ({"age": None}, NoBand.AGE_UNKNOWN),
        ({"sex": None}, NoBand.SEX_UNKNOWN),
        ({"measure": "step_length", "unit": "m", "speed": 0.7}, NoBand.SPEED_OUTSIDE),
        ({"measure": "step_length", "unit": "m", "speed": None}, NoBand.SPEED_UNKNOWN),
        ({"measure": "cadence"}, NoBand.NOT_IN_ANY_SET),
        ({"measure": "knee_flexion_range", "unit": "rad", "datum": None}, NoBand.DATUM_DIFFERS),
        ({"measure": "knee_flexion_range", "unit": "rad", "datum": "segments vertical"}, NoBand.DATUM_DIFFERS),
        ({"unit": "steps/min"}, NoBand.UNIT_DIFFERS),
    ],
)
def test_nobody_gets_a_band_of_other_people(sets, changes, why):
    assert of(sets, **changes) is why


def test_angles_of_our_datum_have_one(sets):
    assert of(sets, "knee_flexion_range", "rad").mean == 1.0


def test_what_is_shipped_draws_what_it_knows_and_no_more(sets):
    shipped = read_shelf([]).sets
    assert of(shipped, age=45.0, sex=Sex.MALE).set_name == "mobbs_2025"
    assert of(shipped, age=85.0, sex=Sex.FEMALE) is NoBand.MEAN_ONLY
    assert of(shipped, age=70.0, sex=Sex.MALE) is NoBand.AGE_OUTSIDE
    young = of(shipped, "step_length", "m", age=25.0, sex=None, speed=1.25)
    assert (young.mean, young.sd, young.n) == (0.637, 0.032, 22)
    assert of(shipped, "cadence", "steps/min", age=64.0, speed=0.6) is NoBand.SPEED_OUTSIDE
    # Limits of plausibility span every speed: as a band they would call nearly everything within.
    assert of([each for each in shipped if each.manifest.name == "mobgap_limits"]) is NoBand.NOT_IN_ANY_SET
    assert of([*sets, *shipped], age=35.0, sex=Sex.MALE).set_name == "clinic"


def test_a_value_lies_below_within_or_above(sets):
    found = of(sets, sex=Sex.MALE)
    told = [position(value, found) for value in (1.0, 1.10, 1.4, 1.65, 1.7)]
    assert told == [Position.BELOW, Position.WITHIN, Position.WITHIN, Position.WITHIN, Position.ABOVE]
