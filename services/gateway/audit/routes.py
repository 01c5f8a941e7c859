"""REST of the audit."""

from datetime import date
from typing import Annotated

from fastapi import APIRouter, Query, Request
from fastapi.responses import StreamingResponse

from services.exports.fhir.bundle import MEDIA_TYPE
from services.gateway.access.roles import Permission
from services.gateway.access.rules import needs
from services.gateway.access.scope import EVERYTHING
from services.gateway.audit import export, records
from services.gateway.audit.heads import Heads, HeadsUnusable, SignedHead
from services.gateway.audit.models import AuditPage, ExportFormat, VerificationOut
from services.gateway.audit.noting import Noted, note
from services.gateway.audit.verification import verify
from services.gateway.context import Context, Limit, Offset
from services.gateway.problems import documented

router = APIRouter(prefix="/v1/audit", tags=["audit"], dependencies=[needs(Permission.ADMINISTER)])

DAY = "2026-11-22"
From = Annotated[date | None, Query(alias="from", description="UTC day of the earliest", examples=[DAY])]
To = Annotated[date | None, Query(alias="to", description="UTC day of the latest", examples=[DAY])]
Actor = Annotated[str | None, Query(pattern="^[A-Za-z0-9_-]{1,32}$", description="id of an account or key")]
PatientOf = Annotated[str | None, Query(pattern="^[0-9A-Z]{1,16}$", description="patient code")]
Action = Annotated[
    str | None, Query(pattern="^[a-z0-9_]{1,64}$", description="name of an operation", examples=["read_patient"])
]

Format = Annotated[ExportFormat, Query(alias="format", description="fhir: a Bundle of AuditEvents")]


@router.get("", responses=documented())
def list_audit(
    gateway: Context,
    from_day: From = None,
    to_day: To = None,
    actor: Actor = None,
    patient: PatientOf = None,
    action: Action = None,
    offset: Offset = 0,
    limit: Limit = 50,
) -> AuditPage:
    """What the clinic's people did, and what others did with its patients, newest first."""
    wanted = records.Wanted(from_day, to_day, actor, patient, action)
    with gateway.transaction() as database:
        seen = records.seen_by(gateway.known_caller)
        total, rows = records.list_entries(database, seen, wanted, offset, limit)
        return AuditPage(total=total, items=[export.shape(row) for row in rows])


@router.get("/verification", responses=documented())
def verify_audit(gateway: Context) -> VerificationOut:
    """Walk the whole chain, of all clinics, and compare it with the heads that were signed."""
    try:
        heads, trouble = Heads(gateway.settings.own_dir).read(), None
    except HeadsUnusable as error:
        heads, trouble = [], str(error)
    with gateway.database.transaction(EVERYTHING) as database:
        verdict = verify(database, heads)
    return VerificationOut(
        intact=verdict.broken is None and trouble is None,
        entries=verdict.entries,
        broken_entry=verdict.broken,
        fault=verdict.fault or trouble,
        signed_entry=None if verdict.signed is None else verdict.signed.number,
        signed_at=None if verdict.signed is None else verdict.signed.at,
    )


@router.get(
    "/export",
    response_class=StreamingResponse,
    responses={
        200: {"content": {"application/x-ndjson": {}, MEDIA_TYPE: {}}, "description": "The entries"},
        **documented(),
    },
)
def export_audit(
    gateway: Context,
    request: Request,
    from_day: From = None,
    to_day: To = None,
    export_format: Annotated[
        ExportFormat, Query(alias="format", description="fhir: a Bundle of AuditEvents")
    ] = "ndjson",
) -> StreamingResponse:
    """The entries that one may read, in the chain's order, as lines of JSON or as FHIR R4 AuditEvents."""
    note(request, Noted(object=export_format))
    conditions = [records.seen_by(gateway.known_caller), *records.Wanted(from_day, to_day).conditions()]
    if export_format == "fhir":
        content, media_type, ending = export.as_fhir(gateway.transaction, conditions), MEDIA_TYPE, "json"
    else:
        heads = _heads_if_usable(Heads(gateway.settings.own_dir))
        content = export.as_ndjson(gateway.transaction, conditions, heads)
        media_type, ending = "application/x-ndjson", "ndjson"
    headers = {"content-disposition": f'attachment; filename="ambula-audit.{ending}"'}
    return StreamingResponse(content, media_type=media_type, headers=headers)


def _heads_if_usable(heads: Heads) -> list[SignedHead]:
    # What is wrong with them is for the verification to tell; the entries can be had all the same.
    try:
        return heads.read()
    except HeadsUnusable:
        return []
