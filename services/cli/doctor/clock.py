"""The clocks: samples are ordered by the monotonic one, sessions of several machines are compared by the wall's."""

import ctypes
import sys
import time
from collections.abc import Callable
from datetime import UTC, datetime

from services.cli.doctor.findings import Finding

BUILT = datetime(2026, 1, 1, tzinfo=UTC)
"""No clock that is right shows an earlier day."""
LOOK_S = 0.25
MOST_APART_S = 0.02
UNSYNCHRONISED = 5
"""TIME_ERROR, what adjtimex answers while nothing steers the clock."""
TIMEX_BYTES = 512


def examine_clock(
    wall: Callable[[], float] = time.time,
    monotonic: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
    steered: Callable[[], bool | None] | None = None,
) -> Finding:
    """Whether the wall clock is plausible, goes like the monotonic one, and is steered (NTP)."""
    began = wall(), monotonic()
    if began[0] < BUILT.timestamp():
        shown = datetime.fromtimestamp(began[0], UTC).date()
        return Finding("Clock", False, f"shows {shown}, which cannot be; set it, e.g. with `timedatectl set-time`")
    sleep(LOOK_S)
    apart_s = (wall() - began[0]) - (monotonic() - began[1])
    if abs(apart_s) > MOST_APART_S:
        return Finding("Clock", False, f"jumped by {apart_s:+.2f} s while looked at; let one time service steer it")
    told = (steered or is_steered)()
    if told is None:
        return Finding("Clock", None, "goes evenly; whether a time service steers it cannot be told here")
    says = "goes evenly, steered by a time service"
    loose = "goes evenly, but no time service steers it: switch NTP on, or visits get wrong times"
    return Finding("Clock", True if told else None, says if told else loose)


def is_steered() -> bool | None:
    """Whether the kernel believes its clock to be synchronised; None where it cannot be asked."""
    if not sys.platform.startswith("linux"):
        return None
    try:
        adjtimex = ctypes.CDLL(None).adjtimex
    except (OSError, AttributeError):
        return None
    # All zero asks and changes nothing; the structure is smaller than this on every Linux.
    state = int(adjtimex(ctypes.create_string_buffer(TIMEX_BYTES)))
    return None if state < 0 else state != UNSYNCHRONISED
