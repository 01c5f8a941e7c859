"""One made-up walk: its description and messages at any time."""

import math

from schemas.gait import CURVE_POINTS, GaitEvent, Stride, StrideCurve
from schemas.kinematics import Calibration, LivePose, SegmentPose, SensorStatus
from schemas.metrics import MeanCurve, Metric, SessionMetrics
from schemas.session import Anthropometry, HubDescription, Placement, SensorDescription, SessionDescription
from schemas.vocabulary import GaitEventKind, Misplacement, Segment, SensorState, Side

WORN = (Segment.PELVIS, Segment.THIGH_LEFT, Segment.SHANK_LEFT, Segment.THIGH_RIGHT, Segment.SHANK_RIGHT)
THIGH_M, SHANK_M, HIPS_M = 0.42, 0.41, 0.18


def describe(session: str, title: str = "Walk", **changes) -> SessionDescription:
    sensors = [
        SensorDescription(
            name=f"imu_{segment}",
            segment=segment,
            rate_hz=100.0,
            outward_axis=[0.0, 0.0, 1.0],
            placement=Placement.LATERAL,
            position_in_segment=None,
        )
        for segment in WORN
    ]
    fields = {
        "session": session,
        "title": title,
        "started_unix_ns": 1_795_000_000_000_000_000,
        "origin": "synthetic",
        "protocol": "walk",
        "estimator": "rhythmic_ekf",
        "walk_path": "turning",
        "hubs": [HubDescription(name="hub", sensors=sensors)],
        "anthropometry": Anthropometry(
            height_m=1.75, mass_kg=70.0, thigh_length_m=THIGH_M, shank_length_m=SHANK_M, hip_width_m=HIPS_M,
            source="default",
        ),
        "standing": [],
        "reference": [],
        "duration_s": 60.0,
    }  # fmt: skip
    return SessionDescription(**(fields | changes))


def leg_angles(at_s: float, side: Side, stride_s: float = 1.1) -> tuple[float, float]:
    """Hip and knee flexion in rad of a made-up walk."""
    phase = 2 * math.pi * (at_s / stride_s + (0.5 if side is Side.RIGHT else 0.0))
    hip = math.radians(12 + 22 * math.cos(phase))
    knee = math.radians(24 - 14 * math.cos(phase - 2.6) * 1.6 + 8 * math.cos(2 * phase - 1.0))
    return hip, max(0.02, knee)


def pose_at(at_s: float, lost: str | None = None, phase: str = "estimating", message: str = "") -> LivePose:
    segments = [
        SegmentPose(segment=Segment.PELVIS, position=[0, 0, 0], quat_world_from_segment=[1, 0, 0, 0], valid=True)
    ]
    angles, stds = {}, {}
    for side, z in ((Side.LEFT, -HIPS_M / 2), (Side.RIGHT, HIPS_M / 2)):
        hip, knee = leg_angles(at_s, side)
        joint = [math.sin(hip) * THIGH_M, -0.05 - math.cos(hip) * THIGH_M, z]
        for name, position, angle in (("thigh", [0.0, -0.05, z], hip), ("shank", joint, hip - knee)):
            quat = [math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)]
            segment = Segment(f"{name}_{side}")
            valid = lost != f"imu_{segment}"
            segments.append(SegmentPose(segment=segment, position=position, quat_world_from_segment=quat, valid=valid))
        if lost != f"imu_shank_{side}":
            angles[f"knee_flexion_{side}"], stds[f"knee_flexion_{side}"] = knee, 0.03
        angles[f"hip_flexion_{side}"], stds[f"hip_flexion_{side}"] = hip, 0.03
    sensors = [
        SensorStatus(
            sensor=f"imu_{segment}",
            state=SensorState.MISSING if lost == f"imu_{segment}" else SensorState.OK,
            since_ns=0,
        )
        for segment in WORN
    ]
    return LivePose(
        captured_ns=round(at_s * 1e9), phase=phase, message=message, notice="", segments=segments, angles=angles,
        angles_std=stds, sensors=sensors, centres={}, cameras=[],
        cadence_per_min=109.0 if phase == "estimating" else None,
        stood=None if phase == "estimating" else 0.5,
    )  # fmt: skip


def calibration_of(misplaced: dict[Side, list[Misplacement]]) -> Calibration:
    return Calibration(
        model="lower_body", estimator="rhythmic_ekf", method="standing", datum="quiet standing", quality=0.8,
        sensors=[], events_from={}, unused={}, misplaced=misplaced, lengths={}, absolute=True,
    )  # fmt: skip


def contact_at(at_s: float, side: Side) -> GaitEvent:
    return GaitEvent(kind=GaitEventKind.INITIAL_CONTACT, side=side, captured_ns=round(at_s * 1e9), time_std_s=0.02)


def stride_at(end_s: float, side: Side, index: int) -> Stride:
    curve = StrideCurve(position=[0.3] * CURVE_POINTS, position_std=0.02)
    return Stride(
        side=side, index=index, start_ns=round((end_s - 1.1) * 1e9), toe_off_ns=round((end_s - 0.4) * 1e9),
        opposite_contact_ns=round((end_s - 0.55) * 1e9), end_ns=round(end_s * 1e9), stride_time_s=1.1,
        stance_fraction=0.62 if side is Side.LEFT else 0.6, step_time_s=0.55,
        step_length_m=0.61 if side is Side.LEFT else 0.58, step_length_std_m=0.02, stride_length_m=1.19,
        walking_speed=1.08, phase_advance=6.28, turning=False, valid=True, rejected_because=None,
        curves={f"knee_flexion_{side}": curve},
    )  # fmt: skip


def metric(name: str, side: str | None, unit: str, value: float | None, spread: float | None = None) -> Metric:
    because = None if value is not None else "2 of at least 3 strides"
    return Metric(
        name=name, side=side, unit=unit, value=value, spread=spread, mean_std=None, strides=12, withheld_because=because
    )


def metrics_at(at_s: float, final: bool) -> SessionMetrics:
    per_side = [
        ("step_length", "m", 0.61, 0.02), ("stance_fraction", "1", 0.62, 0.01), ("step_time", "s", 0.55, 0.01),
        ("knee_flexion_range", "rad", 1.02, 0.04), ("hip_flexion_range", "rad", 0.78, 0.03),
        ("strides_counted", "1", 12, None),
    ]  # fmt: skip
    numbers = [
        metric("walking_speed", None, "m/s", 1.08, 0.03),
        metric("cadence", None, "steps/min", 109.1, 1.4),
        metric("stride_length", None, "m", None),
        metric("stride_time", None, "s", 1.1, 0.01),
        metric("step_length_ratio_larger_to_smaller", None, "1", 1.05),
        metric("stride_time_cv", None, "1", 0.018),
        *(metric(name, side, unit, value, spread) for name, unit, value, spread in per_side for side in Side),
    ]
    curves = [
        MeanCurve(
            degree_of_freedom=f"{joint}_{side}",
            strides=12,
            mean=[leg_angles(1.1 * percent / 100, side)[joint == "knee_flexion"] for percent in range(CURVE_POINTS)],
            spread=[0.05] * CURVE_POINTS,
        )
        for joint in ("hip_flexion", "knee_flexion")
        for side in Side
    ]
    return SessionMetrics(captured_ns=round(at_s * 1e9), final=final, metrics=numbers, curves=curves)
