"""What faults add to the error of a joint: growth against the undisturbed run, and the time until it is gone."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.bench.performance.disturbed import COLUMN, Estimated, Walk

Array = NDArray[np.float64]

RECOVERED_DEG = 1.0
WINDOW_S = 0.5
"""s over which an error is averaged before it counts as recovered."""
GRID_S = 0.02


def rms(values: Array) -> float:
    """Root mean square of what is finite; NaN of nothing."""
    finite = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(finite**2))) if len(finite) else float("nan")


class Errors(NamedTuple):
    """Errors of one joint at the instants (n,) of the disturbed run, deg, free of the undisturbed run's offset."""

    time_s: Array
    disturbed: Array
    clean: Array
    std: Array
    valid: NDArray[np.bool_]

    def within(self, from_s: float, to_s: float) -> "Errors":
        """A part of the time."""
        return self._where((self.time_s >= from_s) & (self.time_s < to_s))

    def where_valid(self) -> "Errors":
        """What is shown to the therapist."""
        return self._where(self.valid)

    def _where(self, chosen: NDArray[np.bool_]) -> "Errors":
        return Errors(
            self.time_s[chosen], self.disturbed[chosen], self.clean[chosen], self.std[chosen], self.valid[chosen]
        )

    @property
    def growth(self) -> float:
        """RMSE that the faults add, deg; NaN where there is no estimate."""
        return rms(self.disturbed) - rms(self.clean)

    @property
    def claimed(self) -> float:
        """Share of the time that the error is within two of the claimed deviations."""
        return float(np.mean(np.abs(self.disturbed) <= 2.0 * self.std)) if len(self.std) else float("nan")


def errors_of(walk: Walk, clean: Estimated, disturbed: Estimated, joint: str) -> Errors:
    """Both runs where the walk is scored. Zero is that of the undisturbed run, so a lost zero counts as error."""
    before = clean.error(walk, joint)
    scored = (clean.time_s >= walk.walking_s[0]) & (clean.time_s < walk.walking_s[1])
    offset = float(np.nanmean(before[scored]))
    column = COLUMN[joint]
    return Errors(
        disturbed.time_s,
        disturbed.error(walk, joint) - offset,
        np.interp(disturbed.time_s, clean.time_s, before) - offset,
        disturbed.std[:, column],
        disturbed.valid[:, column],
    ).within(*walk.walking_s)


def recovery_s(errors: Errors, back_s: float) -> float:
    """Time after `back_s` from which the RMSE of every half second is within 1 deg of the undisturbed run's."""
    late = 0.0
    end_s = float(errors.time_s[-1])
    for start_s in np.arange(back_s, end_s - WINDOW_S, GRID_S):
        if errors.within(start_s, start_s + WINDOW_S).growth > RECOVERED_DEG:
            late = float(start_s) - back_s + GRID_S
    return late
