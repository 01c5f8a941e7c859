from datetime import timedelta

from services.progress.visits import SAME_VISIT, in_visits, numbers_of_sessions, visit_lengths
from tests.unit.progress.patient import FIRST_DAY


def test_what_begins_within_half_a_day_is_one_visit(make):
    trials = [make.trial("c", 14), make.trial("a", 0), make.trial("b", 0, hours=11.9), make.trial("d", 14, hours=12)]
    visits = in_visits(trials)
    assert [[trial.session for trial in visit.trials] for visit in visits] == [["a", "b"], ["c"], ["d"]]
    assert [visit.number for visit in visits] == [1, 2, 3]
    assert numbers_of_sessions(visits) == {"a": 1, "b": 1, "c": 2, "d": 3}


def test_a_visit_counts_from_its_first_session_and_so_ends():
    steps = [FIRST_DAY + k * (SAME_VISIT / 2) for k in range(5)]
    assert visit_lengths(steps) == [2, 2, 1]
    assert visit_lengths([]) == []
    assert visit_lengths([FIRST_DAY, FIRST_DAY + SAME_VISIT - timedelta(microseconds=1)]) == [2]


def test_sessions_that_began_at_once_have_one_order(make):
    one, two = make.trial("a", 0), make.trial("b", 0)
    assert in_visits([two, one]) == in_visits([one, two])
