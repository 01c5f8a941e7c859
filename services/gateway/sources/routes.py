"""REST of sources."""

from fastapi import APIRouter
from pydantic import BaseModel, ConfigDict, Field

from schemas.vocabulary import Task
from services.gateway.access.rules import READ
from services.gateway.context import Context
from services.gateway.control import SYNTHETIC_SOURCES, ControlUnavailable, SourceKind, Worn, worn_by
from services.gateway.problems import documented
from services.gateway.sessions.records import DEFAULT_ESTIMATOR, known_estimators
from services.gateway.sources.offered import offered_sources

router = APIRouter(prefix="/v1/sources", tags=["sources"])


class SourceOut(BaseModel):
    """Something that can be played."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(description="to be given to POST /v1/sessions", examples=["synthetic:walk?speed=1.2&seed=1"])
    title: str = Field(examples=["Walk, comfortable speed"])
    kind: SourceKind = Field(description="a device is there as long as it sends", examples=["synthetic"])
    duration_s: float | None = Field(description="s; null when unknown", examples=[120.0])
    worn: Worn | None = Field(description="what measures the person; null when unknown", examples=["lower_body"])
    task: Task | None = Field(description="what the person does; null when unknown", examples=["walk"])


class EstimatorOut(BaseModel):
    """A selectable estimator."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(examples=["rhythmic_ekf"])
    meaning: str = Field(examples=["EKF with the jerk of a rhythm model"])
    default: bool = Field(description="of a whole lower body; the others have defaults of their own")
    worn: Worn = Field(description="what it is made for", examples=["lower_body"])


class SourcesOut(BaseModel):
    """What can be started now."""

    model_config = ConfigDict(extra="forbid")

    ready: bool = Field(description="an ingest answers, so a session can be started")
    sources: list[SourceOut]
    estimators: list[EstimatorOut]


@router.get("", dependencies=READ, responses=documented())
def list_sources(gateway: Context) -> SourcesOut:
    """Devices that send to the ingest, recordings that it has at hand, and the simulated people."""
    try:
        offered, ready = offered_sources(gateway), True
    except ControlUnavailable:
        offered, ready = [], False
    sources = [
        SourceOut(
            id=each.id,
            title=each.title,
            kind=each.kind,
            duration_s=each.duration_s,
            worn=each.worn,
            task=each.task,
        )
        for each in (*offered, *SYNTHETIC_SOURCES)
    ]
    estimators = [
        EstimatorOut(
            name=name,
            meaning=meaning,
            default=name == DEFAULT_ESTIMATOR,
            worn=worn_by(name),
        )
        for name, meaning in known_estimators().items()
    ]
    return SourcesOut(ready=ready, sources=sources, estimators=estimators)
