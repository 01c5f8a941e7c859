"""Everything that can be tuned in gait from a camera: unit, default, where the default comes from."""

from dataclasses import dataclass, replace

from services.segmentation.parameters import SegmentationParameters


@dataclass(frozen=True, slots=True)
class CameraGaitParameters:
    """Chosen on simulated walkers (seeds below 100); `ambula bench exercises gait` scores others."""

    contact_after_foremost_s: float = 0.04
    """s from the foremost ankle as a camera's estimate has it to initial contact."""
    toe_off_after_hindmost_s: float = 0.037
    """s from the hindmost ankle as a camera's estimate has it to toe-off."""
    contact_std_s: float = 0.03
    """s, one standard deviation of a contact; a frame takes 0.033."""
    toe_off_std_s: float = 0.03
    """s, the same for a toe-off; both were 30 ms through the whole chain."""
    resting_contact_std_s: float = 0.1
    """s, the same for a foot that comes to rest beside the other one."""
    swing_floor_m: float = 0.1
    """m that an ankle must come forward against the pelvis in a swing; smaller movements are shuffles or noise."""
    swing_share: float = 0.35
    """share of the person's own median swing that a swing must reach."""
    swing_memory: int = 7
    """swings whose median is the person's own."""
    back_floor_m: float = 0.03
    """m that the ankle must come back for its foremost point to be believed; noise of the estimate is 1 to 2 cm."""
    back_share: float = 0.1
    """share of the swing that it must come back."""
    turn_reach_s: float = 0.1
    """s to both sides of a turning point over which a parabola is fitted to it: seven frames."""
    landing_timeout_s: float = 0.4
    """s without coming further forward after which a foot that does not come back has come to rest."""
    activity_s: float = 0.2
    """s over which the speed of an ankle is taken to tell standing from walking."""
    pause_rate: float = 0.35
    """rad/s of the leg below which it stands; noise of the estimate makes 0.1 to 0.2."""
    longest_gap_s: float = 0.25
    """s without samples that a stride may contain."""
    release_delay_s: float = 0.6
    """s a stride waits: contacts are noticed later than with sensors."""
    history_margin_s: float = 1.0
    """s of joint angles and centres kept before the last contact."""
    direction_s: float = 3.0
    """s over which the direction is learned in which the ankles part."""
    facing_s: float = 1.0
    """s over which it is learned where hips and shoulders face."""
    facing_weight_m: float = 0.1
    """m; while ankles part by less, the person is taken to walk where she faces."""
    flat_from: float = 0.25
    """share of the stance from which on the foot is flat and its ankle stays over the ground."""
    flat_to: float = 0.65
    """share of the stance until which it is."""
    least_flat_samples: int = 4
    """samples of a flat foot below which it tells nothing of the ground."""
    longest_stance_s: float = 3.0
    """s beyond which a foot that stood belongs to no walk."""
    placed_from_s: float = 0.1
    """s after contact from which on a foot is where it was put."""
    placed_to_s: float = 0.3
    """s after contact until which that is averaged."""
    least_placed_samples: int = 2
    """samples below which it is not known where a foot was put."""
    belt_memory: int = 9
    """stances whose median speed is the belt's."""
    belt_share: float = 0.5
    """share of the walking speed at which the standing foot moves in the room, from which on it stands on a belt."""
    placement_std_m: float = 0.05
    """m, one standard deviation of where a foot was put, through the whole chain: ankles slide and are guessed."""

    def over(self, parameters: SegmentationParameters) -> SegmentationParameters:
        """Those of gait in general, where a camera tells the events."""
        return replace(
            parameters,
            longest_gap_s=self.longest_gap_s,
            pause_rate=self.pause_rate,
            release_delay_s=self.release_delay_s,
            history_margin_s=self.history_margin_s,
        )
