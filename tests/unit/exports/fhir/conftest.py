"""A made-up session with everything a bundle can say, names that must not leave, and a number that was withheld."""

from dataclasses import replace
from datetime import UTC, datetime

import pytest

from schemas.metrics import Metric, SessionMetrics
from schemas.population import Sex
from schemas.session import (
    Anthropometry,
    CameraDescription,
    HubDescription,
    Placement,
    SensorDescription,
    SessionDescription,
)
from schemas.vocabulary import CameraKind, Segment
from services.definitions.table import DEFINITIONS
from services.exports.fhir.source import FhirSource, PrintedReport, Recorded, Subject

TITLE, HUB, SENSOR, CAMERA = "Walk of Erika Mustermann", "ward 3 east", "Erika's left shank", "Dr Who's camera"
SECRETS = (TITLE, HUB, SENSOR, CAMERA, "Mustermann")
PDF = b"%PDF-1.7\n% a report\n%%EOF\n"
BEGAN = datetime(2026, 9, 7, 9, 30, tzinfo=UTC)


def metric(name, unit, side=None, **changes):
    fields = {
        "name": name, "side": side, "unit": unit, "value": 0.5, "spread": 0.05, "mean_std": 0.01, "low": 0.48,
        "high": 0.52, "strides": 24, "grade": "good", "doubts": [], "withheld_because": None,
    }  # fmt: skip
    return Metric.model_validate(fields | changes)


@pytest.fixture(scope="session")
def withheld():
    doubt = {"kind": "not_observed", "value": None, "limit": None, "subject": SENSOR}
    return metric(
        "step_width", "m", value=None, spread=None, mean_std=None, low=None, high=None, strides=0, grade="withheld",
        doubts=[doubt], withheld_because=f"{SENSOR} and {CAMERA} did not tell it",
    )  # fmt: skip


@pytest.fixture(scope="session")
def results(withheld):
    """Every number that there is, each side its own."""
    numbers = [
        metric(each.name, each.unit, side)
        for each in DEFINITIONS
        for side in (("left", "right") if each.per_side else (None,))
        if each.name != "step_width"
    ]
    return SessionMetrics.model_validate(
        {"captured_ns": 60_000_000_000, "final": True, "software": "ambula 0.1.0+1f2e3d4c", "curves": [],
         "metrics": [*numbers, withheld]}
    )  # fmt: skip


@pytest.fixture(scope="session")
def description():
    sensors = [
        SensorDescription(
            name=name, segment=segment, rate_hz=100.0, outward_axis=[0.0, 0.0, 1.0], placement=Placement.LATERAL,
            position_in_segment=None,
        )
        for name, segment in ((SENSOR, Segment.SHANK_LEFT), ("pelvis", Segment.PELVIS))
    ]  # fmt: skip
    conditions = {
        "paretic_side": "left", "aid": "cane", "orthosis": "ankle_foot", "physical_assistance": False,
        "speed_instruction": "comfortable", "timed_from_m": 2.0, "timed_to_m": 8.0, "test_duration_s": 360.0,
    }  # fmt: skip
    camera = CameraDescription(name=CAMERA, kind=CameraKind.KINECT_V2, rate_hz=30.0, joints=[], floor_m=None)
    body = Anthropometry(
        height_m=1.75, mass_kg=70.0, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="default"
    )
    return SessionDescription.model_validate(
        {
            "session": "8d0c2a71f04be655", "title": TITLE, "started_unix_ns": round(BEGAN.timestamp() * 1e9),
            "origin": "recording", "protocol": f"protocol of {TITLE}", "estimator": "rhythmic_ekf", "task": "walk",
            "walkway_m": 10.0, "conditions": conditions, "hubs": [HubDescription(name=HUB, sensors=sensors)],
            "cameras": [camera], "anthropometry": body, "standing": [], "reference": [], "duration_s": 60.0,
        }
    )  # fmt: skip


@pytest.fixture(scope="session")
def source(description, results):
    return FhirSource(
        description=description,
        metrics=results,
        began=BEGAN,
        subject=Subject("K7QM3F", 1957, Sex.FEMALE),
        report=PrintedReport(PDF, "en"),
        recording=Recorded("https://site.example/v1/sessions/8d0c2a71f04be655/recordings", "ab" * 32),
    )


@pytest.fixture
def changed(source):
    """The source with other fields."""
    return lambda **fields: replace(source, **fields)


@pytest.fixture(scope="session")
def secrets():
    return SECRETS


@pytest.fixture
def of_kind():
    """Resources of a type in a bundle."""
    return lambda made, kind: [each["resource"] for each in made["entry"] if each["resource"]["resourceType"] == kind]
