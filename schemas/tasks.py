"""What a person did of a task: phases of a timed test, repetitions of an exercise."""

from pydantic import Field

from schemas.payload import Payload, SessionTime
from schemas.vocabulary import Side, Task, TaskPhaseKind


class TaskPhase(Payload):
    """One phase of a timed test. Sent when it begins, with `end_ns` null, and again when it has ended."""

    task: Task
    attempt: int = Field(ge=0, description="count of this task's attempts since the session started")
    phase: TaskPhaseKind
    start_ns: SessionTime
    start_std_s: float = Field(ge=0, description="s, one standard deviation of the start")
    end_ns: SessionTime | None
    end_std_s: float | None = Field(ge=0, description="s, one standard deviation of the end")


class Repetition(Payload):
    """One repetition of an exercise of one joint: there and back."""

    degree_of_freedom: str
    side: Side
    index: int = Field(ge=0, description="count of this joint's repetitions since the session started")
    start_ns: SessionTime
    turn_ns: SessionTime = Field(description="the angle farthest from both ends")
    end_ns: SessionTime
    start_angle: float = Field(description="rad")
    turn_angle: float = Field(description="rad")
    end_angle: float = Field(description="rad")
    angle_std: float = Field(ge=0, description="rad, mean standard deviation of the angle")
    largest_velocity: float = Field(ge=0, description="rad/s, either way")
    valid: bool
    rejected_because: str | None = Field(description="why a repetition does not count in metrics")
