"""REST of erasing."""

from datetime import UTC, datetime
from http import HTTPStatus

from fastapi import APIRouter, Request

from services.gateway.access.confirmation import Confirmed
from services.gateway.access.roles import Permission
from services.gateway.access.rules import needs
from services.gateway.access.statements import OutOfScope
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Context, Gateway, PatientCode
from services.gateway.erasure.models import ErasureIn, ErasureOut
from services.gateway.problems import Problem, documented, not_found
from services.gateway.recycling.records import sessions_of
from services.gateway.recycling.routes import check_ended
from services.gateway.tables import PatientRow

router = APIRouter(prefix="/v1/patients", tags=["erasure"], dependencies=[needs(Permission.ADMINISTER)])


@router.post(
    "/{code}/erasure",
    responses=documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT, HTTPStatus.SERVICE_UNAVAILABLE),
)
def erase_patient(code: PatientCode, body: ErasureIn, gateway: Context, request: Request, _: Confirmed) -> ErasureOut:
    """Erase a patient for good, in the bin or not: sessions, recordings, numbers, treatments, name.

    What stays is the audit, which names codes, and a line in the list of erasures, so that no backup brings them back.
    Asks for the password once more. Not while a session runs.
    """
    note(request, Noted(reason=body.reason))
    sessions = _sessions_to_erase(gateway, code)
    now, by = datetime.now(UTC), gateway.known_caller.account
    try:
        left = gateway.eraser.erase(code, sessions, by, body.reason, now)
    except OSError as error:
        detail = f"Nothing was erased: the list of erasures can not be written ({error.strerror})."
        raise Problem(HTTPStatus.SERVICE_UNAVAILABLE, detail, "Make room in the gateway's own folder.") from error
    return ErasureOut(sessions=len(sessions), recordings_left=left)


def _sessions_to_erase(gateway: Gateway, code: str) -> list[str]:
    caller, found, known = gateway.known_caller, [], False
    for scope in (caller.scope, caller.bin):
        with gateway.database.transaction(scope) as database:
            patient = database.get(PatientRow, code)
            if patient is not None and patient.clinic_id != caller.clinic:
                raise OutOfScope("a shared patient is erased by their own clinic alone")
            known = known or patient is not None
            rows = sessions_of(database, code)
            check_ended(gateway, rows)
            found += [row.id for row in rows]
    if not known:
        raise not_found("patient", code)
    return found
