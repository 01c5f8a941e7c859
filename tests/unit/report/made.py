"""A made-up session for reports: plain values, no chain."""

import math
from datetime import UTC, date, datetime

from schemas.conditions import UNSAID, Conditions
from schemas.gait import CURVE_POINTS
from schemas.kinematics import Calibration
from schemas.metrics import Doubt, DoubtKind, MeanCurve, Metric, SessionMetrics, SideComparison, TrustGrade
from schemas.population import Population, Sex
from schemas.session import Anthropometry, HubDescription, Placement, SensorDescription, SessionDescription
from schemas.tasks import Repetition, TaskPhase
from schemas.vocabulary import TASK_PHASES, Segment, Side, Task
from services.progress.rules import Rule, RuleCode, Verdict, rule
from services.report.source import (
    CurveDistance,
    JointChange,
    MeasureProgress,
    Patient,
    Progress,
    ReferenceOrigin,
    ReferenceRange,
    ReportSource,
    Treatment,
    VisitValue,
)

WORN = (Segment.PELVIS, Segment.THIGH_LEFT, Segment.SHANK_LEFT, Segment.THIGH_RIGHT, Segment.SHANK_RIGHT)
DATUM = "quiet standing: pelvis level, thighs and shanks vertical, feet flat"
SAID = Conditions.model_validate(
    {"paretic_side": "left", "aid": "cane", "orthosis": "none", "footwear": "shoes", "speed_instruction": "comfortable"}
)
BEGAN = datetime(2026, 11, 9, 9, 30, tzinfo=UTC)
FIRST = date(2026, 9, 7)


def metric(name, value, unit, side=None, **changes) -> Metric:
    spread = None if value is None else abs(value) / 20
    fields = {
        "name": name, "side": side, "unit": unit, "value": value, "spread": spread, "mean_std": spread,
        "low": None if value is None else value - 0.04, "high": None if value is None else value + 0.04,
        "strides": 40, "grade": TrustGrade.GOOD if value is not None else TrustGrade.WITHHELD, "doubts": [],
        "withheld_because": None if value is not None else "too few strides",
    }  # fmt: skip
    return Metric(**(fields | changes))


def described(task=Task.WALK, conditions=SAID, **changes) -> SessionDescription:
    sensors = [
        SensorDescription(
            name=f"imu_{segment}", segment=segment, rate_hz=100.0, outward_axis=[0.0, 0.0, 1.0],
            placement=Placement.LATERAL, position_in_segment=None, upward_axis=None,
        )
        for segment in WORN
    ]  # fmt: skip
    body = Anthropometry(
        height_m=1.7, mass_kg=70.0, thigh_length_m=0.42, shank_length_m=0.41, hip_width_m=0.18, source="default"
    )
    fields = {
        "session": "8d0c2a71f04be655", "title": "Walk", "started_unix_ns": int(BEGAN.timestamp()) * 10**9,
        "origin": "synthetic", "protocol": "walk", "task": task, "walkway_m": None, "conditions": conditions,
        "estimator": "rhythmic_ekf", "walk_path": "turning", "hubs": [HubDescription(name="hub", sensors=sensors)],
        "cameras": [], "anthropometry": body, "standing": [], "reference": [], "duration_s": 60.0, "known_rhythms": [],
    }  # fmt: skip
    return SessionDescription(**(fields | changes))


def walk_metrics(**values) -> list[Metric]:
    few = Doubt(kind=DoubtKind.FEW_CYCLES, value=4.0, limit=10.0, subject=None)
    both = [
        metric(name, value * (1.0 if side is Side.LEFT else 1.2), unit, side)
        for name, value, unit in (
            ("step_length", 0.5, "m"), ("stance_fraction", 0.6, "1"), ("knee_flexion_peak_swing", 0.8, "rad"),
            ("knee_flexion_range", 0.9, "rad"), ("hip_rotation_range", 0.1, "rad"), ("circumduction", 0.03, "m"),
            ("strides_counted", 20, "1"), ("strides_turning", 2, "1"), ("strides_rejected", 1, "1"),
            ("strides_starting_or_stopping", 2, "1"),
        )
        for side in Side
    ]  # fmt: skip
    return [
        metric("walking_speed", values.get("speed", 0.76), "m/s"),
        metric("cadence", 93.0, "steps/min"),
        metric("stride_length", 0.98, "m"),
        metric("double_support_fraction", 0.33, "1", grade=TrustGrade.POOR),
        metric("stride_time_cv", None, "1", strides=4, doubts=[few]),
        metric("step_length_ratio_paretic_to_non_paretic", 0.83, "1"),
        *both,
    ]


def curves() -> list[MeanCurve]:
    names = ["pelvis_tilt", *(f"{joint}_flexion_{side}" for joint in ("hip", "knee") for side in Side)]
    wave = [0.4 + 0.3 * math.sin(2 * math.pi * k / (CURVE_POINTS - 1)) for k in range(CURVE_POINTS)]
    return [
        MeanCurve(
            degree_of_freedom=name, strides=20, mean=[value + 0.02 * i for value in wave], spread=[0.05] * CURVE_POINTS
        )
        for i, name in enumerate(names)
    ]  # fmt: skip


def session_metrics(*metrics, **changes) -> SessionMetrics:
    sides = [
        SideComparison(
            joint="knee_flexion", reference_side=Side.RIGHT, rmse=0.2, rmse_std=0.02, rmse_about_mean=0.15, shift=0.02,
            strides=20,
        )
    ]  # fmt: skip
    fields = {
        "captured_ns": 60_000_000_000, "final": True, "software": "ambula 0.1.0+0a1b2c3d",
        "metrics": list(metrics) or walk_metrics(), "curves": curves(), "sides": sides, "quality": None, "phases": [],
        "repetitions": [],
    }  # fmt: skip
    return SessionMetrics(**(fields | changes))


def tug_phases() -> list[TaskPhase]:
    phases, at = [], 5_000_000_000
    for kind in TASK_PHASES[Task.TIMED_UP_AND_GO]:
        end = at + 2_100_000_000
        phases.append(
            TaskPhase(
                task=Task.TIMED_UP_AND_GO, attempt=0, phase=kind, start_ns=at, start_std_s=0.04, end_ns=end,
                end_std_s=0.05, largest_turn_rate=None, largest_thigh_rate=None, steps=None, distance_m=None,
                distance_std_m=None,
            )
        )  # fmt: skip
        at = end
    return phases


def knee_repetitions() -> list[Repetition]:
    return [
        Repetition(
            degree_of_freedom="knee_flexion_left", side=Side.LEFT, index=k, start_ns=k * 10**9, turn_ns=k * 10**9 + 1,
            end_ns=k * 10**9 + 2, start_angle=0.1, turn_angle=1.5, end_angle=0.1, angle_std=0.02, largest_velocity=2.0,
            hold_s=None, ranges={}, valid=k != 2, rejected_because="samples are missing" if k == 2 else None,
        )
        for k in range(5)
    ]  # fmt: skip


def measure(
    name="walking_speed", side=None, unit="m/s", values=(0.5, 0.6, 0.76), verdict=Verdict.REAL_CHANGE, mdc=0.15
):
    def visit(k, value) -> VisitValue:
        change = None if k == 0 else value - values[0]
        numbers = {"change": value - values[0], "low": 0.2, "high": 0.3, "mdc": mdc, "limit": mdc}
        rules = (Rule(RuleCode.CHANGE_BEYOND_MDC, numbers),)
        word = Verdict.CANNOT_TELL if k == 0 else verdict
        return VisitValue(k + 1, FIRST.replace(day=7 + 7 * k), value, value - 0.03, value + 0.03, change, word, rules)

    visits = tuple(visit(k, value) for k, value in enumerate(values))
    return MeasureProgress(
        name, side, unit, visits, values[0], mdc, "chronic stroke, n=76", "Lewek 2019, S-EPMC6361716", ()
    )


def progress(*measures, **changes) -> Progress:
    fields = {
        "visit": 3, "baseline_visit": 1, "baseline_day": FIRST, "measures": measures or (measure(),),
        "treatments": (Treatment(date(2026, 9, 10), "gait_training"),),
        "distances": (CurveDistance(3, Side.LEFT, None, {"knee_flexion": 0.1}),),
        "joints": (JointChange("knee_flexion", "recovery", (rule(RuleCode.SPEED_UP_SIDES_CLOSER, 0.26, -0.05),)),),
    }  # fmt: skip
    return Progress(**(fields | changes))


def speed_reference(low=1.0, high=1.5) -> ReferenceRange:
    origin = ReferenceOrigin("mobbs_2025", "1", "Mobbs 2025, Sensors 25(2):581", None, 41.0, 50.999, Sex.MALE)
    return ReferenceRange("walking_speed", None, low, high, "from_sd", origin)


def source(**changes) -> ReportSource:
    calibration = Calibration(
        model="lower_body", estimator="rhythmic_ekf", method="standing", datum=DATUM, quality=1.0, sensors=[],
        events_from={}, unused={}, misplaced={}, lengths={}, absolute=True,
    )  # fmt: skip
    fields = {
        "description": described(), "metrics": session_metrics(), "calibration": calibration, "began": BEGAN,
        "patient": Patient("K7QM3F", 1957, Sex.FEMALE, Population.STROKE_CHRONIC), "progress": None, "references": (),
        "reference_curves": (), "reference_gaps": (), "installed_sets": ("mobbs_2025 1",),
        "recording_sha256": "0123456789abcdef" * 4, "strides": (),
    }  # fmt: skip
    return ReportSource(**(fields | changes))


def unsaid() -> ReportSource:
    return source(description=described(conditions=UNSAID), patient=None, calibration=None, installed_sets=())
