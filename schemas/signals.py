"""The signals table: one row per signal. Keys, archive, runner, tests and documentation derive from it."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

from schemas.checkpoint import Checkpoint
from schemas.gait import GaitEvent, Stride
from schemas.health import Gap, Health, Progress
from schemas.imu import ImuBatch, ReferenceBatch
from schemas.kinematics import Calibration, JointCentres, JointState, LivePose, SegmentMotion
from schemas.metrics import SessionMetrics
from schemas.payload import Payload
from schemas.quality import DataQuality
from schemas.rhythm import LearnedRhythm, Rhythm
from schemas.session import SessionDescription
from schemas.skeleton import SkeletonBatch
from schemas.tasks import Repetition, TaskPhase


class Quality(StrEnum):
    """How a signal travels."""

    LOSSLESS = "lossless"
    LIVE = "live"
    STATE = "state"


@dataclass(frozen=True, slots=True, eq=False)
class Signal:
    """A row of the table. Each row exists once, so rows are compared and hashed as objects, which is quick."""

    name: str
    model: type[Payload]
    producer: str
    quality: Quality
    archived: Literal["raw", "derived"] | None
    nominal_rate_hz: float | None
    meaning: str


IMU = Signal("imu", ImuBatch, "ingest", Quality.LOSSLESS, "raw", 100.0, "inertial samples of one hub")
SKELETON = Signal(
    "skeleton",
    SkeletonBatch,
    "ingest",
    Quality.LOSSLESS,
    "raw",
    30.0,
    "joints of a person as a camera sees them",
)
REFERENCE = Signal(
    "reference", ReferenceBatch, "ingest", Quality.LOSSLESS, "raw", 100.0, "truth that came with the samples"
)
SESSION = Signal(
    "session", SessionDescription, "ingest", Quality.STATE, "raw", None, "sensors, body and protocol of a session"
)
CALIBRATION = Signal(
    "calibration", Calibration, "estimation", Quality.LOSSLESS, "derived", None, "how the sensors sit on the body"
)
JOINT_STATE = Signal(
    "joint_state", JointState, "estimation", Quality.LOSSLESS, "derived", 100.0, "joint coordinates with deviations"
)
RHYTHM = Signal("rhythm", Rhythm, "estimation", Quality.LOSSLESS, "derived", 100.0, "stride phase and frequency")
LEARNED_RHYTHM = Signal(
    "learned_rhythm", LearnedRhythm, "estimation", Quality.LOSSLESS, "derived", None, "mean stride in Fourier terms"
)
SEGMENT_MOTION = Signal(
    "segment_motion", SegmentMotion, "estimation", Quality.LOSSLESS, "derived", 100.0, "acceleration and turning of "
    "segments whose lone sensor tells gait events",
)  # fmt: skip
JOINT_CENTRES = Signal(
    "joint_centres", JointCentres, "estimation", Quality.LOSSLESS, "derived", 30.0, "joint centres in the room, of a "
    "body that a camera sees",
)  # fmt: skip
DATA_QUALITY = Signal(
    "data_quality", DataQuality, "estimation", Quality.LOSSLESS, "derived", None, "what the sensors told and what of "
    "it was used, so far",
)  # fmt: skip
LIVE_POSE = Signal("live_pose", LivePose, "estimation", Quality.LIVE, None, 25.0, "the skeleton on the screen")
GAIT_EVENT = Signal(
    "gait_event", GaitEvent, "segmentation", Quality.LOSSLESS, "derived", None, "initial contact and toe-off"
)
STRIDE = Signal("stride", Stride, "segmentation", Quality.LOSSLESS, "derived", None, "one stride with its curves")
TASK_PHASE = Signal(
    "task_phase", TaskPhase, "segmentation", Quality.LOSSLESS, "derived", None, "phases of a timed test"
)
REPETITION = Signal(
    "repetition", Repetition, "segmentation", Quality.LOSSLESS, "derived", None, "repetitions of an exercise"
)
METRICS = Signal(
    "metrics", SessionMetrics, "metrics", Quality.LOSSLESS, "derived", None, "the session in numbers so far"
)
GAP = Signal("gap", Gap, "archive", Quality.LOSSLESS, "raw", None, "messages that nobody has any more")
HEALTH = Signal("health", Health, "every service", Quality.LIVE, None, 1.0, "a service's report on itself")
CHECKPOINT = Signal(
    "checkpoint", Checkpoint, "every node", Quality.STATE, None, 1.0, "a node's state, kept by the archive"
)
PROGRESS = Signal("progress", Progress, "every consumer", Quality.LIVE, None, 10.0, "how far a consumer has come")

SIGNALS: tuple[Signal, ...] = (
    IMU, SKELETON, REFERENCE, SESSION, CALIBRATION, JOINT_STATE, RHYTHM, LEARNED_RHYTHM, SEGMENT_MOTION,
    JOINT_CENTRES, DATA_QUALITY, LIVE_POSE,
    GAIT_EVENT, STRIDE, TASK_PHASE, REPETITION, METRICS, GAP, HEALTH, CHECKPOINT, PROGRESS,
)  # fmt: skip
BY_NAME: dict[str, Signal] = {signal.name: signal for signal in SIGNALS}


def stream_key(site: str, session: str, signal: Signal, source: str) -> str:
    """Key expression of one stream; `*` for session or source subscribes to all."""
    return f"ambula/{site}/{session}/{signal.name}/{source}"


def session_token_key(site: str, session: str) -> str:
    """Liveliness token that an ingest holds while a session runs."""
    return f"ambula/{site}/@session/{session}"


def description_key(site: str, session: str) -> str:
    """Queryable that answers with the session description."""
    return f"ambula/{site}/@description/{session}"


def replay_key(site: str, session: str, signal: Signal, source: str) -> str:
    """Queryable of a producer's ring: parameters epoch, from, to."""
    return f"ambula/{site}/@replay/{session}/{signal.name}/{source}"


def checkpoint_key(site: str, session: str, service: str) -> str:
    """Where a node's checkpoint is put and asked for."""
    return f"ambula/{site}/@checkpoint/{session}/{service}"


def progress_key(site: str, session: str, service: str) -> str:
    """Where a consumer says how far it has come."""
    return f"ambula/{site}/@progress/{session}/{service}"


def health_key(site: str, service: str, instance: str) -> str:
    """Where a service reports on itself."""
    return f"ambula/{site}/@health/{service}/{instance}"


def service_token_key(site: str, service: str, instance: str) -> str:
    """Liveliness token of a running service."""
    return f"ambula/{site}/@svc/{service}/{instance}"


def command_key(site: str, service: str, command: str) -> str:
    """Queryable that carries out a command, e.g. ingest/start."""
    return f"ambula/{site}/@command/{service}/{command}"
