"""Messages to a browser as plain values: SI units, seconds instead of nanoseconds. Degrees are the page's business."""

import json
from typing import Any

from schemas.gait import GaitEvent, Stride
from schemas.kinematics import Calibration, LivePose
from schemas.metrics import Metric, SessionMetrics
from schemas.quality import DataQuality, SourceQuality
from schemas.session import SessionDescription
from schemas.tasks import Repetition, TaskPhase

View = dict[str, Any]


def encode(view: View) -> str:
    """Compact JSON text; refuses numbers that are not finite."""
    return json.dumps(view, separators=(",", ":"), allow_nan=False)


def seconds(ns: int) -> float:
    """Session time for a browser, which has no 64-bit integers; 0.1 ms is kept."""
    return round(ns / 1e9, 4)


def session_view(description: SessionDescription, patient: str | None) -> View:
    """What a page needs to draw a session, sent once when it starts to watch."""
    body = description.anthropometry
    return {
        "kind": "session",
        "id": description.session,
        "title": description.title,
        "patient": patient,
        "origin": description.origin,
        "protocol": description.protocol,
        "task": description.task,
        "walkway_m": description.walkway_m,
        "conditions": description.conditions.model_dump(mode="json"),
        "estimator": description.estimator,
        "walk_path": description.walk_path,
        "started_unix_s": round(description.started_unix_ns / 1e9, 3),
        "duration_s": description.duration_s,
        "sensors": [
            {"name": sensor.name, "segment": sensor.segment.value, "rate_hz": sensor.rate_hz}
            for hub in description.hubs
            for sensor in hub.sensors
        ],
        "cameras": [
            {"name": camera.name, "kind": camera.kind.value, "rate_hz": camera.rate_hz, "floor_m": camera.floor_m}
            for camera in description.cameras
        ],
        "body": {
            "thigh_length_m": body.thigh_length_m,
            "shank_length_m": body.shank_length_m,
            "hip_width_m": body.hip_width_m,
        },
    }


def pose_view(poses: list[LivePose], age_s: float) -> View:
    """The newest skeleton, with the angles of those that came since the last one shown, so that no peak is cut.

    `age_s`: how long the gateway has had the newest.
    """
    pose = poses[-1]
    return {
        "kind": "pose",
        "at_s": seconds(pose.captured_ns),
        "age_s": round(age_s, 3),
        "phase": pose.phase,
        "message": pose.message,
        "notice": pose.notice,
        "segments": {
            each.segment.value: {
                "position": _rounded(each.position),
                "quat_world_from_segment": _rounded(each.quat_world_from_segment),
                "valid": each.valid,
            }
            for each in pose.segments
        },
        **_angles_view(pose),
        "trail": [{"at_s": seconds(each.captured_ns), **_angles_view(each)} for each in poses[:-1]],
        "sensors": sensor_views(pose),
        "centres": {centre.value: _rounded(position) for centre, position in pose.centres.items()},
        "cameras": camera_views(pose),
        "cadence_per_min": pose.cadence_per_min,
        "stood": None if pose.stood is None else round(pose.stood, 2),
    }


def _angles_view(pose: LivePose) -> View:
    return {
        "angles": {name: round(value, 5) for name, value in pose.angles.items()},
        "angles_std": {name: round(value, 5) for name, value in pose.angles_std.items()},
    }


def sensor_views(pose: LivePose) -> list[View]:
    """State of each sensor."""
    return [
        {"sensor": each.sensor, "state": each.state.value, "since_s": seconds(each.since_ns)} for each in pose.sensors
    ]


def camera_views(pose: LivePose) -> list[View]:
    """State of each camera, and how many people it sees."""
    return [
        {"camera": each.camera, "state": each.state.value, "people": each.people, "since_s": seconds(each.since_ns)}
        for each in pose.cameras
    ]


def event_view(event: GaitEvent) -> View:
    """A contact."""
    return {
        "kind": "gait_event",
        "event": event.kind.value,
        "side": event.side.value,
        "at_s": seconds(event.captured_ns),
        "time_std_s": event.time_std_s,
    }


def stride_view(stride: Stride) -> View:
    """A stride without its curves."""
    return {
        "kind": "stride",
        "side": stride.side.value,
        "index": stride.index,
        "start_s": seconds(stride.start_ns),
        "end_s": seconds(stride.end_ns),
        "stride_time_s": stride.stride_time_s,
        "stance_fraction": stride.stance_fraction,
        "step_time_s": stride.step_time_s,
        "step_length_m": stride.step_length_m,
        "step_length_std_m": stride.step_length_std_m,
        "stride_length_m": stride.stride_length_m,
        "walking_speed": stride.walking_speed,
        "turning": stride.turning,
        "valid": stride.valid,
        "rejected_because": stride.rejected_because,
    }


def calibration_view(calibration: Calibration) -> View:
    """What zero means, what is worn otherwise than declared, and how long segments were found to be."""
    return {
        "kind": "calibration",
        "datum": calibration.datum,
        "quality": calibration.quality,
        "misplaced": calibration.model_dump(mode="json", include={"misplaced"})["misplaced"],
        "absolute": calibration.absolute,
        "lengths": {name: round(length, 4) for name, length in calibration.lengths.items()},
    }


def phase_view(phase: TaskPhase) -> View:
    """A phase of a timed test that begins or has ended."""
    return {
        "kind": "task_phase",
        "task": phase.task,
        "attempt": phase.attempt,
        "phase": phase.phase,
        "start_s": seconds(phase.start_ns),
        "start_std_s": phase.start_std_s,
        "end_s": None if phase.end_ns is None else seconds(phase.end_ns),
        "end_std_s": phase.end_std_s,
        "distance_m": phase.distance_m,
    }


def repetition_view(repetition: Repetition) -> View:
    """A repetition of an exercise."""
    return {
        "kind": "repetition",
        "degree_of_freedom": repetition.degree_of_freedom,
        "side": repetition.side,
        "index": repetition.index,
        "start_s": seconds(repetition.start_ns),
        "turn_s": seconds(repetition.turn_ns),
        "end_s": seconds(repetition.end_ns),
        "start_angle": repetition.start_angle,
        "turn_angle": repetition.turn_angle,
        "end_angle": repetition.end_angle,
        "angle_std": repetition.angle_std,
        "hold_s": repetition.hold_s,
        "ranges": {name: round(value, 5) for name, value in repetition.ranges.items()},
        "valid": repetition.valid,
        "rejected_because": repetition.rejected_because,
    }


def quality_view(newest: DataQuality, before: DataQuality | None) -> View:
    """What each sensor told between two words on the quality of the data; of the session so far without one before.

    `lost` are the samples that were due and never came, `refused` those that came and could not be used: both a share
    of the samples due.
    """
    earlier = {} if before is None else {each.name: each for each in before.sources}
    return {
        "kind": "data_quality",
        "at_s": seconds(newest.captured_ns),
        "since_s": 0.0 if before is None else seconds(before.captured_ns),
        "sources": [_shares(each, earlier.get(each.name)) for each in newest.sources],
    }


def _shares(now: SourceQuality, before: SourceQuality | None) -> View:
    due, used, refused = now.expected, now.used, now.rejected
    if before is not None:
        due, used, refused = due - before.expected, used - before.used, refused - before.rejected
    # A sensor's own clock may run a little faster than its nominal rate: more than all is all.
    shares = (None, None) if due <= 0 else (max(0.0, (due - used - refused) / due), min(1.0, refused / due))
    lost, refused_share = (None if share is None else round(share, 4) for share in shares)
    return {"name": now.name, "lost": lost, "refused": refused_share}


def metrics_view(metrics: SessionMetrics) -> View:
    """The session in numbers so far; its curves are read by REST."""
    return {
        "kind": "metrics",
        "at_s": seconds(metrics.captured_ns),
        "final": metrics.final,
        "metrics": [_metric_view(metric) for metric in metrics.metrics],
    }


def _metric_view(metric: Metric) -> View:
    return metric.model_dump(mode="json")


def _rounded(values: list[float]) -> list[float]:
    # 0.1 mm and 0.01 degrees: far below what can be seen, and half the text.
    return [round(value, 4) for value in values]
