"""How the scoreboard of walking tests counts."""

import pytest

from services.bench.walking_tests.sessions import truth_of
from services.bench.walking_tests.six_minutes import true_slope, turns_in_time, unmatched


def test_a_span_is_found_once_and_by_its_middle() -> None:
    true = [(10.0, 12.0), (30.0, 34.0), (60.0, 62.0)]
    assert unmatched(true, true) == (0, 0)
    assert unmatched(true, [(11.5, 12.5), (31.0, 35.0)]) == (1, 0)
    assert unmatched(true, [*true, (10.5, 12.5)]) == (0, 1)
    assert unmatched([], [(1.0, 2.0)]) == (0, 1)


def test_turns_after_the_time_do_not_count() -> None:
    truth = truth_of("synthetic:six_minutes?corridor=8&duration=40&seed=41")
    assert len(turns_in_time(truth)) == truth.lengths
    assert all(sum(span) / 2 <= truth.end_s for span in turns_in_time(truth))


def test_the_true_slope_is_what_the_steps_were_made_to_lose() -> None:
    truth = truth_of("synthetic:six_minutes?corridor=30&duration=60&speed=1.0&decline=0.1&seed=42")
    assert true_slope(truth) == pytest.approx(-0.1, abs=0.005)
