"""One Observation for each number of a session, and one for how the test was done."""

from schemas.metrics import DoubtKind, Metric
from schemas.vocabulary import ESTIMATORS
from services.definitions.table import BY_NAME
from services.exports.fhir.codes import ABSENT, PROCEDURE, Detail, Json, answer, detail, metric_code
from services.exports.fhir.people_and_devices import device_set
from services.exports.fhir.resources import ended, instant, reference, resource_id, without_names
from services.exports.fhir.source import FhirSource
from services.exports.fhir.units import quantity

ABSENT_DISPLAY = {"unsupported": "Unsupported", "unknown": "Unknown"}


def metric_observations(source: FhirSource, shared: Json) -> list[Json]:
    """Of every number that is defined and does not only say another one again.

    `shared`: subject, device, derivedFrom.
    """
    said_of_all = _said_of_all(source)
    return [
        _observation(source, metric, shared, said_of_all) for metric in source.metrics.metrics if _leaves(metric)
    ]  # fmt: skip


def _leaves(metric: Metric) -> bool:
    """A name or unit of another Ambula, that our CodeSystem does not have, would be a code without a meaning."""
    definition = BY_NAME.get(metric.name)
    return definition is not None and not definition.export_only and metric.unit == definition.unit


def _observation(source: FhirSource, metric: Metric, shared: Json, said_of_all: list[Json]) -> Json:
    resource = begun(source, metric_code(metric.name), shared, "metric", metric.name, metric.side or "")
    if metric.side is not None:
        resource["bodySite"] = answer(Detail.SIDE, metric.side)
    if metric.value is None:
        resource["dataAbsentReason"] = _absent(source, metric)
    else:
        resource["valueQuantity"] = quantity(metric.value, metric.unit)
    return resource | {"component": [*_said_of_one(metric), *said_of_all]}


def begun(source: FhirSource, code: Json, shared: Json, *words: str) -> Json:
    """An Observation up to its value."""
    at = instant(ended(source))
    return {
        "resourceType": "Observation",
        "id": resource_id(source.description.session, *words),
        "status": "final" if source.metrics.final else "preliminary",
        "category": [{"coding": [PROCEDURE]}],
        "code": code,
        "effectivePeriod": {"start": instant(source.began), "end": at},
        "issued": at,
        **shared,
    }


def _absent(source: FhirSource, metric: Metric) -> Json:
    """Why there is no number: the sensors worn cannot tell it, or what they told does not carry it."""
    unseen = any(doubt.kind is DoubtKind.NOT_OBSERVED for doubt in metric.doubts)
    code = "unsupported" if unseen else "unknown"
    because = without_names(metric.withheld_because or "withheld", source.description)
    return {"coding": [{"system": ABSENT, "code": code, "display": ABSENT_DISPLAY[code]}], "text": because}


def _said_of_one(metric: Metric) -> list[Json]:
    said = [
        component(Detail.CYCLES, valueInteger=metric.strides),
        component(Detail.GRADE, valueCodeableConcept=answer(Detail.GRADE, metric.grade)),
    ]
    for question, value in ((Detail.LOW, metric.low), (Detail.HIGH, metric.high), (Detail.SPREAD, metric.spread)):
        if value is not None:
            said.append(component(question, valueQuantity=quantity(value, metric.unit)))
    return said


def _said_of_all(source: FhirSource) -> list[Json]:
    """Method, devices, software and aid: the same for every number of a session, and never taken apart from it."""
    description = source.description
    return [
        _asked(Detail.METHOD, description.estimator if description.estimator in ESTIMATORS else None),
        component(Detail.DEVICE_SET, valueString=device_set(source)),
        component(Detail.SOFTWARE, valueString=source.metrics.software),
        _asked(Detail.AID, description.conditions.aid),
    ]


def conditions_observation(source: FhirSource, shared: Json) -> Json:
    """How the test was done."""
    about, asked = source.description, source.description.conditions
    distances = (
        (Detail.WALKWAY, about.walkway_m),
        (Detail.TIMED_FROM, asked.timed_from_m),
        (Detail.TIMED_TO, asked.timed_to_m),
    )
    said = [
        component(Detail.TASK, valueCodeableConcept=answer(Detail.TASK, about.task)),
        _asked(Detail.AID, asked.aid),
        _asked(Detail.ORTHOSIS, asked.orthosis),
        _asked(Detail.FOOTWEAR, asked.footwear),
        _asked(Detail.SPEED, asked.speed_instruction),
    ]
    if asked.paretic_side is not None:
        paretic = answer(Detail.SIDE, asked.paretic_side)
        said.append(component(Detail.PARETIC, valueCodeableConcept=paretic))
    if asked.physical_assistance is not None:
        said.append(component(Detail.ASSISTANCE, valueBoolean=asked.physical_assistance))
    said += [component(code, valueQuantity=quantity(metres, "m")) for code, metres in distances if metres is not None]
    if asked.test_duration_s is not None:
        said.append(component(Detail.DURATION, valueQuantity=quantity(asked.test_duration_s, "s")))
    return begun(source, detail(Detail.CONDITIONS), shared, "conditions") | {"component": said}


def component(question: Detail, **value: object) -> Json:
    """One thing that is said beside the value."""
    return {"code": detail(question), **value}


def _asked(question: Detail, word: str | None) -> Json:
    """What nobody said is said to be unknown."""
    if word is None:
        reason = {"coding": [{"system": ABSENT, "code": "unknown", "display": ABSENT_DISPLAY["unknown"]}]}
        return component(question, dataAbsentReason=reason)
    return component(question, valueCodeableConcept=answer(question, word))


def shared_by_all(subject: Json | None, devices: list[Json], recording: Json | None) -> Json:
    """Whom every Observation is about, what measured it and what it was computed from."""
    shared: Json = {} if subject is None else {"subject": reference(subject)}
    shared["device"] = reference(devices[0])
    return shared if recording is None else shared | {"derivedFrom": [reference(recording)]}
