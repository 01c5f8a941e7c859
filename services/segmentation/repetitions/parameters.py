"""Everything that can be tuned in repetitions: unit, default, where the default comes from."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RepetitionParameters:
    """Chosen on synthetic exercises (seeds below 300); `ambula bench repetitions` scores others."""

    smoothing_s: float = 0.2
    """s over which the angle is averaged before turns are looked for: one period of a tremor of 5 Hz, of which
    nothing is left; of one of 4 or 6 Hz a quarter and a sixth."""

    turn_floor: float = 0.15
    """rad (8.6 deg) that the angle must come back for a turn to be one, in whoever moves little. Above what soft
    tissue makes of a muscle that tightens (5 deg), below the 20 deg of a freshly operated knee (proposal)."""
    turn_share: float = 0.2
    """share of the person's own median range that it must come back; hesitations are smaller (proposal)."""
    memory: int = 7
    """excursions whose median range is the person's own."""
    least_memory: int = 2
    """excursions from which on there is such a median; one alone may be an odd one."""

    still_band: float = 0.04
    """rad (2.3 deg) within which a resting knee stays; a smoothed tremor of 3 deg does."""
    still_s: float = 0.5
    """s within that band after which the knee rests. 0.1 repetitions per second of 60 deg cross it in 0.3 s."""
    floor_margin: float = 0.0
    """rad above a movement's floor, where there is one, up to which it is still at home."""
    one_way: bool = False
    """whether the angle always becomes larger on the way out, so that no resting side has to be found."""
    return_share: float = 0.5
    """share of the way that must be made back before a new movement outward is another repetition; less is a
    hesitation (proposal)."""
    rested_share: float = 0.8
    """the same before coming to rest ends a repetition; a pause further out is a hesitation (proposal)."""
    longest_hold_s: float = 15.0
    """s of rest at the far side after which it is a new resting position, not a hold; 5 to 10 s are prescribed."""

    ends_share: float = 0.4
    """share of the range by which both ends may differ; beyond it one end was not the resting side (proposal)."""
    partial_share: float = 0.5
    """share of the person's own median range below which a repetition is partial, and a movement against the usual
    direction none (proposal)."""
    shortest_s: float = 0.3
    """s; twice as fast as the fastest cycling (1.5 per second)."""
    longest_s: float = 30.0
    """s; three times the slowest exercise (0.1 per second)."""
    longest_gap_s: float = 0.2
    """s without samples that a repetition may contain; one smoothing."""

    jump: float = 0.15
    """rad by which an angle may differ from where its velocity takes it; more is a new zero or axis, which would look
    like a movement as soon as it reaches `turn_floor`."""

    posture_change: float = 0.6
    """rad (34 deg) by which the thigh's inclination may differ between both ends, and below which a thigh stands.
    Sitting down turns it by 60 and more; squats and slides bring it back (proposal)."""
    level_thigh: float = 1.0
    """rad (57 deg) of inclination from which on a thigh is level, as on a chair; standing thighs stay below 30 deg."""
    still_thigh: float = 0.25
    """share of the knee's way that a thigh may turn and still be still; in a heel slide it turns by half of it."""
    seated_s: float = 3.0
    """s of rest on level thighs after which a person who stood has sat down, before there were repetitions; holds of a
    first squat are shorter (proposal)."""

    step_share: float = 0.35
    """share of the knee's range by which the thigh's inclination, half-way, differs between extending and flexing, from
    which on it was a step. Walking makes 0.55 to 0.75; exercises take the same way back, and pedals make 0.22."""
    step_floor: float = 0.15
    """rad that this must be at least; a loosely worn thigh sensor makes less."""

    onset_share: float = 0.1
    """share of a way's largest speed below which it has not begun or is over."""
    onset_reach: float = 0.15
    """share of the range from the resting end within which that is looked for, so that a hesitation is no end."""
    held_share: float = 0.05
    """share of the range within which the knee is at its turn."""
    margin_s: float = 0.5
    """s of angles kept before a movement."""
