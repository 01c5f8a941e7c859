"""Everything that can be tuned in segmentation: unit, default, where the default comes from."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SegmentationParameters:
    """Contacts are times at which the ankle turns round relative to the pelvis, plus a constant (Zeni 2008).

    The constants rest on two force plates (46 contacts and 46 toe-offs of two healthy adults, slow to fast and with
    an altered gait: 43 and 42 ms, standard deviation 12 and 16 ms) and on the reviewed events of two other people
    (16 contacts and 15 toe-offs: 35 and 26 ms, standard deviation 11 and 8 ms). The deviations below are wider,
    because the joint angles of a session are estimates.
    """

    contact_after_foremost_s: float = 0.04
    """s from the foremost ankle to initial contact; between the two sources above."""
    contact_after_swing_s: float = 0.035
    """s from the end of the shank's forward rotation to contact, used when the ankle does not turn round (the step
    that comes to rest beside the other foot); force plates."""
    toe_off_after_hindmost_s: float = 0.037
    """s from the hindmost ankle to toe-off; between the two sources above."""
    toe_off_rules_apart_s: float = 0.25
    """s between the toe-offs by the ankle and by the rotation's start, beyond which the latter is not believed; within
    it their mean is taken: on the plates 1 ms late with a deviation of 9 ms, where the rules alone have 15 and 14."""
    contact_std_s: float = 0.02
    """s, one standard deviation of a contact: 12 ms of the rule against plates and 9 ms of the estimate against optical
    ankles make 15; between two manners of walking the constant itself moves by as much."""
    resting_contact_std_s: float = 0.05
    """s, the same for a contact placed by the end of the rotation; 19 ms on the plates, but in steps that go on."""
    toe_off_std_s: float = 0.03
    """s, one standard deviation of a toe-off: likewise 16 and 23 ms make 28."""

    shank_contact_after_swing_s: float = 0.045
    """s from the end of the shank's forward rotation to contact, where the shank alone is known; force plates, the
    first of the two adults."""
    shank_toe_off_before_swing_s: float = 0.07
    """s from toe-off to the start of that rotation; likewise."""
    shank_contact_std_s: float = 0.02
    """s, one standard deviation of a contact timed by the shank alone; force plates."""
    shank_toe_off_std_s: float = 0.015
    """s, the same for a toe-off."""

    foot_contact_after_swing_s: float = 0.05
    """s from the end of a foot's forward rotation to contact, where the foot alone is known: reviewed movements of one
    adult (0.045), and the stroke survivor's shanks (0.055)."""
    foot_toe_off_before_swing_s: float = 0.04
    """s from toe-off to the start of that rotation; likewise (0.03 and 0.05)."""
    foot_contact_std_s: float = 0.03
    """s, one standard deviation of a contact timed by the foot alone: 34 ms in two adults not chosen on."""
    foot_toe_off_std_s: float = 0.025
    """s, the same for a toe-off; 21 ms in them."""

    back_smoothing_s: float = 0.2
    """s to each side over which the acceleration of the lower back is smoothed; keeps the step, not its impacts."""
    back_climb_floor: float = 0.6
    """m/s^2 by which the smoothed upward acceleration must rise and fall in a step; sitting down makes more, but not
    several times in a row."""
    back_climb_fraction: float = 0.25
    """share of the person's own median climb that a climb must reach."""
    back_climb_memory: int = 7
    """climbs whose median is the person's own."""
    back_rise_s: float = 0.25
    """s before a top in which its steepest rise is looked for."""
    back_contact_after_rise_s: float = 0.065
    """s from the steepest rise to contact: mean of three people (0.10, 0.06 and 0.04)."""
    back_contact_std_s: float = 0.05
    """s, one standard deviation of a contact: 25 ms within those people, 30 between them, 52 in two others."""
    back_toe_off_after_top_s: float = 0.08
    """s from the top of the climb to the toe-off of the other foot: the same three people (0.09, 0.07 and 0.08)."""
    back_toe_off_std_s: float = 0.04
    """s, one standard deviation of a toe-off: 15 to 30 ms within those people."""
    back_side_edge_s: float = 0.05
    """s around a contact that tell nothing of its side."""
    back_side_before_s: float = 0.3
    """s before a contact in which the body stands on the other foot."""
    back_side_after_s: float = 0.2
    """s after a contact in which the body comes to stand on this foot."""
    back_memory_s: float = 1.0
    """s of smoothed acceleration kept."""
    back_shortest_step_s: float = 0.25
    """s; two contacts closer than this are one."""
    back_longest_step_s: float = 1.5
    """s; contacts further apart are not of one run."""
    back_uneven: float = 1.8
    """ratio of a step to the median of the run, beyond which it begins another one."""
    back_step_memory: int = 5
    """steps whose median is the run's."""
    back_fewest_contacts: int = 3
    """contacts in an even run from which on it is walking."""

    swing_angle_floor: float = 0.15
    """rad of forward shank rotation that no swing stays below; smaller movements are shuffles (proposal)."""
    swing_angle_fraction: float = 0.2
    """share of the person's own median swing rotation that a swing must reach; the inner foot of a turn made 0.27."""
    swing_rate_floor: float = 0.8
    """rad/s that the shank must reach in swing; sitting down stays below it, slow patients reach 1.5 (proposal)."""
    swing_memory: int = 7
    """swings whose median is the person's own."""
    swing_end_rate: float = 0.1
    """rad/s backward at which the forward rotation has ended; above the noise of a standing leg."""
    most_swing_s: float = 2.0
    """s after which a forward rotation is no swing."""
    hindmost_search_s: float = 0.5
    """s before the rotation starts in which the ankle is hindmost."""
    turn_round_share: float = 0.03
    """share of the ankle's excursion that it must come back before the foremost point is believed."""
    turn_round_floor_m: float = 0.005
    """m, smallest such return."""
    landing_timeout_s: float = 0.3
    """s after the end of the rotation: the longest wait for the ankle to turn round."""

    longest_gap_s: float = 0.1
    """s without samples that a stride may contain."""
    shortest_stride_s: float = 0.4
    """s; a cadence of 300 per minute."""
    longest_stride_s: float = 4.0
    """s; a cadence of 30 per minute, slower than the slowest of the published cohorts (36 per minute). Two contacts
    further apart are no stride."""
    pause_s: float = 0.8
    """s of stillness of both shanks that end a bout of walking."""
    pause_rate: float = 0.1
    """rad/s below which a shank is still."""
    release_delay_s: float = 0.35
    """s a stride waits for the events of the other foot that still belong to it."""
    least_phase: float = 0.6
    """turns of the rhythm in a stride, below which the rhythm saw less than one."""
    most_phase: float = 1.5
    """turns of the rhythm above which it saw more than one."""
    least_step_share: float = 0.15
    """share of the stride by which the two feet's contacts are apart at least."""
    turn_limit: float = 0.26
    """rad (15 deg) of pelvis rotation from contact to contact above which a stride is turning (proposal)."""

    foot_roll_share: float = 0.08
    """radius on which the foot rolls in stance / leg length: how far the ankle travels per radian of shank
    rotation between its own contact and the other foot's. Optical means of three people: 0.10, 0.06, 0.08."""
    history_margin_s: float = 0.5
    """s of joint angles kept before the last contact; a contact is recognised at most 0.35 s late."""
    back_history_margin_s: float = 4.0
    """s, the same where the lower back tells contacts: the first of a run waits for two more."""
