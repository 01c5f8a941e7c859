"""What goes wrong with a depth camera, one small class each. Times are seconds of session time, ends excluded."""

from dataclasses import dataclass

from schemas.vocabulary import SkeletonJoint
from services.faults.bursts import BurstModel


@dataclass(frozen=True, slots=True)
class CameraCovered:
    """Somebody stands before the camera or puts a coat over it: frames come, nobody is in them."""

    from_s: float
    to_s: float


@dataclass(frozen=True, slots=True)
class CameraSilent:
    """No frame comes at all: cable, capture program."""

    from_s: float
    to_s: float


@dataclass(frozen=True, slots=True)
class FrameLoss:
    """Frames are dropped in bursts."""

    model: BurstModel
    seed: int


@dataclass(frozen=True, slots=True)
class JointsInferred:
    """These joints are hidden: the camera guesses them where they were last seen, off by noise, and says so."""

    joints: tuple[SkeletonJoint, ...]
    from_s: float
    to_s: float
    noise_m: float = 0.04  # m per axis, as recorded while inferred
    seed: int = 0


@dataclass(frozen=True, slots=True)
class LegsExchanged:
    """Left is taken for right below the pelvis, and nothing says so."""

    from_s: float
    to_s: float


@dataclass(frozen=True, slots=True)
class JointJump:
    """In one frame a joint is far out and still called tracked."""

    joint: SkeletonJoint
    at_s: float
    by_m: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class BodyRenumbered:
    """From here on it is another body: the camera lost the person and found somebody."""

    at_s: float


CameraFault = CameraCovered | CameraSilent | FrameLoss | JointsInferred | LegsExchanged | JointJump | BodyRenumbered
