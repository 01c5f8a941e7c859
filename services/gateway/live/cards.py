"""A running session as a card of the floor."""

from schemas.kinematics import LivePose
from services.gateway.live import views
from services.gateway.live.session import LiveSession
from services.gateway.live.views import View

HEAD = ("id", "title", "patient", "task", "estimator", "started_unix_s", "duration_s")
PHASES = 5
"""As many as a timed up and go has; of a six-minute walk no card shows more."""


def card_view(live: LiveSession, pose: LivePose | None, age_s: float | None, recording_stopped: str | None) -> View:
    """What one card needs; `pose` is the newest skeleton, `age_s` how long ago it came."""
    head = views.session_view(live.description, live.patient)
    return {
        **{name: head[name] for name in HEAD},
        "sensor_segments": {sensor["name"]: sensor["segment"] for sensor in head["sensors"]},
        "age_s": age_s,
        "elapsed_s": None if pose is None else views.seconds(pose.captured_ns),
        "phase": None if pose is None else pose.phase,
        "message": None if pose is None else pose.message,
        "sensors": [] if pose is None else views.sensor_views(pose),
        "cameras": [] if pose is None else views.camera_views(pose),
        "cadence_per_min": None if pose is None else pose.cadence_per_min,
        "strides": sum(view["index"] + 1 for view in live.memory.of("stride")),
        "repetitions": sum(view["index"] + 1 for view in live.memory.of("repetition")),
        "task_phases": live.memory.newest_phases(PHASES),
        "recording_stopped": recording_stopped,
        "misplaced": next((view["misplaced"] for view in live.memory.of("calibration")), {}),
    }
