"""Everything that can be tuned in finding the phases of walking tests: unit, default, source."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class WalkingTestParameters:
    """Chosen on the tuning seeds of `ambula bench walking_tests` unless a source is named; the README has the
    definitions."""

    instant_s: float = 0.04
    """s between the instants that are looked at; heading and standing change more slowly."""
    memory_s: float = 25.0
    """s of instants kept: longer than the slowest turn."""
    steps_memory_s: float = 200.0
    """s of steps kept: longer than the slowest walk of a walkway."""
    turn_begins: float = 1.75
    """rad, from the straight heading: 100 degrees make a turn at the end of a corridor, as in a timed up and go."""

    rest_s: float = 2.5
    """s without a step that are standing; the slowest of the published cohorts (36 steps/min) takes 1.7 s a step."""
    back_late_s: float = 2.5
    """s by which the lower back tells contacts late after a break: it waits for three even steps (see ../gait/)."""
    recognised_s: float = 3.0
    """s after the end of a test's time for which turns and stops before it may still be recognised."""
    stopped_s: float = 1.0
    """s without a step at the end of a session after which the person has stopped."""
    begin_steps: int = 3
    """contacts in a row that make walking; shifting the feet makes fewer."""
    swing_s: float = 0.4
    """s before a contact at which its foot left the ground, where no toe-off was seen."""
    start_std_s: float = 0.2
    """s, deviation of a walk's first toe-off: small lifts before it are no steps."""
    stop_std_s: float = 0.1
    """s, deviation of a stop: the last foot is put down beside the other one."""
    settled_s: float = 1.0
    """s after a contact for which the stride that it ends is waited for: it comes 0.35 to 0.65 s later."""

    length_std_share: float = 0.04
    """share: what all step lengths of a person have in common as an error ("a few per cent", ../gait/README.md)."""
    unmeasured_std_share: float = 0.3
    """share of a step that was walked but not measured: its length is the person's own mean speed x time."""
    turning_step: float = 0.2
    """rad, that the heading changes within a step which is then one of a turn: its length is told by the feet at
    contact, not by the stride, whose mean direction says little."""
    first_step_m: float = 0.3
    """m, a first step of which nothing is known: half of an ordinary one."""
    feet_memory_s: float = 4.0
    """s for which the feet's places are remembered: longer than a first step and a swing."""
    stood_before_s: float = 1.5
    """s before a foot is lifted for the first time at which the person stood."""
    least_missed_m: float = 0.08
    """m by which the other foot must have gone ahead meanwhile; swaying moves it less."""
    first_step_s: float = 0.6
    """s that such a first step began before the foot that is seen was lifted: a swing and both feet on the ground."""
    own_steps: int = 10
    """steps over which a person's own speed is remembered."""
    swing_share: float = 0.8
    """share of a step's time that its foot is in the air at most, where no toe-off was seen."""
    lost_s: float = 0.5
    """s without samples since the step before, after which a step is taken for as many as the own speed makes."""

    told_from_m: float = 1.0
    """m walked from which on a length of a walkway is told; turning on the spot goes less far."""
    default_zone_m: tuple[float, float] = (2.0, 8.0)
    """m from the start, where nobody said what is timed: the middle 6 m of 10 (rehabmeasures form)."""
    most_scaling: float = 0.15
    """share by which steps and a declared walkway may differ; beyond it the person did not walk that walkway."""
    line_std_m: float = 0.08
    """m, of a line's place between the ends of a declared walkway, in one trial."""
    turned_line_std_m: float = 0.15
    """m, the same of a length that begins in a turn, whose place is seen less well than where somebody stood."""
    unsure_line_std_m: float = 0.1
    """m, added where nothing is declared: nobody stands with the toes at the line to the centimetre."""
    crossing_std_s: float = 0.03
    """s, of the foot's way through a swing about the one that is assumed."""
    reached_m: float = 0.1
    """m before the end of the timed zone at which somebody who stops there has reached it."""
