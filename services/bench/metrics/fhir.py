"""FHIR: whether bundles of every kind of session are valid, by our own check and a foreign one; what they weigh."""

import json
import time
from collections.abc import Callable
from typing import Any

from services.bench.metrics.report_patient import PATIENT, WALKS, Visited, report_of
from services.bench.report import Section, Table
from services.bench.scoreboard import Row, at_most, informative
from services.exports.fhir.bundle import bundle
from services.exports.fhir.code_systems import CODE_SYSTEMS
from services.exports.fhir.source import FhirSource, PrintedReport, Recorded, Subject
from services.exports.fhir.validation import problems
from services.report.assemble import make_report
from services.report.content import Language
from services.report.press import Press

KINDS = {
    "walk with a stroke": WALKS[-1],
    "timed up and go": "synthetic:tug?attempts=2&stroll=8&seed=4",
    "knee exercise": "synthetic:knee?seed=2&duration=60",
    "squats before a camera": "synthetic:squat?person=2&repetitions=6",
    "ten-metre walk": "synthetic:ten_metres?seed=7",
}
"""Sources by what is done in them."""
STEPS = len(KINDS)
TYPED = "Walk of Erika Mustermann"
"""Free text as somebody could have typed it; it must not leave."""
RECORDINGS = "https://site.example/v1/sessions/{}/recordings"
NOTE = (
    "fhir: one synthetic session of each kind through the whole chain, its title, protocol and every sensor, hub and "
    "camera renamed to a person's name. Own check: codes, units, references, status, attachments and that name. "
    "Foreign check: the R4B models of the package fhir.resources, which is in the group dev."
)


def fhir_section(advance: Callable[[], None]) -> Section:
    """All of it."""
    press, foreign = Press(), _Foreign()
    rows, lines = [], []
    own_faults, foreign_faults, slowest_ms = 0, 0, 0.0
    for number, (kind, spec) in enumerate(KINDS.items()):
        source, typed = _source(spec, number, press)
        start = time.perf_counter()
        made = bundle(source)
        spent_ms = (time.perf_counter() - start) * 1e3
        slowest_ms = max(slowest_ms, spent_ms)
        faults = problems(made, typed)
        own_faults += len(faults)
        foreign_faults += foreign("Bundle", made)
        lines.append(_line(kind, made, source, spent_ms, len(faults)))
        advance()
    systems = [make() for make in CODE_SYSTEMS.values()]
    foreign_faults += sum(foreign("CodeSystem", system) for system in systems)
    rows.append(at_most("FHIR: faults by our own check", own_faults, "", 0))
    rows.append(
        at_most("FHIR: resources that fhir.resources refuses", foreign_faults, "", 0)
        if foreign.there
        else Row("FHIR: resources that fhir.resources refuses", None, "", "pip install fhir.resources", None, None)
    )
    rows += _sizes(lines, slowest_ms)
    header = ("session", "Observations", "withheld", "kB without PDF", "kB with PDF", "ms", "faults")
    return Section("FHIR", [NOTE], rows, [Table("FHIR bundles", header, [[*map(str, line)] for line in lines])])


class _Foreign:
    """The package's models; counts what they refuse."""

    def __init__(self) -> None:
        try:
            from fhir.resources.R4B.bundle import Bundle
            from fhir.resources.R4B.codesystem import CodeSystem
        except ImportError:
            self._models: dict[str, Any] = {}
        else:
            self._models = {"Bundle": Bundle, "CodeSystem": CodeSystem}

    @property
    def there(self) -> bool:
        """Whether the package is installed."""
        return bool(self._models)

    def __call__(self, kind: str, resource: dict[str, Any]) -> int:
        if not self.there:
            return 0
        try:
            self._models[kind].model_validate(resource)
        except ValueError:
            return 1
        return 0


def _source(spec: str, number: int, press: Press) -> tuple[FhirSource, list[str]]:
    """A session with its printed report, and all that somebody could have typed into it."""
    visit = Visited(spec, number)
    hubs = [
        hub.model_copy(
            update={
                "name": f"{TYPED}'s hub",
                "sensors": [
                    sensor.model_copy(update={"name": f"{TYPED} {place}"}) for place, sensor in enumerate(hub.sensors)
                ],
            }
        )
        for hub in visit.description.hubs
    ]
    cameras = [camera.model_copy(update={"name": f"{TYPED}'s camera"}) for camera in visit.description.cameras]
    renamed = {"title": TYPED, "protocol": TYPED, "hubs": hubs, "cameras": cameras}
    report = report_of(visit)
    pdf = press.pdf(make_report(report, Language.ENGLISH))
    source = FhirSource(
        description=visit.description.model_copy(update=renamed),
        metrics=report.metrics,
        began=visit.began,
        subject=Subject(PATIENT.code, PATIENT.year_of_birth, PATIENT.sex),
        report=PrintedReport(pdf, Language.ENGLISH),
        recording=Recorded(RECORDINGS.format(visit.description.session), None),
    )
    return source, [TYPED, "Mustermann"]


def _line(kind: str, made: dict[str, Any], source: FhirSource, spent_ms: float, faults: int) -> list[Any]:
    observations = [entry["resource"] for entry in made["entry"] if entry["resource"]["resourceType"] == "Observation"]
    withheld = sum("dataAbsentReason" in each for each in observations)
    whole = len(json.dumps(made)) / 1e3
    assert source.report is not None
    attached = (len(source.report.pdf) + 2) // 3 * 4 / 1e3
    return [kind, len(observations), withheld, round(whole - attached), round(whole), round(spent_ms, 1), faults]


def _sizes(lines: list[list[Any]], slowest_ms: float) -> list[Row]:
    return [
        informative("FHIR: largest bundle without PDF", max(line[3] for line in lines), "kB"),
        informative("FHIR: largest bundle with PDF", max(line[4] for line in lines), "kB"),
        informative("FHIR: time to make the slowest bundle, PDF printed", slowest_ms, "ms"),
    ]
