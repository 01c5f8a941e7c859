import pytest

from schemas.vocabulary import Side
from services.progress.curves import curve_visits
from services.progress.visits import in_visits

FOUR = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")


def trial(make, session, day, left, right, joints=FOUR):
    curves = [
        make.curve(f"{joint}_{side}", level) for joint in joints for side, level in (("left", left), ("right", right))
    ]
    return make.trial(session, day, metrics=make.results(curves=[make.curve("pelvis_tilt", 0.1), *curves]))


def alike(*trials):
    return [(visit, visit.trials) for visit in in_visits(trials)]


def test_each_leg_against_its_baseline_and_the_other(make):
    found = curve_visits(alike(trial(make, "a", 0, 0.2, 0.6), trial(make, "b", 14, 0.4, 0.6)))
    assert [(each.visit, each.side) for each in found] == [(n, side) for n in (1, 2) for side in Side]
    left = found[2]
    assert left.from_baseline.by_variable["knee_flexion"] == pytest.approx(0.2)
    # Pelvis 0, three joints 0.2 each: sqrt(3 / 4) 0.2.
    assert left.from_baseline.distance == pytest.approx(0.75**0.5 * 0.2)
    assert left.from_other_leg.by_variable == pytest.approx(dict.fromkeys(FOUR, 0.2))
    assert (left.from_other_leg.distance, left.from_other_leg.missing) == (None, ("pelvis_tilt",))
    assert found[3].from_baseline.distance == pytest.approx(0.0)
    assert found[0].from_baseline is None


def test_fewer_than_four_variables_are_no_distance(make):
    visits = alike(*(trial(make, name, day, 0.2, 0.6, FOUR[:2]) for name, day in (("a", 0), ("b", 14))))
    since = curve_visits(visits)[2].from_baseline
    assert since.distance is None
    assert since.missing == ("ankle_dorsiflexion",)
    assert set(since.by_variable) == {"pelvis_tilt", "hip_flexion", "knee_flexion"}


def test_trials_of_a_visit_count_by_their_strides(make):
    found = curve_visits(alike(trial(make, "a", 0, 0.2, 0.6), trial(make, "b", 14, 0.2, 0.6),
                               trial(make, "c", 14, 0.4, 0.6)))  # fmt: skip
    later = [each for each in found if each.visit == 2 and each.side is Side.LEFT]
    assert later[0].from_baseline.by_variable["hip_flexion"] == pytest.approx(0.1)
    assert later[0].sessions == ["b", "c"]
