"""A synthetic person in front of a camera in a session of its own: description, messages, what the node says."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from schemas.kinematics import Calibration, JointCentres, JointState, LivePose
from schemas.session import Anthropometry, CameraDescription, SessionDescription, StandingInterval
from schemas.signals import SKELETON
from schemas.skeleton import SkeletonBatch
from schemas.standing import StandingMark
from schemas.vocabulary import BODY_MODELS, CameraKind, SkeletonJoint, Task, TrackingState
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, MODEL
from services.biomech.whole_body.parameters import REST_DEG, lengths_of, per_angle
from services.estimation.body.node import BodyNode
from services.flow.message import Envelope, Message, Output, Stream
from services.flow.node import Node

NAMES = [dof.name for dof in BODY_MODELS["whole_body"]]
RATE_HZ = 30.0
STATURE = 1.7
CAMERA = "kinect"
LEVELS = (TrackingState.NOT_TRACKED, TrackingState.INFERRED, TrackingState.TRACKED)
JOINTS = [SkeletonJoint(name.value) for name in CENTRE_NAMES]


def time_ns(k: int) -> int:
    """When frame k was captured."""
    return round((k + 1) * 1e9 / RATE_HZ)


def describe(
    estimator: str = "body_cekf", *, joints: Sequence[SkeletonJoint] = JOINTS, cameras: Sequence[str] = (CAMERA,),
    standing: Sequence[tuple[float, float]] = (), height_m: float | None = STATURE,
) -> SessionDescription:  # fmt: skip
    """A session with cameras and nothing worn."""
    body = Anthropometry(
        height_m=height_m, mass_kg=None, thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="measured"
    )
    seen = [
        CameraDescription(name=name, kind=CameraKind.KINECT_V2, rate_hz=RATE_HZ, joints=list(joints), floor_m=-0.95)
        for name in cameras
    ]
    marked = [StandingInterval(from_ns=round(a * 1e9), to_ns=round(b * 1e9)) for a, b in standing]
    return SessionDescription(
        session="body", title="", started_unix_ns=0, origin="synthetic", protocol="", task=Task.SQUAT, walkway_m=None,
        estimator=estimator, walk_path="turning", hubs=[], cameras=seen, anthropometry=body, standing=marked,
        reference=[], duration_s=None, known_rhythms=[],
    )  # fmt: skip


def standing(seconds: float) -> np.ndarray:
    """(n, 25) the mean rest posture, 2.5 m before the camera."""
    q = np.zeros((round(seconds * RATE_HZ), 25))
    q[:, :3] = -2.5, 0.0, 0.1
    q[:, 3:] = per_angle(REST_DEG)[:, 0]
    return q


def squats(seconds: float, depth_deg: float = 70.0) -> np.ndarray:
    """(n, 25) down and up in 3 s, the arms raised sideways, from standing."""
    q = standing(seconds)
    down = (1.0 - np.cos(2.0 * np.pi * np.arange(len(q)) / RATE_HZ / 3.0)) / 2.0
    for side in ("right", "left"):
        q[:, 3 + DOF[f"knee_flexion_{side}"]] += np.radians(depth_deg) * down
        q[:, 3 + DOF[f"hip_flexion_{side}"]] += np.radians(0.9 * depth_deg) * down
        q[:, 3 + DOF[f"shoulder_adduction_{side}"]] -= np.radians(0.6 * depth_deg) * down
    q[:, 3 + DOF["pelvis_tilt"]] += np.radians(0.3 * depth_deg) * down
    return q


def seated(seconds: float) -> np.ndarray:
    """(n, 25) on a chair, still."""
    q = standing(seconds)
    for side in ("right", "left"):
        q[:, 3 + DOF[f"hip_flexion_{side}"]] = q[:, 3 + DOF[f"knee_flexion_{side}"]] = np.radians(88.0)
    return q


def seen(q: np.ndarray, seed: int = 0, std: float = 0.008, offset_m: float = 0.0) -> np.ndarray:
    """(n, 15, 3) m with white noise and, if wished, constant offsets of the centres."""
    generator = np.random.default_rng(seed)
    offsets = generator.normal(0.0, 1.0, (15, 3)) * offset_m
    centres = np.array([MODEL.centres(row, lengths_of(STATURE)) for row in q])
    return centres + offsets + generator.normal(0.0, std, centres.shape)


def messages(
    centres: np.ndarray, state: np.ndarray | None = None, *, body: Sequence[int | None] | None = None, people: int = 1,
    frames: int = 1, camera: str = CAMERA,
) -> list[Message]:  # fmt: skip
    """Centres (n, 15, 3), `frames` of them a message; a body of None is nobody."""
    n = len(centres)
    levels = np.full((n, 15), 2) if state is None else state
    bodies = [1] * n if body is None else list(body)
    made = []
    for number, first in enumerate(range(0, n, frames)):
        rows = range(first, min(first + frames, n))
        batch = SkeletonBatch(
            captured_ns=[time_ns(k) for k in rows], body=[bodies[k] for k in rows],
            people=[people if bodies[k] is not None else 0 for k in rows],
            position=[_positions(centres[k], levels[k], bodies[k]) for k in rows],
            state=[[LEVELS[level if bodies[k] is not None else 0] for level in levels[k]] for k in rows], marks=[],
        )  # fmt: skip
        made.append(Message(Stream(SKELETON, camera), Envelope(0, number, time_ns(rows[-1])), batch))
    return made


def _positions(centres: np.ndarray, levels: np.ndarray, body: int | None) -> list[list[float] | None]:
    return [c.tolist() if level > 0 and body is not None else None for c, level in zip(centres, levels, strict=True)]


def changed(message: Message, **fields: object) -> Message:
    """The message with other fields in its payload."""
    assert message.payload is not None
    return replace(message, payload=message.payload.model_copy(update=fields))


def marked(stream: Sequence[Message], from_s: float, to_s: float, given_s: float) -> list[Message]:
    """The messages, with a mark in the first one later than it was given."""
    mark = StandingMark(from_ns=round(from_s * 1e9), to_ns=round(to_s * 1e9), given_ns=round(given_s * 1e9))
    first = next(i for i, message in enumerate(stream) if message.envelope.captured_ns > mark.given_ns)
    return [*stream[:first], changed(stream[first], marks=[mark]), *stream[first + 1 :]]


def node(description: SessionDescription | None = None) -> BodyNode:
    """Of a session with one camera."""
    return BodyNode(description or describe())


def run(node: Node, stream: Iterable[Message]) -> list[Output]:
    """All outputs, those of the end included."""
    return [output for message in stream for output in node.step(message)] + node.finish()


def states(outputs: Sequence[Output]) -> list[JointState]:
    """Joint states among the outputs."""
    return [output.payload for output in outputs if isinstance(output.payload, JointState)]


def centres(outputs: Sequence[Output]) -> list[JointCentres]:
    """Joint centres among the outputs."""
    return [output.payload for output in outputs if isinstance(output.payload, JointCentres)]


def calibrations(outputs: Sequence[Output]) -> list[Calibration]:
    """Calibrations among the outputs."""
    return [output.payload for output in outputs if isinstance(output.payload, Calibration)]


def pictures(outputs: Sequence[Output]) -> list[LivePose]:
    """Live poses among the outputs."""
    return [output.payload for output in outputs if isinstance(output.payload, LivePose)]


def table(outputs: Sequence[Output], quantity: str = "position") -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Captured times (n,), the quantity (n, 24) and validity (n, 24) of all rows."""
    rows = [
        (t, row, s.valid) for s in states(outputs) for t, row in zip(s.captured_ns, getattr(s, quantity), strict=True)
    ]
    times, values, valid = zip(*rows, strict=True)
    return np.array(times), np.array(values), np.array(valid)


def text(outputs: Sequence[Output]) -> list[tuple[str, int, str]]:
    """To the bit."""
    return [(o.signal.name, o.captured_ns, o.payload.model_dump_json()) for o in outputs]
