"""One visit of a synthetic patient: the same body and manner, another day's noise, mounting and tape, by the chain."""

from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta

from schemas.conditions import Conditions
from schemas.metrics import Metric, SessionMetrics
from schemas.population import Population
from schemas.session import SessionDescription
from schemas.vocabulary import Task
from services.cli.assembly import build_chain
from services.ingest.choices import AS_THE_SOURCE_SAYS
from services.ingest.identity import Identity
from services.ingest.source import iter_messages
from services.ingest.synthetic.gait import Gait
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.patients.footfalls import plan_footfalls
from services.ingest.synthetic.patients.manners import manner
from services.ingest.synthetic.patients.walk import PatientWalk, body_of
from services.ingest.synthetic.source import SyntheticSource
from services.progress.baseline import freeze
from services.progress.progress import Person, progress
from services.progress.series import Series
from services.progress.visits import Trial, in_visits

TICKS = 10
SETTING = "duration=40&tape=0.03&soft_tissue=0.02"
"""A body measured by tape to within 3 % anew at each visit, sensors strapped on anew, on skin that moves."""
SAID = Conditions.model_validate(
    {"aid": "none", "orthosis": "none", "footwear": "shoes", "speed_instruction": "comfortable"}
)
FIRST_VISIT = datetime(2026, 1, 5, 9, tzinfo=UTC)
BETWEEN_VISITS = timedelta(days=14)
CHRONIC = Person(Population.STROKE_CHRONIC, None, {})


@dataclass(frozen=True)
class Told:
    """What one visit says of walking speed, beside the truth. m/s."""

    speed: float
    metric: Metric


class Coming(PatientWalk):
    """The walk of a person whose body and manner another seed has drawn than the day's randomness."""

    def __init__(self, parameters: WalkParameters, person: int) -> None:
        super().__init__(parameters)
        self.lengths = body_of(replace(parameters, seed=person))
        self.manner = manner(parameters.patient, self.affected, parameters.speed, person)
        self.gait = Gait(*self.lengths)
        legs = self.lengths.thigh + self.lengths.shank
        bouts = self.timeline.bouts
        self.footfalls = plan_footfalls(
            self.manner, parameters.speed, self.lengths.hip_width, legs, bouts, parameters.seed
        )


def measured(person: int, day: int, speed: float, kind: str = "hemiparetic") -> Told:
    """The session of one day through estimation, segmentation and metrics."""
    query = f"patient={kind}&speed={speed:.4f}&seed={day}&affected={('left', 'right')[person % 2]}&{SETTING}"
    identity = Identity("visit", 0, AS_THE_SOURCE_SAYS)
    source = SyntheticSource(Coming(WalkParameters.parse(query), person), identity)
    described: SessionDescription = source.describe()
    chain = build_chain(described)
    told = [message.payload for each in iter_messages(source, TICKS) for message in chain.push(each)]
    metrics = [payload for payload in told if isinstance(payload, SessionMetrics)][-1]
    return Told(speed, next(each for each in metrics.metrics if each.name == "walking_speed"))


def judged(visits: list[Metric]) -> Series:
    """What is said of walking speed over visits two weeks apart, counted from the first."""
    trials = [
        Trial(
            session=f"visit_{number}",
            began=FIRST_VISIT + number * BETWEEN_VISITS,
            task=Task.WALK,
            conditions=SAID,
            walkway_m=None,
            walk_path="turning",
            estimator="rhythmic_ekf",
            sensors=(),
            leg_length_m=None,
            lengths_from="measured",
            datum=None,
            metrics=_only(metric),
        )
        for number, metric in enumerate(visits)
    ]
    ordered = in_visits(trials)
    return progress(ordered, freeze(ordered, None, CHRONIC.population, {}), CHRONIC).series[0]


def _only(metric: Metric) -> SessionMetrics:
    return SessionMetrics(
        captured_ns=0,
        final=True,
        software="bench",
        metrics=[metric],
        curves=[],
        sides=[],
        quality=None,
        phases=[],
        repetitions=[],
    )
