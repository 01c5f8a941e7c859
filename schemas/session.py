"""What a session is: who measures what, on which body, with which parameters. No identity of a person."""

from enum import StrEnum
from typing import Any, Literal, Self

from pydantic import Field, model_validator

from schemas.conditions import UNSAID, Conditions
from schemas.payload import Payload, Vector3
from schemas.rhythm import KnownRhythm
from schemas.vocabulary import CameraKind, Segment, SkeletonJoint, Task


class Placement(StrEnum):
    """Side of the segment a sensor is strapped to: where its outward axis points, anatomically."""

    ANTERIOR = "anterior"
    POSTERIOR = "posterior"
    LATERAL = "lateral"
    MEDIAL = "medial"
    UNKNOWN = "unknown"


class SensorDescription(Payload):
    """One inertial sensor and where it is worn."""

    name: str = Field(description="unique within the session")
    segment: Segment
    rate_hz: float = Field(gt=0, description="nominal sample rate, Hz")
    outward_axis: Vector3 = Field(description="unit vector in the sensor frame that points out of the skin")
    upward_axis: Vector3 | None = Field(
        description="unit vector in the sensor frame that points up the segment when worn as intended; null: any"
    )
    placement: Placement
    position_in_segment: Vector3 | None = Field(
        description="m from the segment's proximal joint, segment frame; null when unknown"
    )

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Earlier ones did not say which way up a sensor is worn."""
        return {"upward_axis": None, **fields} if isinstance(fields, dict) else fields


class HubDescription(Payload):
    """One receiver: everything it delivers shares its clock and travels in one stream."""

    name: str
    sensors: list[SensorDescription]


class CameraDescription(Payload):
    """One depth camera; what it delivers is a stream of its own."""

    name: str = Field(description="unique within the session, also among hubs")
    kind: CameraKind
    rate_hz: float = Field(gt=0, description="nominal frame rate, Hz")
    joints: list[SkeletonJoint] = Field(description="those of every frame, in order; each at most once")
    floor_m: float | None = Field(description="m, height of the floor; negative below the camera; null when unknown")


class Anthropometry(Payload):
    """Body dimensions used by the model."""

    height_m: float | None = Field(gt=0, description="m")
    mass_kg: float | None = Field(gt=0, description="kg")
    thigh_length_m: float = Field(gt=0, description="m, hip centre to knee centre")
    shank_length_m: float = Field(gt=0, description="m, knee centre to ankle centre")
    hip_width_m: float = Field(gt=0, description="m, between the hip centres")
    source: Literal["measured", "regression", "default"]


WalkPath = Literal["turning", "straight"]
"""Whether the person may turn. `turning`: thighs keep their heading against the pelvis, the body goes where it will.
`straight`: pelvis and thighs keep the heading in which the person stood: on a treadmill, in place, along a corridor."""


class StandingInterval(Payload):
    """A span that the operator marked as quiet standing."""

    from_ns: int = Field(description="ns since the session started")
    to_ns: int = Field(description="ns since the session started")


class ReferenceChannel(Payload):
    """A channel of truth that came with the recording; never seen by an estimator."""

    name: str
    unit: str = Field(description="SI unit of the values")


class SessionDescription(Payload):
    """Everything a node needs to know before the first sample."""

    session: str = Field(description="random id")
    title: str
    started_unix_ns: int = Field(description="ns since the Unix epoch at session time zero")
    origin: Literal["recording", "archive", "synthetic", "device"]
    protocol: str
    task: Task = Field(description="what the person is asked to do")
    walkway_m: float | None = Field(
        gt=0, le=100, description="m from start to turning point of a timed test, or to its end where nobody turns"
    )
    conditions: Conditions
    estimator: str = Field(description="a name of vocabulary.ESTIMATORS")
    walk_path: WalkPath = Field(description="turning: anywhere; straight: treadmill, in place, corridor without a turn")
    hubs: list[HubDescription]
    cameras: list[CameraDescription]
    anthropometry: Anthropometry
    standing: list[StandingInterval]
    reference: list[ReferenceChannel]
    duration_s: float | None = Field(description="s; null for a live source")
    known_rhythms: list[KnownRhythm] = Field(
        max_length=3,
        description="learned before this session, at most one of each kind; the rhythm starts from the person's own",
    )

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """A session from before these fields existed knew no rhythm nor camera, was a walk, and anybody might turn."""
        before: dict[str, Any] = {
            "known_rhythms": [],
            "walk_path": "turning",
            "task": Task.WALK,
            "walkway_m": None,
            "conditions": UNSAID,
            "cameras": [],
        }
        return {**before, **fields} if isinstance(fields, dict) else fields

    @model_validator(mode="after")
    def _one_of_each_kind(self) -> Self:
        kinds = [known.kind for known in self.known_rhythms]
        if len(set(kinds)) < len(kinds):
            raise ValueError("known_rhythms: at most one previous trial, one previous visit and one exemplar")
        return self
