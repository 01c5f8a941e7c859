"""Every dial of a simulated depth camera and of the tasks before it."""

from dataclasses import dataclass
from typing import ClassVar

from services.ingest.synthetic.dials import Dials, dial


@dataclass(frozen=True)
class CameraParameters(Dials):
    """A Kinect v2 in front of the person."""

    noise: float = dial(1.0, 0.0, 1.0, "share of a clinic's noise and faults; 0 is a perfect camera")
    frame_rate: float = dial(30.0, 5.0, 60.0, "frames/s")
    jitter: float = dial(0.002, 0.0, 0.005, "s, standard deviation of a frame's time")
    camera_height: float = dial(1.0, 0.2, 2.5, "m above the floor")
    distance: float = dial(2.5, 1.0, 6.0, "m from the camera to the person")
    drops: float = dial(0.02, 0.0, 0.5, "share of frames that never come, at full noise")
    swap_every: float = dial(30.0, 0.0, 3600.0, "s, mean between exchanges of the legs at full noise; 0 never")
    passer_at: float = dial(0.0, 0.0, 8 * 3600.0, "s at which somebody passes between camera and person; 0 never")
    passer_for: float = dial(3.0, 0.5, 60.0, "s that the passer is in view")


NO_CAMERA, CAMERA_TOO, CAMERA_ALONE = 0, 1, 2


@dataclass(frozen=True)
class BesideSensorsParameters(CameraParameters):
    """A camera in front of somebody on a treadmill or on the spot, who wears inertial sensors or none."""

    camera: int = dial(0, 0, 2, "0 none, 1 beside the sensors, 2 without them")
    posture: float = dial(0.0, 0.0, 2.0, "times what people's standing differs from the straight body, drawn by seed")
    camera_away_at: float = dial(0.0, 0.0, 8 * 3600.0, "s at which the person leaves the camera's view; 0 never")
    camera_away_for: float = dial(5.0, 0.1, 600.0, "s out of view")
    imu_away_at: float = dial(0.0, 0.0, 8 * 3600.0, "s at which all inertial sensors fall silent; 0 never")
    imu_away_for: float = dial(5.0, 0.1, 600.0, "s of silence")


@dataclass(frozen=True)
class TaskParameters(CameraParameters):
    """Repetitions of a task before the camera; without a word about it all is the person's own."""

    seed: int = dial(0, 0, 2**31, "of everything random but the person")
    person: int = dial(1, 0, 2**31, "size, standing posture and manner are drawn by this number")
    standing: float = dial(3.0, 0.0, 600.0, "s of standing at the start; 0 begins within a repetition")
    repetitions: int = dial(10, 1, 500, "there and back, of a task of two sides to the right and to the left")
    tempo: float = dial(0.0, 0.0, 60.0, "repetitions per minute, holds and pauses included; 0 is the person's own")
    amplitude: float = dial(0.0, 0.0, 1.3, "times the usual range; 0 is the person's own")
    away_at: float = dial(0.0, 0.0, 8 * 3600.0, "s at which the person leaves the camera's view; 0 never")
    away_for: float = dial(5.0, 0.1, 600.0, "s out of view")
    hold: float = dial(0.0, 0.0, 15.0, "s that the far side is held")
    pause: float = dial(0.0, 0.0, 20.0, "s of standing after each repetition, beside the person's own")
    set_of: int = dial(0, 0, 500, "repetitions in a set; 0 makes one set of all")
    rest: float = dial(5.0, 0.0, 600.0, "s of standing between sets")
    partials: float = dial(0.0, 0.0, 0.5, "share of repetitions that go less than half as far")
    fatigue: float = dial(0.0, 0.0, 0.8, "share of the range that is lost by the end")
    slowing: float = dial(0.0, 0.0, 0.8, "share of the tempo that is lost by the end")
    truth: int = dial(1, 0, 1, "0 leaves out the reference stream")


@dataclass(frozen=True)
class SidedParameters(TaskParameters):
    """A task in which the sides may differ."""

    asymmetry: float = dial(0.0, 0.0, 0.5, "share by which the left side moves less, or the trunk to it")


@dataclass(frozen=True)
class SquatParameters(SidedParameters):
    """Squats, the arms raised to the sides."""

    motion: ClassVar[str] = "squat"


@dataclass(frozen=True)
class StepsParameters(SidedParameters):
    """Stepping on the spot, the right knee up and then the left."""

    motion: ClassVar[str] = "steps"


@dataclass(frozen=True)
class TiltForwardParameters(TaskParameters):
    """Bows."""

    motion: ClassVar[str] = "tilt_forward"


@dataclass(frozen=True)
class TiltAsideParameters(SidedParameters):
    """Leaning to the right and then to the left."""

    motion: ClassVar[str] = "tilt_aside"
