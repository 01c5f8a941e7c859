"""REST of exports: what can be had of a session, and the files."""

import os
from http import HTTPStatus
from typing import Annotated, Literal

from fastapi import APIRouter, Path, Query
from fastapi.responses import StreamingResponse

from services.exports.formats import FORMATS, Options, file_name, why_not
from services.exports.opensim.models import known_model
from services.gateway.access.rules import READ
from services.gateway.context import Context, SessionId
from services.gateway.exports.models import ExportOut, ExportsOut
from services.gateway.exports.recording import Recorded, recorded
from services.gateway.exports.writing import blocks, written
from services.gateway.problems import Problem, documented

router = APIRouter(prefix="/v1/sessions/{session}/exports", tags=["exports"])

FormatName = Annotated[str, Path(max_length=40, description="a format of the list", examples=["strides.csv"])]
ModelName = Annotated[
    Literal["rajagopal", "gait10dof18musc"], Query(description="OpenSim model whose coordinates mot and sto have")
]


@router.get("", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def list_exports(session: SessionId, gateway: Context) -> ExportsOut:
    """Every format, and why one cannot be had."""
    of = recorded(gateway, session)
    items = [
        ExportOut(
            format=name,
            file_name=file_name(session, name),
            media_type=each.media_type,
            about=each.about,
            available=_reason(of, name) is None,
            reason=_reason(of, name),
        )
        for name, each in FORMATS.items()
    ]
    return ExportsOut(session=session, software=of.software, items=items)


@router.get(
    "/{name}",
    dependencies=READ,
    response_class=StreamingResponse,
    responses={
        200: {"content": {"application/octet-stream": {}}, "description": "The file"},
        **documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT, HTTPStatus.SERVICE_UNAVAILABLE),
    },
)
def download_export(
    session: SessionId, name: FormatName, gateway: Context, model: ModelName = "rajagopal"
) -> StreamingResponse:
    """One file, written from the archive. One is written at a time; 503 while another is."""
    of = recorded(gateway, session)
    listed = f"See which can be had with GET /v1/sessions/{session}/exports."
    if name not in FORMATS:
        raise Problem(HTTPStatus.NOT_FOUND, f"There is no format {name}.", listed)
    reason = _reason(of, name)
    if reason is not None:
        raise Problem(HTTPStatus.CONFLICT, f"{name} of session {session} cannot be had: {reason}.", listed)
    file = written(of, name, Options(known_model(model)))
    headers = {
        "content-disposition": f'attachment; filename="{file_name(session, name)}"',
        "content-length": str(os.fstat(file.fileno()).st_size),
    }
    return StreamingResponse(
        blocks(file, session, gateway.eraser.outgoing), media_type=FORMATS[name].media_type, headers=headers
    )


def _reason(of: Recorded, name: str) -> str | None:
    return of.trouble or why_not(name, of.signals, of.estimator)
