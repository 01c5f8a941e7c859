"""Lines crossed by a foot in its swing."""

import pytest

from services.segmentation.walking_tests.crossings import Ruler, crossing
from services.segmentation.walking_tests.step_trail import Mark

STEP_M, STEP_NS = 0.6, 500_000_000
MARKS = [
    Mark((k + 1) * STEP_NS, 0.02, (k + 1) * STEP_NS - 400_000_000, (k + 1) * STEP_M, 0.0, k == 0) for k in range(10)
]


PLAIN = Ruler(0.0, 1.0)


def at_s(line_m: float, ruler: Ruler = PLAIN, start_ns: int = 0) -> float:
    found = crossing(MARKS, ruler, line_m, start_ns)
    assert found is not None
    return found.at_ns * 1e-9


def test_the_foot_is_half_way_when_half_of_its_swing_is_over() -> None:
    # The sixth step lands at 3.6 m and left 2.4 m.
    assert at_s(3.0 + 1e-9) == pytest.approx(MARKS[5].lifted_ns * 1e-9 + 0.2, abs=1e-6)


def test_lines_farther_away_are_crossed_later() -> None:
    times = [at_s(0.3 + 0.05 * k) for k in range(100)]
    assert times == sorted(times)
    assert at_s(3.59) == pytest.approx(3.0, abs=0.1)


def test_a_line_that_no_foot_has_passed_is_not_crossed() -> None:
    assert crossing(MARKS, Ruler(0.0, 1.0), 6.01, 0) is None


def test_a_scale_moves_the_lines_and_a_later_start_the_zero() -> None:
    assert at_s(3.3, Ruler(0.0, 1.1)) == pytest.approx(at_s(3.0))
    assert at_s(1.2, Ruler(2.4, 1.0), MARKS[3].at_ns) == pytest.approx(at_s(3.6), abs=0.1)
