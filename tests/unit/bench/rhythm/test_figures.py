"""Rows of the rhythm scoreboard: quantiles with motions that never lock, limits from either side."""

import numpy as np
import pytest

from services.bench.rhythm.figures import Pair, Wanted, cycles_to_right, harmonic_percent, right_percent, wrong_percent
from services.bench.rhythm.scores import RhythmScore


def score(right: bool = True, cycles: float = 2.0, wrong_s: float = 0.0, ratio: float = 1.0) -> RhythmScore:
    return RhythmScore(right, 1.0, wrong_s, 50.0, cycles, 0.05, ratio)


def test_quantile_with_motions_that_never_lock():
    scores = [score(cycles=2.0)] * 9 + [score(cycles=np.inf)]
    assert cycles_to_right(scores, 0.9) == 2.0
    assert cycles_to_right(scores, 0.95) == np.inf


def test_shares_are_of_motions_and_of_locked_time():
    scores = [score(), score(right=False, wrong_s=10.0, ratio=2.0)]
    assert right_percent(scores) == 50.0
    assert wrong_percent(scores) == pytest.approx(10.0)
    assert harmonic_percent(scores) == 50.0


def test_rows_keep_what_is_infinite_out_of_the_figures():
    never, well = score(right=False, cycles=np.inf), score()
    wanted = Wanted("until right, p90", "cycles", lambda scores: cycles_to_right(scores, 0.9), 2.5)
    good, bad = wanted.row("case", [Pair(well, never, 1.0)]), wanted.row("case", [Pair(never, well, 1.0)])
    assert (good.value, good.met, good.baseline) == (2.0, True, None)
    assert (bad.value, bad.met, bad.baseline) == (None, False, 2.0)


def test_floor_and_plain_rows():
    pairs = [Pair(score(right=False), score(), 1.0)]
    assert Wanted("right", "%", right_percent, 95.0, is_floor=True).row("case", pairs).met is False
    assert Wanted("right", "%", right_percent).row("case", pairs).met is None
