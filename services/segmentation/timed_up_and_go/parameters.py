"""Everything that can be tuned in finding the phases of a timed up and go: unit, default, source."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TimedUpAndGoParameters:
    """Chosen on the tuning seeds of `ambula bench tug` unless a source is named; the README has the definitions."""

    instant_s: float = 0.04
    """s between the instants that are looked at; movements of the whole body are slower than 5 Hz."""
    memory_s: float = 25.0
    """s of instants kept: longer than the slowest turn or rise."""
    longest_gap_s: float = 3.0
    """s without samples, or without any sight of the posture, after which an open attempt is given up."""
    noted_gap_s: float = 0.1
    """s without samples that make a boundary beside them less sure."""

    seated_thigh: float = 0.87
    """rad, forward inclination of the thighs beyond which a person sits: 50 degrees; steps stay below it."""
    upright_thigh: float = 0.5
    """rad, below which a person who sat has risen: 29 degrees."""
    seated_for_s: float = 0.3
    """s that the thighs stay down before somebody sits: no single step up lasts as long."""
    begun_share: float = 0.07
    """share of a movement's peak rate at which it begins (5 to 10 % in the literature of kinematics); restlessness on
    the chair reaches the lower ones."""
    over_share: float = 0.05
    """share at which it is over."""
    least_rate: float = 0.1
    """rad/s, below which nothing is a movement."""
    lean_before: float = 1.4
    """the trunk is looked at for so many durations of the thighs' movement before it."""
    lean_rate: float = 0.25
    """rad/s, least peak at which the trunk's lean is part of rising."""
    lead: float = 0.55
    """durations of the thighs' movement by which the trunk begins before them, where no sensor sees the trunk. It moves
    alone until the seat is left (Schenkman 1990); that this is about a third of rising is assumed."""
    lead_std: float = 0.2
    """durations, spread of that from person to person."""
    rise_std_s: float = 0.06
    """s, of a boundary that is the begin or end of a movement seen by itself."""

    lift: float = 0.13
    """m, by which the pelvis must rise or sink, where only the pelvis is seen: a third of what an ordinary chair takes,
    since the slow parts of it are lost."""
    lift_speed: float = 0.1
    """m/s, vertical, at which the pelvis may be on its way up or down; walking reaches twice that, but not for long."""
    lift_peak: float = 0.2
    """m/s, vertical speed that that rising and sitting down reach, and the drift of the speed does not."""
    speed_memory_s: float = 6.0
    """s after which the vertical speed forgets: an accelerometer's error grows no further."""
    stepping_memory_s: float = 2.0
    """s, the same while the person steps."""
    stepping_s: float = 1.5
    """s after a step of the pelvis for which the person still steps."""
    pelvis_over_share: float = 0.1
    """share of the largest vertical speed at which rising and sitting are over."""
    still_acceleration: float = 0.3
    """m/s^2, upward, below which the pelvis may be at rest."""
    still_turning: float = 0.3
    """rad/s, below which it may be."""
    bias_memory_s: float = 1.0
    """s of rest in which the accelerometer's error is followed."""
    still_for_s: float = 0.4
    """s of both after which the vertical speed is zero."""
    pelvis_std_s: float = 0.1
    """s, of a boundary that the vertical speed of the pelvis tells."""

    swing_angle: float = 0.22
    """rad, that a shank turns forward in a step; a shuffle is less."""
    swing_rate: float = 0.8
    """rad/s, that it reaches."""
    swings: int = 2
    """steps of seen legs that make walking."""
    bounce: float = 0.3
    """m/s^2, that the pelvis's upward acceleration falls below and rises beyond with each step."""
    bounce_smoothing_s: float = 0.06
    """s, over which it is smoothed for that."""
    bounces: int = 3
    """steps of the pelvis that make walking: rising and sitting down shake it once each."""
    longest_stand_s: float = 15.0
    """s upright without walking after which rising was no begin of a test."""
    longest_attempt_s: float = 300.0
    """s, a test that lasts longer was given up; clinics stop counting earlier."""

    plateau_s: float = 1.2
    """s, about a stride, within which the heading of straight walking stays in a band."""
    plateau_band: float = 0.35
    """rad, width of that band: 20 degrees; the pelvis turns to and fro by half of it with each stride."""
    turn_begins: float = 1.75
    """rad, from the straight heading: 100 degrees, which no corner and no veering is, make the turn at the marker."""
    turn_to_sit_begins: float = 1.2
    """rad, about 70 degrees that make the turn before the chair."""
    turned: float = 1.75
    """rad, after which straight walking ends the turn."""
    least_back_s: float = 0.5
    """s from the end of the turn to sitting down; whoever sits sooner did not come back."""
    near: float = 0.21
    """rad, 12 degrees: the straight heading is left for good."""
    far: float = 0.52
    """rad, 30 degrees: with the time of both the begin is extrapolated."""
    turn_onset: float = 1.45
    """of the time from `near` to `far` by which a turn begins before `near`."""
    turn_std_share: float = 0.6
    """of that time: deviation of a turn's boundary, since bodies turn in steps."""
    turn_std_s: float = 0.04
    """s, added to it."""
    turn_rate_over_s: float = 0.4
    """s over which the rate of turning is taken."""
