"""From scores of many motions to rows of the scoreboard."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from services.bench.rhythm.scores import RhythmScore
from services.bench.scoreboard import Row, at_least, at_most, informative

Figure = Callable[[list[RhythmScore]], float]


class Pair(NamedTuple):
    """Scores of both estimators on one motion."""

    trusted: RhythmScore
    literal: RhythmScore
    rms: float
    """rad/s, of the noise-free velocity."""


class Wanted(NamedTuple):
    """One figure and its limit; without a limit it only informs."""

    name: str
    unit: str
    figure: Figure
    limit: float | None = None
    is_floor: bool = False
    """Whether the limit is the least allowed."""

    def row(self, case: str, pairs: list[Pair]) -> Row:
        """The figure of the trusted rhythm; the published oscillator's as baseline, none where it is infinite."""
        name = f"{case}: {self.name}"
        value = self.figure([pair.trusted for pair in pairs])
        literal = self.figure([pair.literal for pair in pairs])
        baseline = literal if np.isfinite(literal) else None
        if not np.isfinite(value):
            return Row(name, None, self.unit, "never reached", False if self.limit is not None else None, baseline)
        if self.limit is None:
            return informative(name, value, self.unit, baseline)
        return (at_least if self.is_floor else at_most)(name, value, self.unit, self.limit, baseline)


def right_percent(scores: list[RhythmScore]) -> float:
    """Share of motions with the right frequency."""
    return 100.0 * float(np.mean([score.is_right for score in scores]))


def right_time_percent(scores: list[RhythmScore]) -> float:
    """Share of time with the right frequency."""
    return 100.0 * float(np.mean([score.right_share for score in scores]))


def wrong_percent(scores: list[RhythmScore]) -> float:
    """Share of the time declared locked that is more than 5 % off."""
    return 100.0 * sum(score.wrong_s for score in scores) / max(sum(score.locked_s for score in scores), 1e-9)


def cycles_to_right(scores: list[RhythmScore], share: float) -> float:
    """Quantile of the cycles until the frequency is right."""
    return _quantile([score.cycles_to_right for score in scores], share)


def recovery_cycles(scores: list[RhythmScore], share: float) -> float:
    """Quantile of the cycles until recovered after an event."""
    return _quantile([score.recovery_cycles for score in scores], share)


def phase_error_deg(scores: list[RhythmScore]) -> float:
    """Median over the motions, degrees."""
    return float(np.degrees(_quantile([score.phase_rms for score in scores], 0.5)))


def reference_shift_deg(scores: list[RhythmScore]) -> float:
    """90th percentile over the motions, degrees."""
    return float(np.degrees(_quantile([score.reference_shift for score in scores], 0.9)))


def standing_percent(scores: list[RhythmScore]) -> float:
    """Mean share of standing time with the lock flag up."""
    return 100.0 * float(np.mean([score.locked_while_standing for score in scores]))


def harmonic_percent(scores: list[RhythmScore]) -> float:
    """Share of motions that end at twice or half the frequency."""
    ratio = np.array([score.final_ratio for score in scores])
    return 100.0 * float(np.mean((np.abs(ratio / 2.0 - 1.0) < 0.05) | (np.abs(ratio / 0.5 - 1.0) < 0.05)))


def _quantile(values: Sequence[float], share: float) -> float:
    """Smallest value that at least `share` of the values do not exceed; infinite where too many never are."""
    return float(np.quantile(values, share, method="inverted_cdf"))


_MEDIAN_TO_RIGHT, _P90_TO_RIGHT = partial(cycles_to_right, share=0.5), partial(cycles_to_right, share=0.9)
_P90_RECOVERY = partial(recovery_cycles, share=0.9)

STRONG_RANDOM = (
    Wanted("right", "%", right_percent, 99.0, is_floor=True),
    Wanted("wrong while locked", "%", wrong_percent, 0.5),
    Wanted("until right, median", "cycles", _MEDIAN_TO_RIGHT, 2.0),
    Wanted("until right, p90", "cycles", _P90_TO_RIGHT, 2.5),
    Wanted("phase error", "deg", phase_error_deg),
)
ALL_RANDOM = (
    Wanted("right", "%", right_percent, 75.0, is_floor=True),
    Wanted("wrong while locked", "%", wrong_percent, 1.5),
)
WEAK_RANDOM = (Wanted("right", "%", right_percent), Wanted("wrong while locked", "%", wrong_percent))
PLAIN_GAIT = (
    Wanted("right", "%", right_percent, 95.0, is_floor=True),
    Wanted("ends on 2x or 0.5x", "%", harmonic_percent, 0.0),
    Wanted("wrong while locked", "%", wrong_percent),
    Wanted("phase error", "deg", phase_error_deg, 5.0),
    Wanted("until right and locked, median", "cycles", _MEDIAN_TO_RIGHT, 3.5),
    Wanted("until right and locked, p90", "cycles", _P90_TO_RIGHT, 4.5),
)
STOPPED_GAIT = (
    Wanted("right before", "%", right_percent),
    Wanted("recovery, p90", "cycles", _P90_RECOVERY, 3.0),
    Wanted("locked while standing", "%", standing_percent, 3.0),
    Wanted("shift of phase reference, p90", "deg", reference_shift_deg),
)
PACED_GAIT = (
    Wanted("right before", "%", right_percent),
    Wanted("wrong while locked", "%", wrong_percent),
    Wanted("recovery, p90", "cycles", _P90_RECOVERY),
)
PACED_GAIT_OF_TWO_KNEES = (*PACED_GAIT[:2], Wanted("recovery, p90", "cycles", _P90_RECOVERY, 6.0))
METRONOME = (
    Wanted("time within 2 %", "%", right_time_percent),
    Wanted("wrong while locked", "%", wrong_percent),
    Wanted("until right and locked, median", "cycles", _MEDIAN_TO_RIGHT),
)
