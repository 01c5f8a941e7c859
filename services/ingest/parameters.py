"""Tunables of the running ingest. How a recording is checked is in checks.py, the walker's dials in synthetic/."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class IngestParameters:
    """All times in s on the monotonic clock unless stated."""

    pump_s: float = 0.005  # between two looks at what is due; half a tick of the usual 100 Hz
    most_per_pump: int = 200  # messages of one session in one look, so that none starves the others
    chunk: int = 200  # messages made at once by a reading thread; 1 s of a 100 Hz hub with its truth
    most_ticks: int = 5  # ticks in one message at most: 50 ms at 100 Hz, the budget's floor for a full ward
    longest_message_s: float = 0.05  # s that one message may span when it has grown; a camera is slower than a hub
    lag_behind_s: float = 0.1  # later than this is behind
    lag_in_time_s: float = 0.03  # earlier than this is in time
    grow_after_s: float = 1.0  # of being behind, before messages grow by one tick
    told_late_s: float = 0.4  # s that a reader is behind when all is well: it writes, and says so ten times a second
    shrink_after_s: float = 60.0  # of being in time, before they shrink by one; longer after a try that failed
    longest_patience_s: float = 900.0  # before messages shrink again, however often it has failed
    most_ahead_s: float = 10.0  # s of session time that an unpaced replay may be ahead of its slowest reader
    silent_after_s: float = 60.0  # without any step forward a reader is no longer waited for
    free_after_s: float = 5.0  # without any reader at all an unpaced replay runs on
    linger_s: float = 60.0  # token and rings stay this long after the end when no service makes a step any more
    farewell_s: float = 2.0  # for the archive to take the last messages when the service is told to stop


PARAMETERS = IngestParameters()
