"""What a person did of a task: phases of a timed test, repetitions of an exercise."""

from typing import Any

from pydantic import Field, model_validator

from schemas.payload import Payload, SessionTime
from schemas.vocabulary import Side, Task, TaskPhaseKind


class TaskPhase(Payload):
    """One phase of a timed test. Sent when it begins, with `end_ns` null, and again when it has ended.

    A phase that was given up ends where it was last seen, with `end_std_s` null. What was done in it stands in the
    message that ends it. Phases of a ten-metre walk are told a last time when the whole of it is known: the newest
    message of an attempt and phase holds.
    """

    task: Task
    attempt: int = Field(ge=0, description="count of this task's attempts since the session started")
    phase: TaskPhaseKind
    start_ns: SessionTime
    start_std_s: float = Field(ge=0, description="s, one standard deviation of the start")
    end_ns: SessionTime | None
    end_std_s: float | None = Field(ge=0, description="s, one standard deviation of the end")
    largest_turn_rate: float | None = Field(ge=0, description="rad/s, of the heading, either way, over 0.4 s")
    largest_thigh_rate: float | None = Field(
        ge=0, description="rad/s, of the thighs' inclination, in rising or sitting"
    )
    steps: int | None = Field(ge=0, description="number of steps of both legs; null unless both shanks are seen")
    distance_m: float | None = Field(ge=0, description="m walked in it; null where it was not measured")
    distance_std_m: float | None = Field(ge=0, description="m, one standard deviation")
    speed_change: float | None = Field(
        description="m/s, mean speed over the second half of its distance minus that over the first; null: not known"
    )

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Earlier ones told the times alone, then no distances, then no change of speed."""
        names = (
            "largest_turn_rate", "largest_thigh_rate", "steps", "distance_m", "distance_std_m", "speed_change"
        )  # fmt: skip
        unknown = dict.fromkeys(names)
        return {**unknown, **fields} if isinstance(fields, dict) else fields


class Repetition(Payload):
    """One repetition of an exercise: there and back of the movement that is followed."""

    degree_of_freedom: str = Field(description="what is followed: a degree of freedom, or one of vocabulary.MOVEMENTS")
    side: Side | None = Field(description="null for a movement of both sides or of the trunk")
    index: int = Field(ge=0, description="count of this movement's repetitions since the session started")
    start_ns: SessionTime
    turn_ns: SessionTime = Field(description="the angle farthest from both ends")
    end_ns: SessionTime
    start_angle: float = Field(description="rad")
    turn_angle: float = Field(description="rad")
    end_angle: float = Field(description="rad")
    angle_std: float = Field(ge=0, description="rad, mean standard deviation of the angle")
    largest_velocity: float = Field(ge=0, description="rad/s, either way")
    hold_s: float | None = Field(ge=0, description="s at the turn, within 5 % of the range; null where not measured")
    ranges: dict[str, float] = Field(
        description="rad, largest minus smallest angle of every valid degree of freedom; empty where one alone is seen"
    )
    valid: bool
    rejected_because: str | None = Field(description="why a repetition does not count in metrics")

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Earlier ones followed one knee and told nothing else of it."""
        return {"hold_s": None, "ranges": {}, **fields} if isinstance(fields, dict) else fields
