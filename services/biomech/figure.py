"""What a screen shows of a person, out of joint states and joint centres: live pages and replays draw with this alone.

Plain numbers and no compiler, so that whoever shows a recording needs neither an estimator nor the kernels.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from schemas.kinematics import CameraStatus, LivePose, SegmentPose, SensorStatus
from schemas.session import Anthropometry, SessionDescription
from schemas.vocabulary import BODY_MODELS, KNEE_ESTIMATORS, LOWER_BODY, JointCentre, Segment
from services.biomech.bones import SEGMENTS, ankle, bones
from services.biomech.whole_body.directions import directions
from services.biomech.worn_legs import worn_legs

WHOLE_BODY = "whole_body"
SHANKS = (Segment.SHANK_RIGHT, Segment.SHANK_LEFT)
_NAMES = {model: [dof.name for dof in freedoms] for model, freedoms in BODY_MODELS.items()}
_LOWER_OF_WHOLE = [_NAMES[WHOLE_BODY].index(dof.name) if dof.name in _NAMES[WHOLE_BODY] else None for dof in LOWER_BODY]


class Pace:
    """Of pictures, by the time of the data."""

    def __init__(self, rate_hz: float) -> None:
        self._period_ns = round(1e9 / rate_hz)
        self.next_ns = 0

    def is_due(self, captured_ns: int) -> bool:
        """Whether a picture at this time is the next one; if so, the one after it is a period later."""
        if captured_ns < self.next_ns:
            return False
        self.next_ns = (captured_ns // self._period_ns + 1) * self._period_ns
        return True


class Angles(NamedTuple):
    """One row of joint coordinates of a body model, in its order."""

    model: str
    captured_ns: int
    position: Sequence[float]
    """(n,) rad."""
    position_std: Sequence[float]
    """(n,) rad."""
    valid: Sequence[bool]


class Told(NamedTuple):
    """What stands beside the body in a picture."""

    message: str = ""
    notice: str = ""
    sensors: Sequence[SensorStatus] = ()
    cameras: Sequence[CameraStatus] = ()
    cadence_per_min: float | None = None


def drawn_segments(description: SessionDescription) -> tuple[Segment, ...]:
    """Bones that a session's sensors can tell of: of single knees the legs that wear both, else the lower body."""
    if description.estimator in KNEE_ESTIMATORS:
        return tuple(segment for leg in worn_legs(description) for segment in leg.segments)
    return SEGMENTS if description.hubs else ()


def segment_pictures(
    body: Anthropometry, position: Sequence[float], segments: Sequence[Segment], observed: Sequence[Segment]
) -> list[SegmentPose]:
    """Bones for joint coordinates (15,) rad of LOWER_BODY; the lower ankle of those drawn stands on the floor.

    `observed`: segments whose own sensor speaks and is not in doubt; the others are drawn as not known.
    """
    found = bones(body, position)
    floor = min(ankle(body, found[shank])[1] for shank in SHANKS if shank in segments)
    pictures = []
    for segment in segments:
        (x, y, z), quat = found[segment]
        at, turned = [x, y - floor, z], list(quat)
        pictures.append(
            SegmentPose(segment=segment, position=at, quat_world_from_segment=turned, valid=segment in observed)
        )
    return pictures


def lower_body_of(whole: Sequence[float]) -> list[float]:
    """(15,) rad of LOWER_BODY out of the coordinates of `whole_body`, which has hinges for knees: their soft angles
    are zero."""
    return [0.0 if place is None else whole[place] for place in _LOWER_OF_WHOLE]


def is_placed(centres: Sequence[Sequence[float]]) -> bool:
    """Whether joint centres (15, 3) m stand where a camera has seen the body; before, they are around the origin."""
    return any(centres[0])


def cadence_per_min(frequency: float, *, locked: bool) -> float | None:
    """Steps per minute of a rhythm of strides with that frequency, rad/s; two steps a stride."""
    return frequency / (2.0 * math.pi) * 120.0 if locked else None


def estimated_pose(
    angles: Angles, segments: list[SegmentPose], told: Told, centres: dict[JointCentre, list[float]] | None = None
) -> LivePose:
    """The picture of one row of a body model."""
    seen = [(i, name) for i, name in enumerate(_NAMES[angles.model]) if angles.valid[i]]
    return LivePose(
        captured_ns=angles.captured_ns,
        phase="estimating",
        message=told.message,
        notice=told.notice,
        segments=segments,
        angles={name: angles.position[i] for i, name in seen},
        angles_std={name: angles.position_std[i] for i, name in seen},
        sensors=list(told.sensors),
        centres=centres or {},
        cameras=list(told.cameras),
        cadence_per_min=told.cadence_per_min,
        stood=None,
    )


def with_directions(
    pose: LivePose, position: Sequence[float], position_std: Sequence[float], seen: Sequence[bool]
) -> LivePose:
    """The picture with trunk lean and arm elevation beside the angles of joints, where the camera sees them."""
    shown = directions(position, position_std, seen)
    angles = pose.angles | {name: angle for name, (angle, _) in shown.items()}
    stds = pose.angles_std | {name: std for name, (_, std) in shown.items()}
    return pose.model_copy(update={"angles": angles, "angles_std": stds})
