"""Our two CodeSystems, from the definitions of the metrics and from what is said beside them."""

from collections.abc import Callable

from services.definitions.definition import Definition
from services.definitions.table import DEFINITIONS
from services.exports.fhir.codes import CONCEPTS, DETAILS, METRICS, Concept, Json
from services.exports.fhir.units import UNITS
from services.flow.software import VERSION


def metrics_code_system() -> Json:
    """Every metric: name, definition, UCUM unit, whether each leg has its own."""
    properties = [
        {"code": "unit", "description": "UCUM unit of the value as it leaves", "type": "string"},
        {"code": "perSide", "description": "each leg has its own, told by bodySite", "type": "boolean"},
    ]
    concepts = [_metric(definition) for definition in DEFINITIONS]
    return _code_system("metrics", METRICS, "Metrics of Ambula", concepts) | {"property": properties}


def details_code_system() -> Json:
    """What an Observation says beside its value: questions, and below them their answers."""
    concepts = [_concept(each) for each in CONCEPTS]
    system = _code_system("details", DETAILS, "Details of measurements of Ambula", concepts)
    return system | {"hierarchyMeaning": "grouped-by"}


CODE_SYSTEMS: dict[str, Callable[[], Json]] = {"metrics": metrics_code_system, "details": details_code_system}
"""By the name under which the gateway gives them."""


def _code_system(name: str, url: str, title: str, concepts: list[Json]) -> Json:
    return {
        "resourceType": "CodeSystem",
        "id": name,
        "url": url,
        "version": VERSION,
        "name": "Ambula" + name.capitalize(),
        "title": title,
        "status": "active",
        "experimental": True,
        "description": "Research software, not a medical device.",
        "caseSensitive": True,
        "compositional": False,
        "versionNeeded": False,
        "content": "complete",
        "count": sum(1 + len(concept.get("concept", [])) for concept in concepts),
        "concept": concepts,
    }


def _metric(definition: Definition) -> Json:
    return {
        "code": definition.name,
        "display": definition.name.replace("_", " "),
        "definition": definition.sentence,
        "property": [
            {"code": "unit", "valueString": UNITS[definition.unit].code},
            {"code": "perSide", "valueBoolean": definition.per_side},
        ],
    }


def _concept(concept: Concept) -> Json:
    said: Json = {"code": str(concept.code), "display": concept.display, "definition": concept.definition}
    return said | {"concept": [_concept(each) for each in concept.answers]} if concept.answers else said
