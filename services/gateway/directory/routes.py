"""REST of names. They travel in bodies only, and what is noted of a request are patient codes."""

from collections.abc import Iterator
from contextlib import contextmanager
from http import HTTPStatus

from fastapi import APIRouter, Request
from sqlalchemy import select
from sqlalchemy.orm import Session

from services.gateway.access.roles import Permission
from services.gateway.access.rules import needs
from services.gateway.access.statements import OutOfScope
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Context, Gateway, PatientCode
from services.gateway.directory.cipher import DirectoryUnusable, Name
from services.gateway.directory.models import CodesIn, NameIn, NameOut, NamesOut, SearchIn
from services.gateway.directory.words import folded, matching
from services.gateway.patients.records import get_patient
from services.gateway.problems import Problem, documented
from services.gateway.tables import PatientRow

router = APIRouter(prefix="/v1", tags=["names"], dependencies=[needs(Permission.NAMES)])

MOST_FOUND = 50
NOT_USABLE = documented(HTTPStatus.NOT_FOUND, HTTPStatus.SERVICE_UNAVAILABLE)


@router.get("/patients/{code}/name", responses=NOT_USABLE)
def read_name(code: PatientCode, gateway: Context) -> NameOut:
    """Who the patient is."""
    with gateway.transaction() as database:
        get_patient(database, code)
    with _usable():
        found = dict(gateway.directory.find([code]))
    if code not in found:
        raise _nameless(code)
    return _shape(code, found[code])


@router.put("/patients/{code}/name", responses=NOT_USABLE)
def put_name(code: PatientCode, body: NameIn, gateway: Context) -> NameOut:
    """Say who the patient is. Only the patient's own clinic may."""
    _check_own(gateway, code)
    name = Name(name=body.name, record_number=body.record_number)
    with _usable():
        gateway.directory.put(code, name)
    return _shape(code, name)


@router.delete("/patients/{code}/name", status_code=HTTPStatus.NO_CONTENT, responses=NOT_USABLE)
def delete_name(code: PatientCode, gateway: Context) -> None:
    """Forget who the patient is; what was measured stays."""
    _check_own(gateway, code)
    with _usable():
        place = gateway.directory.place_of(code)
        if place is None or not gateway.directory.remove([place]):
            raise _nameless(code)


@router.post("/directory/search", responses=NOT_USABLE)
def search_names(body: SearchIn, gateway: Context, request: Request) -> NamesOut:
    """Patients whose name or record number has all the words, however they are written."""
    with gateway.transaction() as database:
        codes = _codes(database, gateway.parameters.most_names_searched)
    wanted = matching(body.text)
    with _usable():
        found = [(code, name) for code, name in gateway.directory.find(codes) if wanted(name)]
    return _told(request, found)


@router.post("/directory/names", responses=NOT_USABLE)
def read_names(body: CodesIn, gateway: Context, request: Request) -> NamesOut:
    """Who these patients are."""
    with gateway.transaction() as database:
        seen = list(database.scalars(select(PatientRow.code).where(PatientRow.code.in_(body.codes))))
    with _usable():
        found = list(gateway.directory.find(seen))
    return _told(request, found, len(found))


def _told(request: Request, found: list[tuple[str, Name]], most: int = MOST_FOUND) -> NamesOut:
    found.sort(key=lambda each: (folded(each[1].name), each[0]))
    shown = [_shape(code, name) for code, name in found[:most]]
    note(request, Noted(patients=tuple(each.code for each in shown), reading=True))
    return NamesOut(items=shown, more=len(found) > len(shown))


def _codes(database: Session, most: int) -> list[str]:
    newest = select(PatientRow.code).order_by(PatientRow.created.desc(), PatientRow.code).limit(most)
    return list(database.scalars(newest))


def _check_own(gateway: Gateway, code: str) -> None:
    with gateway.transaction() as database:
        if get_patient(database, code).clinic_id != gateway.known_caller.clinic:
            raise OutOfScope("who a patient is, is said by their own clinic alone")


def _shape(code: str, name: Name) -> NameOut:
    return NameOut(code=code, name=name.name, record_number=name.record_number)


def _nameless(code: str) -> Problem:
    return Problem(
        HTTPStatus.NOT_FOUND, f"No name is known of patient {code}.", f"Add it with PUT /v1/patients/{code}/name."
    )


@contextmanager
def _usable() -> Iterator[None]:
    try:
        yield
    except DirectoryUnusable as error:
        step = "An administrator finds the key file under AMBULA_DIRECTORY_KEY_FILE; measurements go on without names."
        raise Problem(HTTPStatus.SERVICE_UNAVAILABLE, str(error), step) from error
