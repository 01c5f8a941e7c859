"""Recorded Kinect v2 skeletons as joint centres in our axes, and the optical reference beside one of them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ReferenceBatch
from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import SkeletonJoint, TrackingState
from services.biomech.whole_body.model import CENTRE_NAMES
from services.ingest.source import Source, open_source
from services.ingest.synthetic.whole_body.camera import Seen

Array = NDArray[np.float64]

RATE_HZ = 30.0
KIMORE = {"squat": "kimore_squat", "arm lift": "kimore_arm_lift"}
"""Exercise -> the recording as ingest knows it."""

STATES = list(TrackingState)
UNKNOWN = [float("nan")] * 3


class Lean(NamedTuple):
    """A seated trunk exercise: what the camera saw, and the optical inclination of the trunk over the same time."""

    seen: Seen
    frontal: Array  # (n,) rad to the right, at the camera's frames


def kimore(exercise: str) -> Seen:
    """KIMORE: a squat that starts low, or an arm lift. Raises MissingFile without the data."""
    return seen_by_camera(open_source(KIMORE[exercise]))[0]


def keraal() -> Lean:
    """KERAAL, a seated rotation of the trunk. Raises MissingFile without the data."""
    source = open_source("keraal_torso_rotation")
    seen, at_ns = seen_by_camera(source)
    batches = [m.payload for m in source.messages() if isinstance(m.payload, ReferenceBatch)]
    truth_ns = np.array([ns for batch in batches for ns in batch.captured_ns])
    values = np.array([row for batch in batches for row in batch.values], dtype=np.float64)
    names = [channel.name for channel in source.describe().reference]

    def target(name: str) -> Array:
        return np.stack([values[:, names.index(f"target_{name}_{axis}")] for axis in "xyz"], axis=1)

    trunk = target("chest") - target("hips")
    # The sideways axis is that between the thighs' targets, right minus left, levelled.
    right = np.median(target("thigh_right") - target("thigh_left"), axis=0) * [1.0, 0.0, 1.0]
    lean = np.arctan2(trunk @ (right / np.linalg.norm(right)), trunk[:, 1])
    return Lean(seen, np.interp(at_ns, truth_ns, lean))


def seen_by_camera(source: Source) -> tuple[Seen, NDArray[np.int64]]:
    """The centres of every frame of a source's first camera, and its times in ns."""
    camera = source.describe().cameras[0]
    places = [camera.joints.index(SkeletonJoint(name)) for name in CENTRE_NAMES]
    batches = [m.payload for m in source.messages() if isinstance(m.payload, SkeletonBatch)]
    centres = [[frame[j] or UNKNOWN for j in places] for batch in batches for frame in batch.position]
    states = [[STATES.index(frame[j]) for j in places] for batch in batches for frame in batch.state]
    captured_ns = np.array([ns for batch in batches for ns in batch.captured_ns])
    return Seen(np.array(centres), np.array(states)), captured_ns
