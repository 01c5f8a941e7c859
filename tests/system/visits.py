"""Visits of a made-up patient, put into a gateway's database as its keeper would: no walk has to be waited for."""

import math
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path

from schemas.conditions import Conditions, WalkingAid
from schemas.gait import CURVE_POINTS
from schemas.metrics import MeanCurve, Metric, SessionMetrics, SideComparison, TrustGrade
from schemas.population import Population, Sex
from schemas.session import Anthropometry, HubDescription, Placement, SensorDescription, SessionDescription
from schemas.vocabulary import Segment, Side, Task
from services.gateway.access.scope import EVERYTHING, Scope
from services.gateway.database import Database, open_database
from services.gateway.patients.models import PatientIn
from services.gateway.patients.records import add_patient
from services.gateway.sessions.records import record_metrics, record_start
from services.gateway.settings import GatewaySettings

FIRST_DAY = datetime(2026, 9, 7, 9, 30, tzinfo=UTC)
DAYS_BETWEEN = 14
WORN = (Segment.PELVIS, Segment.THIGH_LEFT, Segment.SHANK_LEFT, Segment.THIGH_RIGHT, Segment.SHANK_RIGHT)
SPREAD = [0.05] * CURVE_POINTS
SAID = Conditions.model_validate(
    {
        "paretic_side": Side.LEFT,
        "aid": "cane",
        "orthosis": "none",
        "footwear": "shoes",
        "physical_assistance": False,
        "speed_instruction": "comfortable",
    }
)


def seed_visits(data: Path, speeds: Sequence[float], aids: Sequence[str]) -> tuple[str, list[str]]:
    """A patient with one walk per visit, two weeks apart, at these speeds in m/s and with these aids; their code and
    the sessions in order."""
    database = open_database(GatewaySettings(data_dir=data, database="").database_url)
    try:
        person = PatientIn(
            year_of_birth=1957, sex=Sex.FEMALE, population=Population.STROKE_CHRONIC, paretic_side=Side.LEFT
        )
        with database.transaction(Scope("main")) as records:
            code = add_patient(records, person).code
        sessions = [
            _seed_walk(database, code, place, speed, SAID.model_copy(update={"aid": WalkingAid(aid)}))
            for place, (speed, aid) in enumerate(zip(speeds, aids, strict=True))
        ]
        return code, sessions
    finally:
        database.close()


def _seed_walk(database: Database, code: str, place: int, speed: float, conditions: Conditions) -> str:
    began = FIRST_DAY + timedelta(days=DAYS_BETWEEN * place)
    session = f"walk{place + 1}"
    with database.transaction(EVERYTHING) as records:
        row = record_start(records, _description(session, began, conditions), "main")
        row.patient_code = code
        records.flush()
        record_metrics(records, session, _metrics(speed))
    return session


def _description(session: str, began: datetime, conditions: Conditions) -> SessionDescription:
    sensors = [
        SensorDescription(
            name=f"imu_{segment}", segment=segment, rate_hz=100.0, outward_axis=[0.0, 0.0, 1.0],
            placement=Placement.LATERAL, position_in_segment=None,
        )
        for segment in WORN
    ]  # fmt: skip
    body = Anthropometry(
        height_m=1.75, mass_kg=70.0, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="default"
    )
    return SessionDescription.model_validate(
        {
            "session": session,
            "title": "Walk along the corridor",
            "started_unix_ns": round(began.timestamp() * 1e9),
            "origin": "synthetic",
            "protocol": "walk",
            "task": Task.WALK,
            "conditions": conditions,
            "estimator": "rhythmic_ekf",
            "walk_path": "turning",
            "hubs": [HubDescription(name="hub", sensors=sensors)],
            "anthropometry": body,
            "standing": [],
            "reference": [],
            "duration_s": 60.0,
        }
    )


def _metrics(speed: float) -> SessionMetrics:
    stride_s = 1.6 - 0.5 * speed
    step_m = speed * stride_s / 2
    numbers = [
        _metric("walking_speed", None, "m/s", speed, 0.01),
        _metric("cadence", None, "steps/min", 120 / stride_s, 0.6),
        _metric("stride_length", None, "m", 2 * step_m, 0.02),
        *(_metric("step_length", side, "m", step_m * (1 + _lead(side)), 0.01) for side in Side),
        *(_metric("stance_fraction", side, "1", 0.66 - 0.05 * speed - _lead(side) / 2, 0.004) for side in Side),
        *(_metric("knee_flexion_range", side, "rad", 0.9 - 2 * _lead(side), 0.02) for side in Side),
        *(_metric("strides_counted", side, "1", 24.0, None) for side in Side),
    ]
    curves = [
        MeanCurve(
            degree_of_freedom=f"{joint}_{side}", strides=24, mean=_curve(joint, side), spread=[0.05] * CURVE_POINTS
        )
        for joint in ("hip_flexion", "knee_flexion")
        for side in Side
    ]
    knee = SideComparison(
        joint="knee_flexion", reference_side=Side.RIGHT, rmse=0.35 - 0.2 * speed, rmse_std=0.01, rmse_about_mean=0.2,
        shift=0.02, strides=24,
    )  # fmt: skip
    return SessionMetrics.model_validate(
        {
            "captured_ns": 60_000_000_000,
            "final": True,
            "metrics": numbers,
            "curves": curves,
            "sides": [knee],
            "software": "ambula 0.1.0",
        }
    )


def _lead(side: Side) -> float:
    return 0.06 if side is Side.LEFT else -0.06


def _metric(name: str, side: Side | None, unit: str, value: float, half: float | None) -> Metric:
    ends = {"low": None, "high": None} if half is None else {"low": value - half, "high": value + half}
    return Metric.model_validate(
        {
            "name": name,
            "side": side,
            "unit": unit,
            "value": value,
            "spread": half and 2 * half,
            "mean_std": half and half / 2,
            "strides": 24,
            "grade": TrustGrade.GOOD,
            "withheld_because": None,
            **ends,
        }
    )


def _curve(joint: str, side: Side) -> list[float]:
    bend = 0.8 if side is Side.LEFT else 1.0
    phases = [2 * math.pi * percent / (CURVE_POINTS - 1) for percent in range(CURVE_POINTS)]
    if joint == "hip_flexion":
        return [0.15 + 0.35 * bend * math.cos(phase) for phase in phases]
    return [bend * (0.45 - 0.4 * math.cos(phase - 2.6) + 0.15 * math.cos(2 * phase - 1)) for phase in phases]
