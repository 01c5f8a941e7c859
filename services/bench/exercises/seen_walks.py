"""Synthetic walks as a camera's estimate would have them: joint centres with errors, on a floor or a treadmill."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import JointCentres, JointState
from schemas.rhythm import Rhythm
from schemas.session import CameraDescription, SessionDescription
from schemas.signals import JOINT_CENTRES, JOINT_STATE, RHYTHM
from schemas.vocabulary import BODY_MODELS, CameraKind, JointCentre, Segment, Side, SkeletonJoint
from services.bench.gait.joint_walks import JointWalk, joint_walk
from services.flow.message import Envelope, Message, Stream

Array = NDArray[np.float64]

JOINTS, RHYTHMS, CENTRES = (Stream(signal, "estimation") for signal in (JOINT_STATE, RHYTHM, JOINT_CENTRES))
CAMERA = CameraDescription(
    name="camera", kind=CameraKind.KINECT_V2, rate_hz=30.0, joints=list(SkeletonJoint)[:25], floor_m=-1.0
)
ERROR_TIME_S = 0.15
"""s over which the errors of an estimate stay alike."""
AT = {centre: i for i, centre in enumerate(JointCentre)}
NAMES = [dof.name for dof in BODY_MODELS["whole_body"]]


@dataclass(frozen=True)
class SeenWalk:
    """A walk seen by a camera; the truth is the walk's."""

    walk: JointWalk
    time_s: Array  # (n,)
    position: Array  # (n, 15, 3) m
    angles: Array  # (n, 24) rad

    def description(self) -> SessionDescription:
        """Of a session with a camera alone."""
        changes = {"cameras": [CAMERA], "hubs": [], "estimator": "body_cekf"}
        return self.walk.description.model_copy(update=changes)

    def messages(self, rows: int = 1) -> list[Message]:
        """joint_state, rhythm and joint_centres in turn."""
        found: list[Message] = []
        captured_ns = np.round(self.time_s * 1e9).astype(np.int64).tolist()
        rates = np.gradient(self.angles, self.time_s, axis=0)
        for number, first in enumerate(range(0, len(captured_ns), rows)):
            part = slice(first, first + rows)
            ns = captured_ns[part]
            n, envelope = len(ns), Envelope(0, number, ns[-1])
            zeros = np.zeros((n, len(NAMES))).tolist()
            joints = JointState(
                model="whole_body", captured_ns=ns, position=self.angles[part].tolist(),
                velocity=rates[part].tolist(), acceleration=zeros, position_std=zeros, velocity_std=zeros,
                valid=[not name.startswith("ankle") for name in NAMES], observed=[],
            )  # fmt: skip
            rhythm = Rhythm(captured_ns=ns, phase=[0.0] * n, frequency=[0.0] * n, quality=[0.0] * n, locked=[False] * n)
            centres = JointCentres(captured_ns=ns, position=self.position[part].tolist(), seen=[True] * len(AT))
            found += [Message(JOINTS, envelope, joints), Message(RHYTHMS, envelope, rhythm)]
            found.append(Message(CENTRES, envelope, centres))
        return found


def seen_walk(query: str, *, treadmill: bool, noise_m: float, offset_m: float = 0.0, seed: int = 0) -> SeenWalk:
    """The walk of `synthetic:walk?{query}` at 30 Hz, with errors of so many m that stay alike for a while, and constant
    ones; 2 % of the frames are missing. A treadmill takes away the way walked, at its own steady speed."""
    walk = joint_walk(query)
    rng = np.random.default_rng([seed, 30])
    every = np.arange(0.0, walk.track.time_s[-1], 1.0 / 30.0)
    time_s = every[rng.random(len(every)) > 0.02]
    position = _resampled(_centres(walk, treadmill=treadmill), walk.track.time_s, time_s)
    position += rng.normal(0.0, offset_m, (15, 3)) + _errors(rng, time_s, noise_m)
    angles = np.zeros((len(walk.track.time_s), len(NAMES)))
    for k, name in enumerate(NAMES):
        if name in walk.body.angles:
            angles[:, k] = walk.body.angles[name].value
    return SeenWalk(walk, time_s, position, _resampled(angles, walk.track.time_s, time_s))


def _errors(rng: np.random.Generator, time_s: Array, noise_m: float) -> Array:
    """(n, 15, 3) m, each first-order low-pass."""
    white, found = rng.normal(0.0, noise_m, (len(time_s), 15, 3)), np.zeros((len(time_s), 15, 3))
    found[0] = white[0]
    for k in range(1, len(time_s)):
        keep = np.exp(-(time_s[k] - time_s[k - 1]) / ERROR_TIME_S)
        found[k] = keep * found[k - 1] + np.sqrt(1.0 - keep**2) * white[k]
    return found


def _resampled(values: Array, from_s: Array, to_s: Array) -> Array:
    flat = values.reshape(len(values), -1)
    columns = [np.interp(to_s, from_s, column) for column in flat.T]
    return np.column_stack(columns).reshape(len(to_s), *values.shape[1:])


def _centres(walk: JointWalk, *, treadmill: bool) -> Array:
    """(n, 15, 3) m. The trunk is upright above the pelvis; arms hang."""
    segments, body = walk.body.segments, walk.body
    centres = np.zeros((len(walk.track.time_s), len(AT), 3))
    pelvis = body.pelvis.position
    for side in Side:
        centres[:, AT[JointCentre(f"hip_{side}")]] = segments[Segment(f"thigh_{side}")].origin.position
        centres[:, AT[JointCentre(f"knee_{side}")]] = segments[Segment(f"shank_{side}")].origin.position
        centres[:, AT[JointCentre(f"ankle_{side}")]] = body.ankle(side).position
    right = segments[Segment.THIGH_RIGHT].origin.position - segments[Segment.THIGH_LEFT].origin.position
    right = right / np.linalg.norm(right, axis=1, keepdims=True)
    for part, height in (("base", 0.0), ("mid", 0.27), ("shoulder", 0.5)):
        centres[:, AT[JointCentre(f"spine_{part}")]] = pelvis + np.array([0.0, height, 0.0])
    for side, sign in ((Side.RIGHT, 1.0), (Side.LEFT, -1.0)):
        for joint, height in (("shoulder", 0.48), ("elbow", 0.2), ("wrist", -0.05)):
            centres[:, AT[JointCentre(f"{joint}_{side}")]] = pelvis + np.array([0.0, height, 0.0]) + 0.17 * sign * right
    if treadmill:
        centres[:, :, [0, 2]] -= _carried(walk)[:, None, :]
    return centres


def _carried(walk: JointWalk) -> Array:
    """(n, 2) m, the way that the belt takes back: at one speed from the first contact to the last, as a belt does."""
    time_s, way = walk.track.time_s, walk.body.pelvis.position[:, [0, 2]]
    contacts = np.sort(np.concatenate([walk.contacts_s(side) for side in Side]))
    ends = contacts[[0, -1]]
    at = np.column_stack([np.interp(ends, time_s, column) for column in way.T])
    return np.column_stack([np.interp(time_s, ends, at[:, k]) for k in range(2)])
