"""What each metric of a six-minute and of a ten-metre walk is: rows of the same table, measured on phases."""

from services.definitions.definition import Basis, Definition

MINUTES = ("first", "second", "third", "fourth", "fifth", "sixth")


def _six(name: str, unit: str, sentence: str, basis: Basis = Basis.TASK) -> Definition:
    return Definition(f"six_minute_walk_{name}", unit, False, sentence, basis=basis)


def _ten(name: str, unit: str, sentence: str, basis: Basis = Basis.TASK) -> Definition:
    return Definition(f"ten_metre_walk_{name}", unit, False, sentence, basis=basis)


SIX_DISTANCE = _six(
    "distance",
    "m",
    "Distance walked within the time of the test, which starts with the first step and runs on in rests: by laps and "
    "by strides, weighted by how sure each is.",
)
SIX_BY_LAPS = _six(
    "distance_by_laps",
    "m",
    "Distance by lengths of the corridor from turn to turn, and what was walked of the last one by steps scaled to it.",
)
SIX_BY_STRIDES = _six("distance_by_strides", "m", "Distance as the sum of the measured steps along the corridor.")
SIX_SPEED = _six("speed", "m/s", "Distance / time by the clock, rests included.")
SIX_MINUTE_SPEEDS: tuple[Definition, ...] = tuple(
    _six(f"speed_{word}_minute", "m/s", f"Distance walked in the {word} minute of the test / 60 s, rests included.")
    for word in MINUTES
)
SIX_SLOPE = _six(
    "speed_slope",
    "m/s/min",
    "By how much the speed of a length from turn to turn changes per minute, least squares over all; negative: the "
    "person gets slower.",
)
SIX_TURNS = _six("turns", "1", "Number of turns at the ends of the corridor.", Basis.COUNT)
SIX_TURN_TIME = _six("turn_time", "s", "Mean time of a turn at an end of the corridor.")
SIX_LAPS = _six("laps", "1", "Number of whole laps: there and back, two turns each.", Basis.COUNT)
SIX_RESTS = _six("rests", "1", "Number of rests: standing for more than 2.5 s while the clock runs.", Basis.COUNT)
SIX_REST_TIME = _six("rest_time", "s", "Time of all rests together.")
SIX_TIME = _six("time", "s", "Time from the first step to the end of the test, or to where it was last seen.")

SIX_MINUTE_WALK: tuple[Definition, ...] = (
    SIX_DISTANCE,
    SIX_BY_LAPS,
    SIX_BY_STRIDES,
    SIX_SPEED,
    *SIX_MINUTE_SPEEDS,
    SIX_SLOPE,
    SIX_TURNS,
    SIX_TURN_TIME,
    SIX_LAPS,
    SIX_RESTS,
    SIX_REST_TIME,
    SIX_TIME,
)
"""All metrics of a walk for time, in the order of every message of a session whose task it is."""

TEN_SPEED = _ten("speed", "m/s", "Length of the timed zone / time in it, mean over the trials.")
TEN_TIME = _ten(
    "time", "s", "Time from the foremost foot's crossing of the line where the timed zone begins to that of its end."
)
TEN_STRIDES = _ten("strides", "1", "Number of strides in the timed zone: half of the steps.")
TEN_CHANGE = _ten(
    "speed_difference",
    "m/s",
    "Mean speed over the second half of the timed zone minus that over the first; negative: the person slows down.",
)
TEN_STEADY = _ten(
    "steady_trials",
    "1",
    "Number of trials at a steady speed: both halves of the timed zone differ by at most a tenth of it.",
    Basis.COUNT,
)
TEN_TRIALS = _ten("trials", "1", "Number of trials whose timed zone was walked to its end.", Basis.COUNT)
TEN_ABORTED = _ten(
    "trials_aborted", "1", "Number of trials that were given up or not seen to the end of the timed zone.", Basis.COUNT
)

TEN_METRE_WALK: tuple[Definition, ...] = (
    TEN_SPEED,
    TEN_TIME,
    TEN_STRIDES,
    TEN_CHANGE,
    TEN_STEADY,
    TEN_TRIALS,
    TEN_ABORTED,
)
"""All metrics of a ten-metre walk, in the order of every message of a session whose task it is."""

WALKING_TESTS: tuple[Definition, ...] = (*SIX_MINUTE_WALK, *TEN_METRE_WALK)
"""Both."""
