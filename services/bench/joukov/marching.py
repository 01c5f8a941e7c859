"""Virtual participants who march on the spot, as those of the paper's section IV-B did, through the whole filter.

Each marches two minutes at the own pace, after a metronome at 70 per minute, and after one that changes every 30 s.
Sensors have noise as of skin that shivers (0.05 rad/s, 0.2 m/s^2) and soft tissue that turns them by 2 deg.
The first participant tunes the plain filter and is not scored.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Segment
from services.bench.joukov.recordings import (
    DEFAULT_S,
    JOINTS,
    FilterRun,
    Recording,
    calibrate,
    run_filter,
    sensors_on,
    with_noise,
)
from services.bench.joukov.regions import WHOLE, RegionErrors, prediction_errors, region_errors
from services.bench.joukov.segmentation import mean_frequency, segmentation
from services.estimation.parameters import PUBLISHED, FilterParameters
from services.ingest.synthetic import MarchParameters, SyntheticMarch

FloatArray = NDArray[np.float64]

TUNED_SEED, FIRST_SEED = 7000, 7001
PARTICIPANTS = 6
OPTIONS = "soft_tissue=0.035&gyro_noise=0.05&accel_noise=0.2"
OWN_PACE, BEAT, CHANGING = "own pace", "metronome", "changing metronome"
TRIALS = {OWN_PACE: "", BEAT: "&metronome=70", CHANGING: "&tempo_changes=1&duration=219"}
BEAT_HZ = 70.0 / 60.0

PLAIN, LITERAL, OURS = "ekf", "rhythmic_ekf_joukov", "rhythmic_ekf"
ESTIMATORS = (PLAIN, LITERAL, OURS)
TITLES = {PLAIN: "EKF", LITERAL: "literal", OURS: "ours"}
"""In tables and legends: the Rhythmic-EKF with the published oscillator, and with our rhythm."""
CONVERGED_S = 15.0
"""s of marching before anything is scored, as published."""
GRID = 10.0 ** np.arange(2.0, 6.01, 0.5)
"""(rad/s^3)^2, of the curve over S."""
DECADE = 2
PLACES = ((Segment.THIGH_RIGHT, Segment.THIGH_LEFT), (Segment.SHANK_RIGHT, Segment.SHANK_LEFT))
"""The published knee and ankle sensors: lower thigh and lower shank."""

INSTANTANEOUS = FilterParameters(sample_delay=0.0)
"""The filter as it is by default; only that a synthetic sample means the instant of its time stamp."""
MODELS = {
    "gravity": INSTANTANEOUS,
    "published": replace(PUBLISHED, measurement=replace(PUBLISHED.measurement, yaw="world")),
}
"""Measurement models: ours, in which accelerometers see gravity alone, and the published one, in which they see the
whole motion, the gyroscope's Jacobian is full, knees are hinges, and the yaw row is against the world."""


@dataclass(frozen=True)
class Score:
    """One filter on one trial, from CONVERGED_S on."""

    errors: RegionErrors
    prediction: FloatArray
    """RMSE of the next sample, (2, 2): gyroscope rad/s and accelerometer m/s^2 by thigh and shank."""
    frequency: float
    """rad/s, mean while locked."""
    segmented: FloatArray
    """1 or 0 for each repetition of the right leg."""
    locked: float
    """Share of the time."""


@dataclass(frozen=True)
class Setting:
    """What was run."""

    model: str
    estimator: str
    S: float


Scores = dict[Setting, Score]


@dataclass(frozen=True)
class Trial:
    """A march with its truth."""

    march: SyntheticMarch
    recording: Recording

    @classmethod
    def of(cls, seed: int, trial: str) -> "Trial":
        """One participant in one of TRIALS."""
        options = f"seed={seed}&{OPTIONS}{TRIALS[trial]}"
        return cls(SyntheticMarch(MarchParameters.parse(options)), calibrate(f"synthetic:march?{options}"))

    def run(self, setting: Setting) -> FilterRun:
        """One filter over the march."""
        return run_filter(self.recording, setting.estimator, with_noise(MODELS[setting.model], setting.S))

    def truth(self, time_s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """State (3, n, 4) of JOINTS, phase rad and frequency rad/s of the right leg, (n,)."""
        strides = self.march.strides(time_s)
        angles = self.march.gait.angles(strides)
        orders = ("value", "rate", "acceleration")
        state = np.array([np.column_stack([getattr(angles[name], order) for name in JOINTS]) for order in orders])
        return state, 2 * np.pi * strides.phase.value, 2 * np.pi * strides.phase.rate

    def scored(self, time_s: FloatArray) -> NDArray[np.bool_]:
        """Which instants count: converged, and before the last cycle, which fades out."""
        (bout,) = self.march.timeline.bouts
        last_cycle_s = 1.0 / self.march.timeline.frequency_hz
        return (time_s >= bout.start_s + CONVERGED_S) & (time_s < bout.end_s - last_cycle_s)

    def score(self, run: FilterRun) -> Score:
        """How well the filter did."""
        state, phase, _ = self.truth(run.time_s)
        use = self.scored(run.time_s)
        return Score(
            region_errors(run.state[:, use], state[:, use]),
            prediction_errors(run.surprise[use], [sensors_on(self.recording, place) for place in PLACES]),
            mean_frequency(run.frequency[use], run.locked[use]),
            segmentation(run.time_s[use], run.phase[use], run.locked[use], phase[use]),
            float(np.mean(run.locked[use])),
        )


@dataclass(frozen=True)
class Tuning:
    """Values of S, (rad/s^3)^2, chosen with the plain filter on the first participant."""

    star: float
    """S*: smallest whose angles are within 1 % of the best, without their mean error."""
    tenth: float
    """S*/10."""
    agile: float
    """Whose accelerations are best."""
    agile_ours: float
    """The same for our filter."""

    @property
    def named(self) -> dict[str, float]:
        """By the name that tables use."""
        return {"default S": DEFAULT_S, "S*": self.star, "S*/10": self.tenth}


def trace_tuning(estimator: str) -> list[RegionErrors]:
    """Errors over GRID of the participant who is not scored, at the own pace."""
    trial = Trial.of(TUNED_SEED, OWN_PACE)
    return [trial.score(trial.run(Setting("gravity", estimator, S))).errors for S in GRID.tolist()]


def tune(plain: Sequence[RegionErrors], ours: Sequence[RegionErrors]) -> Tuning:
    """Choose S from what `trace_tuning` found for both filters."""
    spread = np.array([errors.sd[WHOLE, 0].mean() for errors in plain])
    first = max(int(np.argmax(spread <= 1.01 * spread.min())), DECADE)
    agile, agile_ours = (int(np.argmin([e.rmse[WHOLE, 2].mean() for e in errors])) for errors in (plain, ours))
    star, tenth, best, best_ours = GRID[[first, first - DECADE, agile, agile_ours]].tolist()
    return Tuning(star, tenth, best, best_ours)


def settings(trial: str, tuning: Tuning) -> list[Setting]:
    """What is run on a trial."""
    named = list(tuning.named.values())
    if trial != OWN_PACE:
        return [Setting("gravity", estimator, S) for estimator in (LITERAL, OURS) for S in named]
    curve = sorted({*GRID.tolist(), *named})
    return [
        *(Setting("gravity", estimator, S) for estimator in ESTIMATORS for S in curve),
        *(Setting("published", estimator, S) for estimator in ESTIMATORS for S in named),
    ]


def study_trial(task: tuple[int, str], tuning: Tuning) -> Scores:
    """All that is run on one trial of one participant: (seed, trial)."""
    trial = Trial.of(*task)
    return {setting: trial.score(trial.run(setting)) for setting in settings(task[1], tuning)}
