"""Every tunable of the estimation service."""

from dataclasses import dataclass, field, replace
from typing import Literal

from schemas.session import SessionDescription
from services.biomech.lower_body_ekf import NO_BOUND, MeasurementModel, NoiseModel
from services.biomech.rhythm.parameters import TrustedParameters
from services.biomech.single_joint.innovation_gate import InnovationGate
from services.estimation.body.parameters import BodyParameters


@dataclass(frozen=True)
class CheckParameters:
    """When a sample is not used."""

    largest_rate: float = 40.0  # rad/s, above the range of worn gyroscopes (2000 deg/s = 35 rad/s)
    largest_force: float = 320.0  # m/s^2, above the range of worn accelerometers (32 g)
    rate_jump: float = 25.0  # rad/s from one sample to the next at 100 Hz; walking stays below 6, landings reach 16
    force_jump: float = 250.0  # m/s^2 from one sample to the next; landings from a jump reach 200
    stuck_after: int = 25  # identical samples in a row; real sensors have noise in their last digit
    silent_after_s: float = 0.25  # s without a usable sample until a sensor counts as missing
    farthest_from_message_s: float = 10.0  # s between a sample and its message; more is a broken time stamp


@dataclass(frozen=True)
class QualityParameters:
    """When and of what the quality of the data is told."""

    period_s: float = 5.0  # s of session time between two messages
    pace_s: float = 1.0  # s over which the mean rate of the flexions is smoothed: joints stop for a moment in a stride
    moving_pace: float = 0.15  # rad/s of it; standing stays below 0.03, walking 0.3 m/s has 0.3
    moving_pace_camera: float = 0.5  # the same of a camera, whose noise makes 0.38 of a standing person
    longest_row_s: float = 0.25  # s between two rows; what is longer was seen by nobody, as a silent sensor


@dataclass(frozen=True)
class StandingParameters:
    """What counts as quiet standing."""

    block_s: float = 0.25  # s over which stillness is judged
    shortest_s: float = 1.0  # s of stillness in a row; the recipe asks for 2 s, more makes bias and datum better
    still_rate: float = 0.12  # rad/s of the block's mean: gyro bias (0.03) and postural sway (0.1) stay below
    still_force_std: float = 0.5  # m/s^2 within the block
    gravity: float = 9.81  # m/s^2
    gravity_tolerance: float = 0.5  # m/s^2; more is a unit or scale error
    same_vertical: float = 0.17  # rad (10 deg) between two standings of the same person with the same straps
    sway: float = 0.012  # rad by which a standing segment's tilt differs between two instants
    likely_bias: float = 0.02  # rad/s, standard deviation of gyroscope biases before anything is known
    remember_s: float = 12.0  # s of samples that a mark of the operator may lie back; the page offers up to 10 s
    leaning: float = 0.07  # rad (4 deg) that a vertical may move within a marked standing; sway stays below 0.03
    seated_thigh: float = 0.7  # rad (40 deg) between a thigh in a marked standing and in the standing before it
    risen_s: float = 1.0  # s, in all, that a thigh leans back against a standing that must then have been sitting
    risen_tolerance: float = 1.5  # m/s^2 between the mean over a block and gravity, for a lean to be told by it
    steepest_thigh: float = (
        0.7  # |cos| between skin normal and vertical; a sitting thigh is above, a standing one below
    )


@dataclass(frozen=True)
class BiasParameters:
    """How gyroscope biases are followed from pause to pause. Set by these definitions, not tuned."""

    start_std: float = 0.005  # rad/s, what a standing of 2 to 3 s leaves unknown
    drift: float = 0.00035  # rad/s within one second's random walk: 0.5 deg/s in 10 min, a sensor that warms up
    farthest: float = 3.0  # standard deviations; a body that turns faster than that in a pause turns slowly, it does
    # not tell a bias


@dataclass(frozen=True)
class AlignmentParameters:
    """How the flexion axes are found in the first steps."""

    cutoff_hz: float = 10.0  # Hz, gyro low-pass before the principal direction
    moving_rate: float = 0.5  # rad/s, horizontal rate above which a sample tells an axis
    shortest_moving_s: float = 3.0  # s of moving samples of each leg sensor; 1.5 costs 0.4 deg on squats and landings
    swing_rate: float = 0.8  # rad/s that each leg sensor must have reached; thighs of slow walkers stay near 1
    steadiest_change: float = 0.09  # rad (5 deg) an axis may change between two looks, 0.5 s apart
    look_every_s: float = 0.5  # s
    clearest_ratio: float = 0.5  # second to first principal value; more is no axis
    give_up_after_s: float = 20.0  # s of movement after which the axes at hand are taken, clear or not
    silent_ticks: int = 100  # a sensor without a sample in that many ticks is not waited for
    placement_decides: float = (
        0.5  # |cos| between axis and the direction the placement tells, above which it gives the sign
    )


@dataclass(frozen=True)
class WalkingParameters:
    """How a session is calibrated in which nobody stood still."""

    wait_s: float = 10.0  # s after the first sample during which standing is waited for
    fewest_strides: int = 3  # regular straight strides; a short walk has no more
    cutoff_hz: float = 5.0  # Hz, gyro low-pass before swings are counted
    slowest_swing: float = 1.0  # rad/s of a shank or thigh in swing; slow walkers stay above
    step_cutoff_hz: float = 3.0  # Hz, low-pass of the trunk's specific force before its steps are counted
    smallest_catch: float = 0.6  # m/s^2 by which that force rises in a step, as in segmentation
    flat_rate: float = 0.6  # rad/s below which a foot is flat on the ground
    shortest_stride_s: float = 0.6  # s
    longest_stride_s: float = 3.0  # s; sit-to-stand repeats every 3.5 s
    straightest: float = 0.5  # rad that a sensor may have turned over one stride
    return_error: float = 0.2  # rad by which a sensor is turned between the ends of whole strides: biases told by a
    # short walk are not believed; at 0.05 the hip with the turn is 0.8 deg worse
    gravity_tolerance: float = 2.5  # m/s^2; the mean over a swinging sensor's directions is shorter than gravity
    thigh_lean: float = 0.087  # rad (5 deg) forward: mean of healthy adults' walking over the stride
    shank_lean: float = -0.26  # rad (15 deg) back, the same; their difference is the mean knee flexion
    best_quality: float = 0.4  # of a sensor whose zero is a population's


@dataclass(frozen=True)
class UnmodelledErrors:
    """What no filter on these sensors can know, added to the published deviations. rad, one standard deviation of a
    segment's inclination; a joint has those of both its segments.

    Soft tissue: inclinations of thigh and shank against optical ones on a recorded walk differ by 2.3 and 3.3 (thighs),
    1.1 and 1.3 deg (shanks), offset removed. A sacral sensor moves less. The posture that counts as zero is not in it.
    """

    soft_tissue_pelvis: float = 0.009
    soft_tissue_thigh: float = 0.049
    soft_tissue_shank: float = 0.021
    soft_tissue_rate: float = 7.0  # rad/s: it moves once and twice a stride, so its velocity is its angle times this
    gravity_thigh: float = 0.005  # accelerations of a walking thigh, read as gravity, beyond the filter's covariance
    gravity_shank: float = 0.026  # the same of a shank; both chosen on synthetic walks. They grow with the speed


@dataclass(frozen=True)
class CoastingParameters:
    """How silent sensors are stood in for. Chosen on synthetic walks of seeds 103 to 106, 50 and 100 Hz."""

    strides: float = 4.0  # strides over which samples are averaged
    after_s: float = 0.105  # s without a sample from which on a sensor is stood in for; sooner, the filter's own
    # prediction, which the next sample corrects, is better
    longest_s: float = 5.0  # s without a sample after which it is no longer
    lead_s: float = 0.2  # s in which joints are led to where they were
    fade_s: float = 2.4  # s in which a wrong position is forgotten: the tilt time constant of the filter
    surprise_s: float = 0.1  # s over which surprise is averaged
    most_surprise: float = 3.0  # variances of the gyroscopes of those who speak, beyond which nobody is stood in for
    most_surprise_on_return: float = 25.0  # the same of the sensor itself, beyond which the joint begins anew
    most_surprise_after_gap: float = 0.5  # the same of all after a gap of everyone, at the phase that suits them best;
    # who walks on is below 0.05
    least_rate_std: float = 0.3  # rad/s, less is no surprise
    least_force_std: float = 1.0  # m/s^2, the same
    frequency_change: float = 0.04  # relative, by which a walk may have been faster while nobody was heard
    step_s: float = 0.01  # s, steps through a gap of everyone
    buffer_s: float = 4.0  # s that are kept until a rhythm is found in them; two strides of a slow walk
    buffer_every_s: float = 0.02  # s


@dataclass(frozen=True)
class FilterParameters:
    """The filter beside its noise."""

    measurement: MeasurementModel = field(default_factory=MeasurementModel)
    noise: NoiseModel = field(default_factory=NoiseModel)
    soft_knees: bool = True
    sample_delay: float = 0.5  # sample intervals by which a sample's meaning is older than its time stamp: worn sensors
    # give the mean over the interval that ends there. 0 lags 5 ms behind on recordings at 100 Hz, 12 ms at 40 Hz
    silent_after_s: float = 0.25  # s without a sample until a segment counts as unseen
    doubt_s: float = 1.0  # s after a sensor's return, or after a gap, in which its joints are not valid yet
    longest_step_s: float = 0.25  # s between samples; after more the filter settles anew, keeping the pose
    rest_position_std: float = 0.2  # rad at 100 Hz: pull to zero of a joint whose sensor has fallen silent
    rest_velocity_std: float = 0.5  # rad/s at 100 Hz, the same for its velocity
    unworn_std: float = 0.1  # rad and rad/s at 100 Hz: the same where no sensor is worn. Looser, an unseen pelvis
    # shakes with every landing of the leg (1 deg at the knee); tighter on silent sensors, their return takes longer
    rest_acceleration_std: float = 10.0  # rad/s^2 at 100 Hz, the same for its acceleration
    rhythm: TrustedParameters = field(default_factory=TrustedParameters)  # 10 harmonics pay on long even walks, harm on
    # the recorded one of 10 s
    gate: InnovationGate = field(default_factory=InnovationGate)
    judges: Literal["segment", "leg", "body"] = "segment"  # whose gyroscopes decide whether a joint follows the rhythm
    unmodelled: UnmodelledErrors = field(default_factory=UnmodelledErrors)
    calm_share: float = 0.1  # of the process noise that a third state has once the rhythm is learned; 1 runs none
    closes_gaps: bool = True  # of up to `silent_after_s`, from both ends; see gap_filling.py
    coasts: bool = True  # `rhythmic_ekf` goes on without a silent sensor as the strides before tell
    coasting: CoastingParameters = field(default_factory=CoastingParameters)
    longest_jerk: float = 2000.0  # rad/s^3, bound on what a rhythm may feed; knee jerk in walking stays below 1500


PUBLISHED = FilterParameters(
    measurement=MeasurementModel(gyro_sees_position=True, accel_sees_motion=True),
    noise=NoiseModel(accel_std=1.0, yaw_std=0.1, impact_rate=NO_BOUND),
    soft_knees=False,
    closes_gaps=False,
    sample_delay=0.0,
)
"""The measurement model as published (Joukov eq. 10-14, 22): full Jacobian, dynamic accelerometer, hinge knees, yaw
known to 0.1 rad, samples that mean the instant of their time stamp. `walk_path` straight is eq. 22, turning the variant
that the paper names beside it. Why ours differs is said at each option."""


@dataclass(frozen=True)
class SegmentMotionParameters:
    """How the vertical of a foot is followed."""

    tilt_time: float = 2.4  # s in which the specific force corrects the gyroscope, as in the filter of the body
    gravity: float = 9.81  # m/s^2
    longest_step_s: float = 0.25  # s between samples; after more the foot is taken to be flat


@dataclass(frozen=True)
class KneeParameters:
    """The knee of two sensors in the service; the estimators have tunables of their own."""

    kept_s: float = 30.0  # s of samples from before the axis is believed: a timed walk from a chair and back
    good_axis_std: float = 0.12  # rad (7 deg); an axis that well known is taken at once, a worse one is waited with
    longest_wait_s: float = 3.0  # s that a believed axis is waited with: axes of soft legs never become that good
    sense_s: float = 6.0  # s that an axis is known without its sense until standing is asked for: motion tells it in 3
    together_s: float = 5.0  # s for which the first leg waits for the other, where both wear sensors
    doubt_s: float = 1.0  # s after a sensor's return, a gap or the first sample in which the angle is not valid yet
    instant_share: float = 0.75  # of a sample interval that must lie between instants where not everyone speaks
    straightest: float = (
        0.09  # rad (5 deg) of the knee that counts as straight where nobody stood: in walking, midstance
    )
    straightest_share: float = 0.02  # of the samples that are straighter: outliers
    population_quality: float = 0.4  # best quality of a zero that is a population's, as WalkingParameters
    placement_decides: float = 0.5  # |cos| between axis and the direction the placement tells, for it to give the sign
    votes: float = (
        10.0  # looks, half a second apart, in which the leg moves and a misplacement shows, until it is named
    )
    votes_remembered: float = 120.0  # looks; a leg that was seen the right way up within the last minute is not swapped
    contrary_votes: float = 0.1  # share of looks that may have shown the contrary
    look_s: float = 0.5  # s
    moving_rate: float = 0.5  # rad/s of a sensor that a look must have seen
    axis_change: float = 0.17  # rad (10 deg) by which an axis must have moved for the calibration to be sent again
    smoothing_hz: float = 8.0  # Hz, low-pass of the rates' difference quotient, the acceleration
    rate_std: float = (
        0.37  # rad/s: soft tissue of thigh and shank, moving once and twice a stride; see UnmodelledErrors
    )
    inclination_std: float = 0.06  # rad: levelling, and soft tissue of the thigh
    unworn_std: float = 0.5  # rad and rad/s of what nobody wears
    heading_std: float = 1.0  # rad; where the leg faces at the start counts as ahead
    mcgrath_motion_s: float = (
        30.0  # s of motion whose principal component is the axis: a third of the published trials,
    )
    # and the axis has settled to a degree by then
    mcgrath_kept_s: float = 60.0  # s that are held until then
    mcgrath_least_s: float = 3.0  # s of motion that will do when the time is over, or the recording


@dataclass(frozen=True)
class EstimationParameters:
    """All of them."""

    checks: CheckParameters = field(default_factory=CheckParameters)
    standing: StandingParameters = field(default_factory=StandingParameters)
    alignment: AlignmentParameters = field(default_factory=AlignmentParameters)
    walking: WalkingParameters = field(default_factory=WalkingParameters)
    filter: FilterParameters = field(default_factory=FilterParameters)
    bias: BiasParameters = field(default_factory=BiasParameters)
    follow_bias: bool = True  # in pauses, see resting_bias.py; without it the first standing's biases stay
    segment_motion: SegmentMotionParameters = field(default_factory=SegmentMotionParameters)
    knee: KneeParameters = field(default_factory=KneeParameters)
    body: BodyParameters = field(default_factory=BodyParameters)
    quality: QualityParameters = field(default_factory=QualityParameters)
    lateness_s: float = 0.04  # s of captured time that one hub may lag behind another before it is not waited for
    same_tick_s: float = 0.0005  # s, samples closer than this are fused at the time of the earliest
    before_walking_s: float = (
        2.0  # s of standing at the start of the estimates: the filter settles in it; 0.5 costs 0.1
    )
    live_rate_hz: float = 25.0  # Hz of data time
    notice_s: float = 8.0  # s for which the screen says what became of a mark

    def filter_of(self, description: SessionDescription) -> FilterParameters:
        """The filter of a session: `filter`, or the published one by name, and yaw as the walk's path asks for."""
        chosen = PUBLISHED if description.estimator == "joukov_published" else self.filter
        if description.walk_path == "turning":
            return chosen
        return replace(chosen, measurement=replace(chosen.measurement, yaw="world"))
