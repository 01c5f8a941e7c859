"""Skeletons as they leave ingest: one person, m, axes of the room, one message per camera and frame (or few frames).

Axes: x horizontally to the camera, which the person faces; y up; z to the right of a person who faces the camera.
The origin is the camera.
"""

from typing import Self

from pydantic import Field, model_validator

from schemas.payload import Payload, SessionTime, Vector3
from schemas.standing import StandingMark
from schemas.vocabulary import TrackingState


class SkeletonBatch(Payload):
    """Frames of one camera, oldest first; joints in the order of the camera's description.

    A frame in which nobody is seen is a frame: all its joints are not tracked. A frame that never came is missing.
    """

    captured_ns: list[SessionTime]
    body: list[int | None] = Field(
        description="per frame: number of the body as counted by ingest; another one when the camera lost the person "
        "and may have found somebody else; null when nobody was followed"
    )
    people: list[int] = Field(description="per frame: number of bodies that the camera saw")
    position: list[list[Vector3 | None]] = Field(description="m, n x joints; null where the camera says nothing")
    state: list[list[TrackingState]] = Field(description="n x joints; not_tracked where position is null")
    marks: list[StandingMark] = Field(description="given since the message before; nearly always none")

    @model_validator(mode="after")
    def _same_length(self) -> Self:
        lists = (self.body, self.people, self.position, self.state)
        if any(len(each) != len(self.captured_ns) for each in lists):
            raise ValueError("captured_ns, body, people, position and state differ in length")
        return self
