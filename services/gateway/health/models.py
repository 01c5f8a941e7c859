"""What the API says of the services."""

from pydantic import BaseModel, ConfigDict, Field

from schemas.health import Readiness, Rejection, SessionHealth


class ServiceHealth(BaseModel):
    """One instance of one service."""

    model_config = ConfigDict(extra="forbid")

    service: str = Field(examples=["estimation"])
    instance: str = Field(description="random id of the process", examples=["4f2a"])
    age_s: float = Field(ge=0, description="s since it reported", examples=[0.4])
    stale: bool = Field(description="it should have reported again by now")
    uptime_s: float = Field(ge=0, description="s", examples=[812.0])
    cpu_s: float = Field(ge=0, description="s of processor time", examples=[41.5])
    rss_bytes: int = Field(ge=0, description="resident memory, bytes", examples=[91_000_000])
    queue_length: int = Field(ge=0, description="number of messages waiting", examples=[0])
    queue_capacity: int = Field(ge=0, description="number of messages that may wait", examples=[1024])
    queue_dropped: int = Field(ge=0, description="number of messages dropped", examples=[0])
    errors: int = Field(ge=0, description="number of unexpected exceptions", examples=[0])
    rejections: list[Rejection] = Field(description="what could not be tied to a session")
    sessions: list[SessionHealth] = Field(description="what it says of each session")
    readiness: Readiness = Field(description="ready, or what it still does before it works", examples=["ready"])


class HealthOut(BaseModel):
    """How the site is."""

    model_config = ConfigDict(extra="forbid")

    connected: bool = Field(description="at least one other service is heard")
    database: bool = Field(description="the database answers")
    pages: bool = Field(description="the web pages are built")
    silent: list[str] = Field(description="needed services that are not heard", examples=[[]])
    preparing: list[str] = Field(
        description="needed services that compile what they run, and work after", examples=[[]]
    )
    services: list[ServiceHealth]
