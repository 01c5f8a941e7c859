"""REST of FHIR: a session as a bundle, and the code systems that its codes are from."""

import json
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Path, Query, Request
from fastapi.responses import Response

from services.exports.fhir.bundle import MEDIA_TYPE, bundle
from services.exports.fhir.code_systems import CODE_SYSTEMS
from services.gateway.access.rules import KNOWN, READ
from services.gateway.context import Context, SessionId
from services.gateway.fhir.gather import fhir_source
from services.gateway.problems import Problem, documented
from services.report.content import Language

router = APIRouter(prefix="/v1", tags=["fhir"])

_FHIR: dict[int | str, dict[str, Any]] = {
    200: {"content": {MEDIA_TYPE: {}}, "description": "A FHIR R4 resource"}
}  # fmt: skip


@router.get(
    "/sessions/{session}/fhir",
    dependencies=READ,
    response_class=Response,
    responses={**_FHIR, **documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT, HTTPStatus.SERVICE_UNAVAILABLE)},
)
def read_bundle(
    session: SessionId,
    request: Request,
    gateway: Context,
    pdf: Annotated[bool, Query(description="false: without the printed report")] = True,
    language: Annotated[Language, Query(description="of the printed report", examples=["fr"])] = Language.ENGLISH,
) -> Response:
    """The session as one HL7 FHIR R4 bundle: patient code, devices, a number each, the report, a link to the recording.

    Observations are preliminary while the session runs. No free text that somebody typed is in it.
    """
    source = fhir_source(gateway, session, str(request.base_url), language if pdf else None)
    return _answer(bundle(source), f"ambula-{session}-fhir.json")


@router.get(
    "/fhir/CodeSystem/{name}",
    dependencies=KNOWN,
    response_class=Response,
    responses={**_FHIR, **documented(HTTPStatus.NOT_FOUND)},
)
def read_code_system(
    name: Annotated[str, Path(max_length=40, description="metrics or details", examples=["metrics"])],
) -> Response:
    """A CodeSystem of Ambula: `metrics` with definition and unit, or `details`, what is said beside their values."""
    if name not in CODE_SYSTEMS:
        raise Problem(
            HTTPStatus.NOT_FOUND, f"There is no CodeSystem {name}.", f"There are {' and '.join(CODE_SYSTEMS)}."
        )
    return _answer(CODE_SYSTEMS[name](), f"ambula-{name}.json")


def _answer(resource: dict[str, Any], file_name: str) -> Response:
    headers = {"content-disposition": f'inline; filename="{file_name}"'}
    return Response(json.dumps(resource, ensure_ascii=False), media_type=MEDIA_TYPE, headers=headers)
