"""The systems and codes that leave: our own for everything, others only where they mean exactly the same."""

from collections.abc import Iterable, Mapping
from enum import StrEnum
from typing import Any, NamedTuple

from schemas.conditions import Footwear, Orthosis, SpeedInstruction, WalkingAid
from schemas.metrics import TrustGrade
from schemas.vocabulary import ESTIMATORS, Side, Task

Json = dict[str, Any]

# No domain belongs to Ambula, so its systems are named by UUIDs, which nobody else has. They never change.
METRICS = "urn:uuid:6d3f4b0e-9a0c-5c55-8a50-0b3a8d4b6f11"
DETAILS = "urn:uuid:2f0f9c1c-7d3b-5f5e-9a67-3c8e5b1f4a22"
PATIENT_CODES = "urn:uuid:c1a7d6f4-3b52-5e0e-8f0b-7a9e2d4c6b33"
SESSION_IDS = "urn:uuid:8e4b2a90-5f1d-5b8c-9c3a-1d6f7e2b5a44"

SNOMED = "http://snomed.info/sct"
LOINC = "http://loinc.org"
CATEGORY = "http://terminology.hl7.org/CodeSystem/observation-category"
ABSENT = "http://terminology.hl7.org/CodeSystem/data-absent-reason"
DIAGNOSTIC_SECTION = "http://terminology.hl7.org/CodeSystem/v2-0074"
OBSERVATION_VALUE = "http://terminology.hl7.org/CodeSystem/v3-ObservationValue"

PROCEDURE = {"system": CATEGORY, "code": "procedure", "display": "Procedure"}
PHYSICAL_THERAPY = {"system": DIAGNOSTIC_SECTION, "code": "PT", "display": "Physical Therapy"}
PSEUDONYMIZED = {"system": OBSERVATION_VALUE, "code": "PSEUDED", "display": "pseudonymized"}

EXACT: Mapping[str, Json] = {
    "walking_speed": {"system": SNOMED, "code": "724237005", "display": "Gait speed"},
    "step_length": {"system": SNOMED, "code": "250000008", "display": "Step length"},
}
"""Metric -> code of a foreign system that was verified and means exactly the same. Left out on purpose: LOINC 89423-8,
whose timed up and go runs from the word go and ours from the first motion; 24-hour walking speeds (LOINC 41957-2 and
its neighbours); 64098-7 for six minutes, of which no text was seen; ROM items of surveys, which are no degrees."""


class Detail(StrEnum):
    """What an Observation says beside its value, by code."""

    METHOD = "method"
    DEVICE_SET = "device_set"
    SOFTWARE = "software"
    CYCLES = "cycles_counted"
    GRADE = "quality_grade"
    AID = "walking_aid"
    LOW = "interval_95_low"
    HIGH = "interval_95_high"
    SPREAD = "standard_deviation"
    CONDITIONS = "test_conditions"
    TASK = "task"
    ORTHOSIS = "orthosis"
    FOOTWEAR = "footwear"
    SPEED = "speed_instruction"
    ASSISTANCE = "physical_assistance"
    PARETIC = "paretic_side"
    WALKWAY = "walkway"
    TIMED_FROM = "timed_from"
    TIMED_TO = "timed_to"
    DURATION = "test_duration"
    SIDE = "side"
    REPORT = "gait_report"
    RECORDING = "recording"
    DEVICE = "device"


class Concept(NamedTuple):
    """One code of our second system and, where it is a question, its answers."""

    code: str
    display: str
    definition: str
    answers: tuple["Concept", ...] = ()


def _answers(question: Detail, words: Iterable[str]) -> tuple[Concept, ...]:
    return tuple(Concept(f"{question}.{word}", word.replace("_", " "), word.replace("_", " ")) for word in words)


_GRADES = {
    TrustGrade.GOOD: "Nothing speaks against the number.",
    TrustGrade.FAIR: "Something speaks against the number; read it with care.",
    TrustGrade.POOR: "Much speaks against the number; do not rest a decision on it alone.",
    TrustGrade.WITHHELD: "What was measured does not carry the number, so there is none.",
}

CONCEPTS: tuple[Concept, ...] = (
    Concept(Detail.METHOD, "method", "The estimator that computed joint angles and events.", tuple(
        Concept(f"{Detail.METHOD}.{name}", name.replace("_", " "), sentence) for name, sentence in ESTIMATORS.items()
    )),
    Concept(Detail.DEVICE_SET, "device set", "Sensors and cameras that the number rests on."),
    Concept(Detail.SOFTWARE, "software", "Name, version and digest of the sources that decide the number."),
    Concept(Detail.CYCLES, "cycles counted", "Number of strides or repetitions that the number rests on."),
    Concept(Detail.GRADE, "quality grade", "How far the number may be relied on.", tuple(
        Concept(f"{Detail.GRADE}.{grade}", grade, sentence) for grade, sentence in _GRADES.items()
    )),
    Concept(Detail.AID, "walking aid", "What the person held on to.", _answers(Detail.AID, WalkingAid)),
    Concept(Detail.LOW, "lower end of the 95 % interval", "Lower end of the 95 % interval of the value."),
    Concept(Detail.HIGH, "upper end of the 95 % interval", "Upper end of the 95 % interval of the value."),
    Concept(Detail.SPREAD, "standard deviation", "Standard deviation over the strides or repetitions."),
    Concept(Detail.CONDITIONS, "test conditions", "How the test was done; results are compared only where all agree."),
    Concept(Detail.TASK, "task", "What the person was asked to do.", _answers(Detail.TASK, Task)),
    Concept(Detail.ORTHOSIS, "orthosis", "What held a leg.", _answers(Detail.ORTHOSIS, Orthosis)),
    Concept(Detail.FOOTWEAR, "footwear", "What was on the feet.", _answers(Detail.FOOTWEAR, Footwear)),
    Concept(Detail.SPEED, "speed instruction", "How fast the person was asked to walk.",
            _answers(Detail.SPEED, SpeedInstruction)),
    Concept(Detail.ASSISTANCE, "physical assistance", "Somebody held or supported the person."),
    Concept(Detail.PARETIC, "paretic side", "The more affected side."),
    Concept(Detail.WALKWAY, "walkway", "From the start to the turning point, or to the end where nobody turns."),
    Concept(Detail.TIMED_FROM, "timed zone from", "From the start of the walkway to where the timed zone begins."),
    Concept(Detail.TIMED_TO, "timed zone to", "From the start of the walkway to where the timed zone ends."),
    Concept(Detail.DURATION, "test duration", "How long a walk for time lasts."),
    Concept(Detail.SIDE, "side", "The leg that a number is about.", _answers(Detail.SIDE, Side)),
    Concept(Detail.REPORT, "movement report", "Results of one session."),
    Concept(Detail.RECORDING, "recording", "The samples and everything computed from them, as MCAP files."),
    Concept(Detail.DEVICE, "kind of device", "What measures or computes.",
            _answers(Detail.DEVICE, ("device_set", "inertial_sensor", "depth_camera", "software"))),
)  # fmt: skip

DISPLAYS: dict[str, str] = {
    concept.code: concept.display for top in CONCEPTS for concept in (top, *top.answers)
}  # fmt: skip
"""Every code of DETAILS -> its display."""


def detail(code: str) -> Json:
    """A CodeableConcept of our second system. Raises KeyError for a code that it does not have."""
    return {"coding": [{"system": DETAILS, "code": str(code), "display": DISPLAYS[code]}]}


def answer(question: Detail, word: str) -> Json:
    """One of the answers of a question."""
    return detail(f"{question}.{word}")


def metric_code(name: str) -> Json:
    """Our own code of a metric, first, then the exact code of another system where there is one."""
    display = name.replace("_", " ")
    own = {"system": METRICS, "code": name, "display": display}
    return {"coding": [own, EXACT[name]] if name in EXACT else [own], "text": display}
