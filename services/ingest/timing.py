"""From a time column to seconds on the file's own time base."""

import numpy as np
from numpy.typing import NDArray

from services.ingest.entries import FRAME, TimeEntry
from services.ingest.errors import ClockError, place
from services.ingest.table import Table
from services.ingest.units import scale_to_si

MOST_BACKWARDS_SHARE = 0.01
"""Share of rows with a time not after the latest one above which the time column cannot be right."""

LONGEST_RECORDING_S = 7 * 86400.0
"""s. A span beyond it is a wrong unit of the time column."""


def check_time(time: TimeEntry) -> None:
    """Raises UnknownUnit for a unit that is neither a frame count nor a time."""
    if time.unit != FRAME:
        scale_to_si("time", time.unit)


def row_times_s(table: Table, time: TimeEntry, rate_hz: float) -> NDArray[np.float64]:
    """n, s; NaN where the time column is empty. Integer ns since 1970 keep a precision of 0.3 us."""
    if time.column is None:
        return table.rows / rate_hz + time.offset_s
    column = table.values[:, table.columns.index(time.column)]
    return column * (1 / rate_hz if time.unit == FRAME else scale_to_si("time", time.unit)) + time.offset_s


def advancing_rows(table: Table, time_s: NDArray[np.float64]) -> NDArray[np.bool_]:
    """n; True where the time is known and later than every time before it. NaN times are False.

    Raises ClockError when so many are not that the column cannot be a time, or when it spans weeks.
    """
    known = np.isfinite(time_s)
    latest_before = np.fmax.accumulate(np.concatenate([[-np.inf], time_s[:-1]]))
    advancing = known & (np.nan_to_num(time_s, nan=-np.inf) > latest_before)
    backwards = int(known.sum() - advancing.sum())
    if backwards > max(1, MOST_BACKWARDS_SHARE * len(time_s)):
        raise ClockError(
            f"{place(table.path)}: time goes back or stands still in {backwards} rows; check column and unit of time"
        )
    span = float(np.ptp(time_s[advancing])) if advancing.any() else 0.0
    if span > LONGEST_RECORDING_S:
        raise ClockError(f"{place(table.path)}: the time column spans {span:.3g} s; check its unit")
    return advancing
