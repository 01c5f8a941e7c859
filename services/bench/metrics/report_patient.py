"""A synthetic patient who comes several times: what the report of the last visit is made from."""

from datetime import UTC, datetime, timedelta

from schemas.conditions import Conditions
from schemas.kinematics import Calibration
from schemas.metrics import SessionMetrics
from schemas.population import Population, Sex
from schemas.session import SessionDescription
from schemas.vocabulary import Side
from services.cli.assembly import build_chain
from services.ingest.source import iter_messages, open_source
from services.progress.baseline import freeze
from services.progress.progress import Person, ReferenceUse, progress
from services.progress.visits import Trial, in_visits
from services.reference import bands
from services.reference.folders import read_shelf
from services.report.from_progress import progress_of
from services.report.from_reference import references_of
from services.report.source import Patient, Progress, ReportSource, Treatment

FIRST = datetime(2026, 9, 7, 9, 30, tzinfo=UTC)
BETWEEN = timedelta(days=21)
WALKS = (
    "synthetic:walk?patient=hemiparetic&affected=left&speed=0.45&seed=11&duration=60",
    "synthetic:walk?patient=hemiparetic&affected=left&speed=0.5&seed=12&duration=60",
    "synthetic:walk?patient=hemiparetic&affected=left&speed=0.6&seed=13&duration=60",
    "synthetic:walk?patient=hemiparetic&affected=left&speed=0.72&seed=14&duration=60",
)
"""One walk at each visit. The speeds are those that the simulation was given, not what is found."""
SAID = {
    "paretic_side": Side.LEFT, "aid": "cane", "orthosis": "none", "footwear": "shoes", "physical_assistance": False,
    "speed_instruction": "comfortable",
}  # fmt: skip
PATIENT = Patient("K7QM3F", 1957, Sex.FEMALE, Population.STROKE_CHRONIC)
TREATMENTS = ((10, "gait_training"), (35, "botulinum_toxin"))
"""Days after the first visit."""


class Visited:
    """One walk through the whole chain."""

    def __init__(self, spec: str, number: int) -> None:
        source = open_source(spec)
        self.began = FIRST + number * BETWEEN
        own = source.describe()
        said = {name: value for name, value in own.conditions.model_dump().items() if value is not None}
        self.description: SessionDescription = own.model_copy(
            update={
                "session": f"visit{number + 1}",
                "conditions": Conditions.model_validate(SAID | said),
                "started_unix_ns": round(self.began.timestamp() * 1e9),
            }
        )
        chain = build_chain(self.description)
        self.metrics: SessionMetrics | None = None
        self.calibration: Calibration | None = None
        for message in iter_messages(source):
            for produced in chain.push(message):
                if isinstance(produced.payload, SessionMetrics):
                    self.metrics = produced.payload
                elif isinstance(produced.payload, Calibration):
                    self.calibration = produced.payload

    @property
    def trial(self) -> Trial:
        """As progress takes it."""
        body = self.description.anthropometry
        sensors = [f"{each.segment}:{each.placement}" for hub in self.description.hubs for each in hub.sensors]
        return Trial(
            session=self.description.session,
            began=self.began,
            task=self.description.task,
            conditions=self.description.conditions,
            walkway_m=self.description.walkway_m,
            walk_path=self.description.walk_path,
            estimator=self.description.estimator,
            sensors=tuple(sorted(sensors)),
            leg_length_m=body.thigh_length_m + body.shank_length_m,
            lengths_from=body.source,
            datum=None if self.calibration is None else self.calibration.datum,
            metrics=self.metrics,
        )


def walk_visits() -> list[Visited]:
    """All visits of the patient; takes some seconds each."""
    return [Visited(spec, number) for number, spec in enumerate(WALKS)]


def report_of_last(visited: list[Visited]) -> ReportSource:
    """What the report of the last visit is made from."""
    sets = read_shelf([]).sets
    visits = in_visits(each.trial for each in visited)
    uses = {each.manifest.name: ReferenceUse(each.manifest.version, each.measures) for each in sets}
    baseline = freeze(visits, None, PATIENT.population, {name: use.version for name, use in uses.items()})
    told = progress(visits, baseline, Person(PATIENT.population, Side.LEFT, uses))
    treatments = [Treatment((FIRST + timedelta(days=days)).date(), kind) for days, kind in TREATMENTS]
    last = visited[-1]
    return report_of(last, progress_of(last.description.session, visits, told, treatments))


def report_of(visit: Visited, told: Progress | None = None) -> ReportSource:
    """What the report of one session is made from; the recording is none of an archive."""
    assert visit.metrics is not None
    assert PATIENT.year_of_birth is not None
    speed = next((each.value for each in visit.metrics.metrics if each.name == "walking_speed"), None)
    person = bands.Person(float(visit.began.year - PATIENT.year_of_birth), PATIENT.sex, speed)
    datum = None if visit.calibration is None else visit.calibration.datum
    references = references_of(read_shelf([]).sets, visit.metrics, person, datum)
    return ReportSource(
        description=visit.description,
        metrics=visit.metrics,
        calibration=visit.calibration,
        began=visit.began,
        patient=PATIENT,
        progress=told,
        references=references.ranges,
        reference_curves=references.curves,
        reference_gaps=references.gaps,
        installed_sets=references.sets,
        recording_sha256=None,
        strides=(),
    )
