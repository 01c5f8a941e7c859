"""Everything that can be tuned in tasks of the whole body: unit, default, where the default comes from."""

from dataclasses import dataclass, replace

from schemas.vocabulary import Task
from services.segmentation.repetitions.parameters import RepetitionParameters


@dataclass(frozen=True, slots=True)
class ExerciseParameters:
    """Chosen on simulated people (numbers below 100); `ambula bench exercises` scores others."""

    turn_floor: float = 0.15
    """rad (8.6 deg) that squats and steps must come back for a turn to be one, in whoever moves little."""
    lean_floor: float = 0.08
    """rad (4.6 deg), the same for a leaning trunk, which moves less: some simulated people lean by 9 deg."""
    upright_margin: float = 0.04
    """rad (2.3 deg) to either side of upright that are no lean: a standing person sways and drifts by 1 deg."""
    still_band: float = 0.07
    """rad (4 deg) within which a resting body stays for half a second, as a camera at 30 Hz sees it."""
    lean_return_share: float = 0.7
    """share of the way that a leaning trunk must come back before a new movement outward is another repetition: a held
    lean is small against what the camera makes of it."""
    lean_still_band: float = 0.05
    """rad within which a trunk that leans forward rests."""
    side_still_band: float = 0.02
    """rad, the same for one that leans aside: below the margin, where it rests, nothing moves."""
    lean_still_s: float = 1.0
    """s within that band after which the trunk rests: a sway of 12 deg in 12 s crosses it in half of that."""
    longest_hold_s: float = 20.0
    """s of rest at the far side after which it is a new resting position; holds of up to 15 s are prescribed."""
    longest_s: float = 45.0
    """s; a hold of 15 s and as long on each way."""
    longest_gap_s: float = 0.5
    """s without samples that a repetition may contain; a camera drops single frames."""
    longest_unseen_s: float = 1.2
    """s for which an angle that is not valid is still followed: a camera guesses an ankle for half a second, and what
    is estimated meanwhile is not to be shown but good enough to tell down from up."""
    seen_share: float = 0.5
    """share of a repetition in which a joint must be seen to have a range."""
    jump: float = 0.5
    """rad by which an angle may differ from where its velocity takes it; a camera makes more of them than a sensor, and
    they pass."""

    legs_apart_share: float = 1.3
    """share of a squat's range by which the difference of the knees may change within it. A walk changes it by three
    times the range of their mean; a person who spares one leg by half of it."""
    standing_share: float = 0.5
    """share of a squat's depth, from straight knees, above which its ends are not standing: whoever is already down
    and moves there, or whose knees the camera guesses, makes none (proposal)."""
    walked_m: float = 0.35
    """m on the floor that the pelvis may be away at the end of a repetition from where it was at its start."""

    upright_s: float = 1.5
    """s of rest after which the lean is the person's own upright."""
    upright_band: float = 0.05
    """rad within which the lean stays in such a rest."""
    upright_first: float = 0.2
    """rad (11 deg) from the vertical within which the first rest is one upright."""
    upright_later: float = 0.06
    """rad from the first one within which a later rest is upright."""
    upright_memory: int = 5
    """rests whose median is the person's own upright."""

    def repetitions_of(self, task: Task) -> RepetitionParameters:
        """What the search for there and back takes in a task."""
        leans = task in (Task.TRUNK_TILT_SAGITTAL, Task.TRUNK_TILT_FRONTAL)
        common = RepetitionParameters(
            turn_floor=self.turn_floor,
            still_band=self.still_band,
            longest_hold_s=self.longest_hold_s,
            longest_s=self.longest_s,
            longest_gap_s=self.longest_gap_s,
            one_way=True,
            jump=self.jump,
        )
        if not leans:
            return common
        return replace(
            common,
            turn_floor=self.lean_floor,
            floor_margin=self.upright_margin,
            return_share=self.lean_return_share,
            still_band=self.side_still_band if task is Task.TRUNK_TILT_FRONTAL else self.lean_still_band,
            still_s=self.lean_still_s,
        )
