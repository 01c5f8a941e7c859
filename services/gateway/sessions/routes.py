"""REST of sessions."""

import logging
from datetime import UTC, date, datetime
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Query, Request

from schemas.conditions import Conditions
from schemas.metrics import SessionMetrics
from schemas.session import SessionDescription
from schemas.vocabulary import Task
from services.bus.logs import event
from services.gateway.access.rules import READ, WORK
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Context, Gateway, Limit, Offset, SessionId
from services.gateway.control import ControlRefused, ControlUnavailable, StartRequest
from services.gateway.patients.records import get_patient, with_known_side
from services.gateway.problems import Problem, documented
from services.gateway.sessions import records, shapes
from services.gateway.sessions.models import (
    CurvesOut,
    MarkIn,
    MarkOut,
    MetricsOut,
    PhasesOut,
    RepetitionsOut,
    SessionIn,
    SessionLink,
    SessionOut,
    SessionPage,
    SessionState,
)
from services.gateway.sessions.rhythms import known_rhythms
from services.gateway.sources.offered import offered_sources

log = logging.getLogger(__name__)
router = APIRouter(prefix="/v1/sessions", tags=["sessions"])

START_SERVICES = "Start the services with `ambula up`; the System page (GET /v1/health) shows which are missing."
DAY = "2026-11-22"
CHOOSE_SOURCE = "Choose a source from GET /v1/sources."


@router.post(
    "",
    dependencies=WORK,
    status_code=HTTPStatus.CREATED,
    responses=documented(HTTPStatus.NOT_FOUND, HTTPStatus.SERVICE_UNAVAILABLE),
)
def start_session(body: SessionIn, gateway: Context, request: Request) -> SessionOut:
    """Store a session and ask an ingest to run it. A session that could not start stays listed as failed.

    With a patient, the session knows the rhythms of the patient's previous trial and visit and starts from them.
    """
    session, known = records.new_session_id(), None
    conditions: Conditions | None = body.conditions
    note(request, Noted(patients=() if body.patient is None else (body.patient,), session=session))
    clinic = gateway.known_caller.clinic
    with gateway.transaction() as database:
        if body.patient is not None:
            patient = get_patient(database, body.patient)
            clinic = patient.clinic_id
            conditions = with_known_side(body.conditions, patient)
            known = known_rhythms(database, body.patient, datetime.now(UTC))
        records.add_requested(database, session, body, clinic)
    order = StartRequest(
        session, body.source, body.speed, body.estimator, body.walk_path, known, body.task, body.walkway_m, conditions
    )
    description = _ask_for_start(gateway, order)
    with gateway.transaction() as database:
        row = records.record_start(database, description, clinic)
        database.flush()
        return shapes.session_out(row)


@router.get("", dependencies=READ, responses=documented())
def list_sessions(
    gateway: Context,
    state: Annotated[SessionState | None, Query(description="only sessions in this state")] = None,
    patient: Annotated[str | None, Query(description="only sessions of this patient code", max_length=16)] = None,
    task: Annotated[Task | None, Query(description="only sessions with this task")] = None,
    from_day: Annotated[date | None, Query(alias="from", description="UTC day of the earliest", examples=[DAY])] = None,
    to_day: Annotated[date | None, Query(alias="to", description="UTC day of the latest", examples=[DAY])] = None,
    offset: Offset = 0,
    limit: Limit = 50,
) -> SessionPage:
    """List the sessions, newest first."""
    wanted = records.Wanted(state, patient, task, from_day, to_day)
    with gateway.transaction() as database:
        total, rows = records.list_sessions(database, wanted, offset, limit)
        return SessionPage(total=total, items=[shapes.session_out(row) for row in rows])


@router.get("/{session}", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_session(session: SessionId, gateway: Context) -> SessionOut:
    """One session."""
    with gateway.transaction() as database:
        return shapes.session_out(records.get_session(database, session))


@router.patch("/{session}", dependencies=WORK, responses=documented(HTTPStatus.NOT_FOUND))
def link_session(session: SessionId, body: SessionLink, gateway: Context, request: Request) -> SessionOut:
    """Say to whom a session belongs."""
    note(request, Noted(patients=() if body.patient is None else (body.patient,)))
    with gateway.transaction() as database:
        row = records.get_session(database, session)
        if body.patient is not None:
            row.clinic_id = get_patient(database, body.patient).clinic_id
        row.patient_code = body.patient
        database.flush()
        database.expire(row, ["patient"])
        answer, clinic = shapes.session_out(row), row.clinic_id
    gateway.live.assign(session, body.patient, clinic)
    return answer


@router.post(
    "/{session}/stop",
    dependencies=WORK,
    status_code=HTTPStatus.ACCEPTED,
    responses=documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT, HTTPStatus.SERVICE_UNAVAILABLE),
)
def stop_session(session: SessionId, gateway: Context) -> SessionOut:
    """End a running session; its final metrics follow within seconds."""
    with gateway.transaction() as database:
        row = records.get_session(database, session)
        answer = shapes.session_out(row)
    if answer.state not in (SessionState.CREATED, SessionState.LIVE):
        raise Problem(
            HTTPStatus.CONFLICT, f"Session {session} is {answer.state}, not live.", "There is nothing to stop."
        )
    try:
        gateway.control.stop(session)
    except ControlUnavailable as error:
        raise Problem(HTTPStatus.SERVICE_UNAVAILABLE, str(error), START_SERVICES) from error
    except ControlRefused as error:
        raise Problem(HTTPStatus.CONFLICT, str(error), "Read the session again; it may have ended.") from error
    return answer


@router.post(
    "/{session}/marks",
    dependencies=WORK,
    status_code=HTTPStatus.ACCEPTED,
    responses=documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT, HTTPStatus.SERVICE_UNAVAILABLE),
)
def mark_standing(session: SessionId, body: MarkIn, gateway: Context) -> MarkOut:
    """Mark the last seconds of a running session as standing.

    Before the first steps it is the standing that counts; later, all angles refer to it from then on. A mark in which
    the person moved or sat is refused: the live stream says why.
    """
    with gateway.transaction() as database:
        records.get_session(database, session)
    try:
        from_s, to_s = gateway.control.mark(session, body.last_s, body.at_s)
    except ControlUnavailable as error:
        raise Problem(HTTPStatus.SERVICE_UNAVAILABLE, str(error), START_SERVICES) from error
    except ControlRefused as error:
        raise Problem(HTTPStatus.CONFLICT, str(error), "Only a session that runs can be marked.") from error
    return MarkOut(session=session, from_s=from_s, to_s=to_s)


@router.get("/{session}/metrics", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_metrics(session: SessionId, gateway: Context) -> MetricsOut:
    """The session in numbers, final or so far."""
    return shapes.metrics_out(session, _metrics_of(gateway, session))


@router.get("/{session}/curves", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_curves(session: SessionId, gateway: Context) -> CurvesOut:
    """Mean curves over the stride with their spread, final or so far."""
    return shapes.curves_out(session, _metrics_of(gateway, session))


@router.get("/{session}/phases", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_phases(session: SessionId, gateway: Context) -> PhasesOut:
    """Phases of the session's timed tests, all or so far; the running one has no end. Empty for other tasks."""
    return shapes.phases_out(session, _metrics_of(gateway, session))


@router.get("/{session}/repetitions", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_repetitions(session: SessionId, gateway: Context) -> RepetitionsOut:
    """Repetitions of an exercise in order, once the session is over. Empty before that, and for other tasks."""
    return shapes.repetitions_out(session, _metrics_of(gateway, session))


def _metrics_of(gateway: Gateway, session: str) -> SessionMetrics:
    with gateway.transaction() as database:
        metrics = shapes.stored_metrics(records.get_session(database, session))
    if metrics is None:
        raise Problem(
            HTTPStatus.NOT_FOUND,
            f"Session {session} has no metrics yet.",
            "They come with the first strides; walk a few steps and read again.",
        )
    return metrics


def _ask_for_start(gateway: Gateway, request: StartRequest) -> SessionDescription:
    try:
        _check_offered(gateway, request.source)
        return gateway.control.start(request)
    except ControlUnavailable as error:
        _give_up(gateway, request.session, str(error))
        raise Problem(HTTPStatus.SERVICE_UNAVAILABLE, str(error), START_SERVICES) from error
    except ControlRefused as error:
        _give_up(gateway, request.session, str(error))
        raise Problem(HTTPStatus.UNPROCESSABLE_ENTITY, str(error), CHOOSE_SOURCE) from error


def _check_offered(gateway: Gateway, source: str) -> None:
    """No request can make the site listen where nobody set up a device. Raises ControlRefused."""
    if source.startswith("device:"):
        devices = [each.id for each in offered_sources(gateway) if each.kind == "device"]
        if not any(source == device or source.startswith(f"{device}&") for device in devices):
            raise ControlRefused(f"{source} is not there: switch the camera and its computer on, then choose it again")


def _give_up(gateway: Gateway, session: str, reason: str) -> None:
    log.info(event("session_not_started", session=session))
    with gateway.transaction() as database:
        records.record_end(database, session, SessionState.FAILED, reason)
