"""What estimation says of the body: joint states, the calibrated model and the picture of it for a screen."""

from typing import Any

from pydantic import Field, model_validator

from schemas.payload import Payload, QuaternionWXYZ, SessionTime, Vector3
from schemas.vocabulary import EventSource, JointCentre, Misplacement, Segment, SensorState, Side


class JointState(Payload):
    """Joint coordinates of one batch of samples, in the order of BODY_MODELS[model]."""

    model: str
    captured_ns: list[SessionTime]
    position: list[list[float]] = Field(description="rad, n x dof")
    velocity: list[list[float]] = Field(description="rad/s, n x dof")
    acceleration: list[list[float]] = Field(description="rad/s^2, n x dof")
    position_std: list[list[float]] = Field(description="rad, n x dof, one standard deviation")
    velocity_std: list[list[float]] = Field(description="rad/s, n x dof, one standard deviation")
    valid: list[bool] = Field(description="per dof: false while no sensor observes it or before calibration")
    observed: list[Segment] = Field(
        description="segments with a sensor of their own: the whole chain of angles gives their tilt in the world "
        "rightly, also where the joints between them and the pelvis are not valid one by one",
    )


class JointCentres(Payload):
    """Where the joint centres are as estimated, in the order of JointCentre, in the axes of the skeleton's room."""

    captured_ns: list[SessionTime]
    position: list[list[Vector3]] = Field(description="m, n x 15")
    seen: list[bool] = Field(description="per centre: the camera has seen it in the last moments")


class SegmentSamples(Payload):
    """How one segment moves, at its sensor, in its heading frame: x forward, y up, z right.

    The frame turns with the segment's own heading, but neither with tilt nor with obliquity: z is the segment's
    right made level. So no heading has to be known in the world.
    """

    segment: Segment
    captured_ns: list[SessionTime]
    acceleration: list[Vector3] = Field(description="m/s^2, without gravity")
    angular_velocity: list[Vector3] = Field(description="rad/s")


class SegmentMotion(Payload):
    """Motion of segments whose sensor alone tells the gait events of a leg; message for message beside joint_state."""

    captured_ns: list[SessionTime] = Field(description="those of the joint state; not every segment has a sample each")
    segments: list[SegmentSamples]


class SensorAlignment(Payload):
    """How one sensor sits on its segment, and how sure that is."""

    sensor: str
    segment: Segment
    quat_segment_from_sensor: QuaternionWXYZ = Field(description="rotation, dimensionless")
    gyro_bias: Vector3 = Field(description="rad/s, sensor frame")
    quality: float = Field(ge=0, le=1, description="0 a guess, 1 certain")


class Calibration(Payload):
    """The calibrated body: published once when the estimator starts to estimate, and after each change."""

    model: str
    estimator: str
    method: str = Field(description="what the alignment rests on, e.g. standing+walking")
    datum: str = Field(description="what zero means, e.g. quiet standing, both segments vertical")
    quality: float = Field(ge=0, le=1, description="the worst sensor's quality")
    sensors: list[SensorAlignment]
    events_from: dict[Side, EventSource] = Field(description="what tells the gait events of each leg")
    unused: dict[str, str] = Field(description="sensors that are not used, and why, by name")
    misplaced: dict[Side, list[Misplacement]] = Field(description="legs whose sensors are worn otherwise than declared")
    lengths: dict[str, float] = Field(description="m, of segments as estimated, by name; empty where none is estimated")
    absolute: bool = Field(
        description="whether angles refer to a known posture; if not, each carries an unknown constant offset"
    )

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Earlier ones did not say what told the events, what was left out, nor what was worn otherwise; they had a
        known posture and took lengths as given."""
        before = {"events_from": {}, "unused": {}, "misplaced": {}, "lengths": {}, "absolute": True}
        return {**before, **fields} if isinstance(fields, dict) else fields


class SegmentPose(Payload):
    """Where a bone is drawn."""

    segment: Segment
    position: Vector3 = Field(description="m, proximal joint in the world, pelvis at the origin of x and z")
    quat_world_from_segment: QuaternionWXYZ = Field(description="rotation, dimensionless")
    valid: bool


class SensorStatus(Payload):
    """State of one sensor for the screen."""

    sensor: str
    state: SensorState
    since_ns: SessionTime


class CameraStatus(Payload):
    """State of one camera for the screen."""

    camera: str
    state: SensorState
    people: int = Field(ge=0, description="number of bodies in view")
    since_ns: SessionTime


class LivePose(Payload):
    """The view: 20-30 Hz, best effort, not archived."""

    captured_ns: SessionTime
    phase: str = Field(description="waiting, calibrating or estimating")
    message: str = Field(description="what the therapist should do or know; empty when all is well")
    notice: str = Field(description="what became of her last mark, for some seconds; else empty")
    segments: list[SegmentPose]
    angles: dict[str, float] = Field(description="rad, by degree of freedom; only valid ones")
    angles_std: dict[str, float] = Field(description="rad, by degree of freedom; only valid ones")
    sensors: list[SensorStatus]
    centres: dict[JointCentre, Vector3] = Field(
        description="m, joint centres of a body that a camera sees, in the axes of the skeleton's room; else empty"
    )
    cameras: list[CameraStatus]
    cadence_per_min: float | None = Field(description="steps per minute while the rhythm is locked")
    stood: float | None = Field(
        ge=0, le=1, description="share of the standing still that is needed, so far; null where none is waited for"
    )
