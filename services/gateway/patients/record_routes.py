"""REST of a record as a whole: joined with another, taken away."""

import json
from collections.abc import Iterator
from http import HTTPStatus

from fastapi import APIRouter, Request
from fastapi.responses import StreamingResponse
from sqlalchemy import select
from sqlalchemy.orm import Session

from services.exports.fhir.bundle import bundle
from services.gateway.access.confirmation import Confirmed
from services.gateway.access.roles import Permission
from services.gateway.access.rules import WORK, needs
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.statements import OutOfScope
from services.gateway.audit import export as audit_export
from services.gateway.audit.noting import Noted, note
from services.gateway.audit.tables import AuditRow
from services.gateway.context import Context, Gateway, PatientCode
from services.gateway.directory.cipher import DirectoryUnusable
from services.gateway.fhir.gather import fhir_source
from services.gateway.patients.merging import conflicting_facts, merge
from services.gateway.patients.record_models import MergedOut, MergeIn
from services.gateway.patients.records import get_patient
from services.gateway.patients.routes import read_patient
from services.gateway.patients.taking_away import Part, as_json, zipped
from services.gateway.problems import Problem, documented
from services.gateway.recordings.folder import list_recordings
from services.gateway.recycling.records import sessions_of
from services.gateway.recycling.routes import check_ended
from services.gateway.tables import PatientRow, TreatmentRow

router = APIRouter(prefix="/v1/patients", tags=["patients"])

SAME = "A record is joined with another one."


@router.post(
    "/{code}/merge",
    dependencies=[needs(Permission.ADMINISTER)],
    responses=documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT, HTTPStatus.SERVICE_UNAVAILABLE),
)
def merge_patient(code: PatientCode, body: MergeIn, gateway: Context, request: Request, _: Confirmed) -> MergedOut:
    """Bring everything of a record under another code of the same person; the first code is gone afterwards.

    Facts that contradict each other are to be corrected first. Asks for the password once more.
    """
    note(request, Noted(reason=body.reason))
    _check_mergeable(gateway, code, body.into)
    note(request, Noted(patients=(code, body.into), object=f"from={code} into={body.into}", reason=body.reason))
    _bring_name_along(gateway, code, body.into)
    # Sessions in the bin move, too, and no scope has both.
    with gateway.database.transaction(EVERYTHING) as database:
        gone, stays = database.get_one(PatientRow, code), database.get_one(PatientRow, body.into)
        moved = merge(database, gone, stays)
    _forget_name(gateway, code)
    return MergedOut(patient=body.into, sessions=len(moved))


@router.get(
    "/{code}/export",
    dependencies=WORK,
    response_class=StreamingResponse,
    responses={
        200: {"content": {"application/zip": {}}, "description": "The archive"},
        **documented(HTTPStatus.NOT_FOUND),
    },
)
def export_patient(code: PatientCode, gateway: Context, request: Request) -> StreamingResponse:
    """Everything that is known of a patient but the name, as a zip: FHIR bundles, recordings, treatments, audit."""
    patient = read_patient(code, gateway)
    with gateway.transaction() as database:
        rows = sessions_of(database, code)
        treatments = _treatments(database, code)
        over = [(row.id, row.metrics is not None and row.description is not None) for row in rows]
    site = str(request.base_url)
    parts: list[Part] = [
        ("patient.json", None, as_json(patient.model_dump(mode="json"))),
        ("treatments.json", None, as_json(treatments)),
        ("audit.ndjson", None, lambda: _audit(gateway, code)),
    ]
    for session, has_numbers in over:
        parts += _of_session(gateway, session, site, has_numbers=has_numbers)
    headers = {"content-disposition": f'attachment; filename="ambula-{code}.zip"'}
    return StreamingResponse(zipped(parts, gateway.eraser.outgoing), media_type="application/zip", headers=headers)


def _of_session(gateway: Gateway, session: str, site: str, *, has_numbers: bool) -> list[Part]:
    def fhir() -> Iterator[bytes]:
        yield json.dumps(bundle(fhir_source(gateway, session, site, None)), ensure_ascii=False).encode()

    files = list_recordings(gateway.settings.data_dir, session)
    recordings: list[Part] = [(f"sessions/{session}/{each.path.name}", session, each.path) for each in files]
    return [*([(f"sessions/{session}/fhir.json", session, fhir)] if has_numbers else []), *recordings]


def _treatments(database: Session, code: str) -> list[dict[str, str]]:
    rows = database.scalars(select(TreatmentRow).where(TreatmentRow.patient_code == code).order_by(TreatmentRow.on))
    return [{"date": row.on.isoformat(), "kind": row.what} for row in rows]


def _audit(gateway: Gateway, code: str) -> Iterator[bytes]:
    return audit_export.as_ndjson(gateway.transaction, [AuditRow.patient == code], [])


def _check_mergeable(gateway: Gateway, code: str, into: str) -> None:
    if code == into:
        raise Problem(HTTPStatus.CONFLICT, SAME, "Name the code that stays.")
    with gateway.transaction() as database:
        gone, stays = get_patient(database, code), get_patient(database, into)
        if {gone.clinic_id, stays.clinic_id} != {gateway.known_caller.clinic}:
            raise OutOfScope("records are joined in their own clinic alone")
        check_ended(gateway, [*sessions_of(database, code), *sessions_of(database, into)])
        different = conflicting_facts(gone, stays)
    if different:
        detail = f"The two differ in {' and '.join(different)}: they may not be one person."
        raise Problem(HTTPStatus.CONFLICT, detail, f"Correct the wrong one with PATCH /v1/patients/{code} first.")


def _bring_name_along(gateway: Gateway, code: str, into: str) -> None:
    """The name of the code that stays stays; where it has none, the other's comes along."""
    try:
        known = dict(gateway.directory.find([code, into]))
        if code in known and into not in known:
            gateway.directory.put(into, known[code])
    except DirectoryUnusable as error:
        step = "Nothing was joined. An administrator finds the key file under AMBULA_DIRECTORY_KEY_FILE."
        raise Problem(HTTPStatus.SERVICE_UNAVAILABLE, str(error), step) from error


def _forget_name(gateway: Gateway, code: str) -> None:
    place = gateway.directory.place_of(code)
    if place is not None:
        gateway.directory.remove([place])
