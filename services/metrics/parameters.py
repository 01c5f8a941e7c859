"""Everything that can be tuned in the metrics: unit, default, where the default comes from."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from schemas.metrics import DoubtKind


@dataclass(frozen=True, slots=True)
class SharedErrorParameters:
    """Standard deviations of what all strides of a session have alike.

    Where no other source stands, chosen on synthetic patients (seeds 2001 to 2032, 3001 to 3016, 4001 to 4032; bodies
    measured to 3 %, soft tissue) so that their truth lies within the intervals; `ambula bench metrics coverage` scores
    others.
    """

    relative_length: Mapping[str, float] = field(
        default_factory=lambda: {"measured": 0.03, "regression": 0.05, "default": 0.08}
    )
    """of segment lengths, by where they come from: a tape between palpated landmarks; from stature; of nobody
    (proposal)."""
    filter_share: float = 0.25
    """of the filter's own deviation that is the same in every stride."""
    contact_bias_s: float = 0.02
    """s by which initial contacts are early or late."""
    toe_off_bias_s: float = 0.038
    """s by which toe-offs are."""
    foot_difference_s: float = 0.0095
    """s by which one foot's contacts are later than the other's."""
    relative_stride_time: float = 0.002
    """of times from contact to contact: a clock, and a walk of seconds for how somebody walks."""
    contact_jitter_s: float = 0.015
    """s of scatter from stride to stride that contacts have because they are measured."""
    toe_off_jitter_s: float = 0.025
    """the same of toe-offs."""
    length_jitter: float = 0.02
    """m, or m/s, of scatter that steps have because they are measured."""
    circumduction_m: float = 0.01
    """m."""
    width_m: float = 0.02
    """m of a camera's step width (proposal; no synthetic patient walks before a camera)."""
    levels: Mapping[str, float] = field(
        default_factory=lambda: {
            "knee_flexion": 0.027,
            "hip_flexion": 0.06,
            "hip_adduction": 0.013,
            "hip_rotation": 0.017,
            "pelvis_tilt": 0.002,
            "ankle_dorsiflexion": 0.09,
        }
    )
    """rad, of angles at an instant or over the stride, by how the metric's name begins. Of sensors that sit as on the
    synthetic patients: in people absolute angles are 7 to 10 deg off everywhere."""
    extents: Mapping[str, float] = field(
        default_factory=lambda: {
            "knee_flexion": 0.04,
            "hip_flexion": 0.02,
            "hip_rotation": 0.027,
            "pelvis_tilt": 0.0075,
            "pelvis_obliquity": 0.0027,
            "pelvis_rotation": 0.0035,
        }
    )
    """rad, of ranges, and of the knee's peak in swing, which a filter cuts off like a range."""
    ratios: Mapping[str, float] = field(
        default_factory=lambda: {
            "step_length": 0.065,
            "step_time": 0.035,
            "stance_time": 0.06,
            "swing_time": 0.11,
            "single_support_time": 0.1,
            "knee_flexion_range": 0.07,
            "hip_flexion_range": 0.03,
        }
    )
    """relative, of the ratio of both sides of a measure: what both share cancels in it."""


@dataclass(frozen=True, slots=True)
class TrunkParameters:
    """Autocorrelation of the lower back's acceleration."""

    window_s: float = 6.0
    """s over which it is taken: five strides (proposal)."""
    longest_stride_s: float = 2.5
    """s; the slowest strides that are counted last as long."""
    least_motion: float = 0.4
    """m/s^2, standard deviation within a window: standing stays below 0.1, slow walking is above (proposal)."""
    longest_hole_s: float = 0.05
    """s between two samples of one window."""
    peak_within: float = 0.15
    """of a lag, by which its peak may lie beside (proposal)."""


@dataclass(frozen=True, slots=True)
class MetricsParameters:
    """How many strides or repetitions a number must rest on."""

    least_strides: int = 3
    """strides below which a mean is withheld (proposal; reliable means need 6 of each foot)."""
    least_strides_for_variability: int = 10
    """strides below which standard deviation and CV are withheld as metrics (proposal of the clinical conventions)."""
    least_steady_strides: int = 3
    """steady strides of each foot that is seen, from which on the starting and stopping ones are left out; as many as
    a mean needs."""

    least_repetitions: int = 3
    """repetitions of an exercise below which their numbers are withheld; a line needs as many to have an error."""
    longest_pause_s: float = 10.0
    """s of rest after a repetition beyond which the next one begins another set; prescribed holds and rests within a
    set last 5 to 10 (proposal)."""
    most_repetitions: int = 1000
    """repetitions told one by one; what a message takes."""
    most_phases: int = 500
    """phases of a timed test told one by one; what a message takes."""
    shared: SharedErrorParameters = field(default_factory=SharedErrorParameters)
    """errors that all strides have alike."""
    trunk: TrunkParameters = field(default_factory=TrunkParameters)
    """of whoever wears a lumbar sensor alone."""


@dataclass(frozen=True, slots=True)
class Rule:
    """A number of the data against limits: beyond `fair` a metric is no better than fair, and so on. None: never."""

    fair: float | None
    poor: float | None
    withheld: float | None
    source: str
    below: bool = False
    """Whether too little is what speaks against the metric, instead of too much."""


RULES: Mapping[DoubtKind, Rule] = {
    DoubtKind.FEW_CYCLES: Rule(6, 3, None, "6 cycles of each foot: PMC7558375; 3: proposal", below=True),
    DoubtKind.REJECTED_CYCLES: Rule(0.2, 0.5, 0.8, "proposal: share of the strides"),
    DoubtKind.COVERAGE: Rule(0.9, 0.7, 0.3, "proposal: share of the time", below=True),
    DoubtKind.LOSS: Rule(0.02, 0.1, 0.5, "good systems lose 0.9 % of a recording, a tenth of them over 12.8 %: faults"),
    DoubtKind.SILENCE: Rule(1.0, 5.0, None, "proposal: s; strides with a silent sensor are rejected one by one"),
    DoubtKind.LATE: Rule(0.01, 0.05, None, "proposal: share of the samples"),
    DoubtKind.MISPLACED: Rule(0, 0, 0, "proposal: an angle of a sensor worn otherwise is none"),
    DoubtKind.NOT_CALIBRATED: Rule(0, 0, None, "zero uncertain by 5 to 10 deg: estimation, walking alone"),
    DoubtKind.NOT_ABSOLUTE: Rule(0, 0, None, "McGrath 2018: 3.5 deg about the mean, 9.7 deg absolute"),
    DoubtKind.NOT_LOCKED: Rule(0.6, 0.2, None, "proposal: share of the time of moving", below=True),
    DoubtKind.WARM_UP: Rule(15.0, None, None, "Joukov: 15 s in the experiments; s of moving", below=True),
    DoubtKind.WIDE_INTERVAL: Rule(1.0, 2.0, None, "proposal: half the interval over the smallest useful change"),
    DoubtKind.WEAK_MEASURE: Rule(0, 0, None, "double support: ICC 0.21 to 0.73, PMC8072263"),
    DoubtKind.IMPLAUSIBLE: Rule(0, 0, None, "limits of mobgap 1.2.0, healthy free living"),
}
"""One row per reason. Where a limit is 0, having the reason at all is enough."""

USEFUL_CHANGE: Mapping[str, tuple[float, str]] = {
    "walking_speed": (0.05, "Perera: small change; Hosoi 2023: MDC below 0.4 m/s"),
    "step_length": (0.067, "Kesar 2011, paretic step length"),
    "stance_fraction": (0.042, "Kesar 2011, temporal variables"),
    "swing_fraction": (0.042, "Kesar 2011, temporal variables"),
    "knee_flexion_range": (0.105, "6 deg: proposal from Kesar 2011"),
    "knee_flexion_peak_swing": (0.105, "6 deg: proposal from Kesar 2011"),
    "hip_flexion_range": (0.105, "6 deg: proposal from Kesar 2011"),
    "hip_extension_peak": (0.105, "6 deg: proposal from Kesar 2011"),
}
"""Smallest change that somebody would want to see, in the metric's unit, with its source."""

PLAUSIBLE: Mapping[str, tuple[float, float]] = {"walking_speed": (0.10, 1.97), "cadence": (36.0, 157.0)}
"""Smallest and largest value that is believed, in the metric's unit; no norm (mobgap 1.2.0, healthy free living)."""

WEAK = ("initial_double_support", "terminal_double_support", "double_support")
"""Beginnings of the names of measures that are weak even with both feet instrumented."""
