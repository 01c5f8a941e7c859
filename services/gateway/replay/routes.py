"""REST of replays: pictures, strides and events of a session that is over, a stretch at a time."""

from collections.abc import Iterator
from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Depends, Query
from fastapi.responses import StreamingResponse

from schemas.kinematics import LivePose
from services.gateway.access.rules import READ
from services.gateway.context import Context, Offset, SessionId
from services.gateway.live.views import View, encode, pose_view, session_view
from services.gateway.problems import Problem, documented
from services.gateway.replay import events
from services.gateway.replay.models import EventsOut, PosesOut, RecordedOut, StridePage
from services.gateway.replay.poses import Wanted, poses
from services.gateway.replay.recording import opened
from services.gateway.replay.strides import stride_page
from services.gateway.sessions.records import get_session
from services.gateway.sessions.shapes import phases_out, stored_metrics

router = APIRouter(prefix="/v1/sessions/{session}", tags=["replay"])

LONGEST_S = 60.0
MOST_POSES = 1500
LONGEST_EVENTS_S = 600.0
USUAL_S, USUAL_HZ = 10.0, 25.0
_TOGETHER = 25
"""Pictures written at a time: live connections wait for no more."""

From = Annotated[float, Query(ge=0, le=1e6, description="s of session time, included", examples=[12.0])]
To = Annotated[float | None, Query(gt=0, le=1e6, description="s of session time, not included; null: as usual")]
Rate = Annotated[float, Query(gt=0, le=100, description="pictures a second at most")]
StrideLimit = Annotated[int, Query(ge=1, le=500, description="number of strides at most")]

PROBLEMS = documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT)


@dataclass(frozen=True)
class Stretch:
    """What part of a session is asked for."""

    from_s: From = 0.0
    to_s: To = None

    def until(self, usual_s: float, longest_s: float) -> float:
        """Its end, s. Raises a 422 problem when there is no such stretch, or it is too long."""
        to_s = self.from_s + usual_s if self.to_s is None else self.to_s
        if to_s <= self.from_s:
            raise _too_much("The stretch ends before it begins.", "Give a to_s after from_s.")
        if to_s - self.from_s > longest_s + 1e-9:
            raise _too_much(
                f"{to_s - self.from_s:g} s are too long.",
                f"Ask for at most {longest_s:g} s, then go on at next_s.",
            )
        return to_s


Asked = Annotated[Stretch, Depends()]


@router.get("/recorded", dependencies=READ, responses=PROBLEMS)
def read_recorded(session: SessionId, gateway: Context) -> RecordedOut:
    """What was worn, on which body, what was to be done, and how long the recording is."""
    with opened(gateway, session) as recording:
        shown = session_view(recording.description, None)
        asked = {name: shown[name] for name in ("task", "walkway_m", "estimator", "sensors", "cameras", "body")}
        return RecordedOut(session=session, end_s=recording.end_ns / 1e9, **asked)


@router.get("/poses", dependencies=READ, response_model=PosesOut, responses=PROBLEMS)
def read_poses(session: SessionId, gateway: Context, asked: Asked, rate_hz: Rate = USUAL_HZ) -> StreamingResponse:
    """What a live page was shown, drawn anew from the recording: at most 60 s and 1500 pictures at a time."""
    to_s = asked.until(USUAL_S, LONGEST_S)
    if (to_s - asked.from_s) * rate_hz > MOST_POSES:
        few = f"Ask for at most {MOST_POSES / rate_hz:g} s at this rate, or for fewer pictures a second."
        raise _too_much(f"These would be more than {MOST_POSES} pictures.", few)
    with opened(gateway, session) as recording:
        drawn = poses(recording, Wanted(_ns(asked.from_s), _ns(to_s), rate_hz))
        head: View = {"session": session, **_page(asked.from_s, to_s, recording.end_ns)}
    return StreamingResponse(_written(head, drawn), media_type="application/json")


@router.get("/strides", dependencies=READ, responses=PROBLEMS)
def list_strides(session: SessionId, gateway: Context, offset: Offset = 0, limit: StrideLimit = 200) -> StridePage:
    """Every stride that was found, also those that do not count, with the reason; without their curves."""
    with opened(gateway, session) as recording:
        return stride_page(session, recording, offset, limit)


@router.get("/events", dependencies=READ, responses=PROBLEMS)
def list_events(session: SessionId, gateway: Context, asked: Asked) -> EventsOut:
    """Contacts, parts of tests, marks and losses of sensors in a stretch of at most 600 s."""
    to_s = asked.until(LONGEST_EVENTS_S, LONGEST_EVENTS_S)
    from_ns, to_ns = _ns(asked.from_s), _ns(to_s)
    with gateway.transaction() as database:
        metrics = stored_metrics(get_session(database, session))
    phases = [] if metrics is None else phases_out(session, metrics).phases
    marks = events.Marks(from_ns)
    with opened(gateway, session) as recording:
        losses = events.lost(recording, from_ns, to_ns, marks)
        return EventsOut(
            session=session,
            **_page(asked.from_s, to_s, recording.end_ns),
            contacts=events.contacts(recording, from_ns, to_ns),
            phases=[each for each in phases if each.start_s < to_s and (each.end_s or to_s) > asked.from_s],
            marks=marks.out(),
            losses=losses,
        )


def _page(from_s: float, to_s: float, end_ns: int) -> View:
    end_s = end_ns / 1e9
    return {"from_s": from_s, "to_s": to_s, "end_s": end_s, "next_s": to_s if to_s <= end_s else None}


def _written(head: View, drawn: list[LivePose]) -> Iterator[str]:
    """A PosesOut, some pictures at a time."""
    yield encode(head)[:-1] + ',"poses":['
    for first in range(0, len(drawn), _TOGETHER):
        views = (encode(pose_view([pose], 0.0)) for pose in drawn[first : first + _TOGETHER])
        yield ("," if first else "") + ",".join(views)
    yield "]}"


def _ns(time_s: float) -> int:
    return round(time_s * 1e9)


def _too_much(detail: str, next_step: str) -> Problem:
    return Problem(HTTPStatus.UNPROCESSABLE_ENTITY, detail, next_step)
