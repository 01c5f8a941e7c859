"""REST of recordings: list and download what the archive wrote."""

from http import HTTPStatus
from typing import Annotated, Literal

from fastapi import APIRouter, Path
from fastapi.responses import FileResponse
from pydantic import BaseModel, ConfigDict, Field

from services.gateway.access.rules import READ
from services.gateway.context import Context, Gateway, SessionId
from services.gateway.problems import Problem, documented
from services.gateway.recordings.folder import Recording, list_recordings
from services.gateway.sessions.records import get_session

router = APIRouter(prefix="/v1/sessions/{session}/recordings", tags=["recordings"])

MEDIA_TYPE = "application/vnd.mcap"
FileName = Annotated[str, Path(max_length=120, description="file name from the list", examples=["raw.mcap"])]


class RecordingOut(BaseModel):
    """One file."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(examples=["raw.mcap"])
    kind: Literal["raw", "derived"] = Field(description="sensors, or what was computed from them")
    complete: bool = Field(description="false while it is written, or until it is recovered")
    size_bytes: int = Field(ge=0, description="bytes", examples=[1_843_200])
    sha256: str | None = Field(description="hexadecimal; null until it is complete")


@router.get("", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def list_files(session: SessionId, gateway: Context) -> list[RecordingOut]:
    """The MCAP files of a session; any MCAP reader opens them."""
    return [
        RecordingOut(
            name=each.path.name,
            kind=each.kind,
            complete=each.complete,
            size_bytes=each.size_bytes,
            sha256=each.sha256,
        )
        for each in _recordings(gateway, session)
    ]


@router.get(
    "/{name}",
    dependencies=READ,
    response_class=FileResponse,
    responses={200: {"content": {MEDIA_TYPE: {}}, "description": "The file"}, **documented(HTTPStatus.NOT_FOUND)},
)
def download_file(session: SessionId, name: FileName, gateway: Context) -> FileResponse:
    """One MCAP file. A file that is still being written comes as far as it has got."""
    for each in _recordings(gateway, session):
        if each.path.name == name:
            return FileResponse(each.path, media_type=MEDIA_TYPE, filename=f"{session}-{name}")
    raise Problem(
        HTTPStatus.NOT_FOUND,
        f"Session {session} has no such file.",
        f"List its files with GET /v1/sessions/{session}/recordings.",
    )


def _recordings(gateway: Gateway, session: str) -> list[Recording]:
    with gateway.transaction() as database:
        get_session(database, session)
    return list_recordings(gateway.settings.data_dir, session)
