"""Writes an entry for every request that concerns a patient, before its answer goes out. Plain ASGI.

The same person reading the same thing again and again, as an open page does, is one entry in five minutes.
"""

import logging
import re
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime

from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from services.bus.logs import event
from services.gateway.access.caller import Caller
from services.gateway.access.roles import ABOUT_PATIENTS
from services.gateway.access.rules import rule_of
from services.gateway.access.scope import EVERYTHING
from services.gateway.audit import records
from services.gateway.audit.chain import Entry
from services.gateway.audit.noting import NOTHING, noted_in
from services.gateway.database import Database

log = logging.getLogger(__name__)

SAME_READING_S = 300.0
MOST_REMEMBERED = 4096
READING = ("GET", "HEAD")
AN_ID = re.compile(r"[A-Za-z0-9_.+-]{1,64}")
A_CODE = re.compile(r"[0-9A-Z]{1,16}")


class AuditTrail:
    """Around the application."""

    def __init__(
        self, app: ASGIApp, database: Database, clock: Callable[[], datetime] = lambda: datetime.now(UTC)
    ) -> None:
        self.app = app
        self._database = database
        self._clock = clock
        self._read: OrderedDict[tuple[object, ...], datetime] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """ASGI entry."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def send_after_entry(message: Message) -> None:
            if message["type"] == "http.response.start":
                entries = self._due(scope, message["status"])
                if entries:
                    await run_in_threadpool(self._append, entries)
            await send(message)

        await self.app(scope, receive, send_after_entry)

    def _due(self, scope: Scope, status: int) -> list[Entry]:
        route, noted = scope.get("route"), noted_in(scope)
        dependant = getattr(route, "dependant", None)
        if route is None or dependant is None:
            return []
        reading = noted.reading or scope["method"] in READING
        if reading and noted is NOTHING and rule_of(route.path, dependant) not in ABOUT_PATIENTS:
            return []
        entry = entry_of(scope, route.name, status, self._clock())
        entries = [replace(entry, patient=patient) for patient in noted.patients] or [entry]
        return [each for each in entries if not (reading and self._is_repeated(each))]

    def _is_repeated(self, entry: Entry) -> bool:
        key = (entry.actor, entry.action, entry.patient, entry.session, entry.object, entry.outcome)
        before = self._read.get(key)
        if before is not None and (entry.at - before).total_seconds() < SAME_READING_S:
            return True
        self._read[key] = entry.at
        self._read.move_to_end(key)
        if len(self._read) > MOST_REMEMBERED:
            self._read.popitem(last=False)
        return False

    def _append(self, entries: list[Entry]) -> None:
        try:
            with self._database.transaction(EVERYTHING) as database:
                for entry in entries:
                    records.append(database, entry)
        except SQLAlchemyError:
            # The database that would hold the entry is the one the answer came from: it has just gone away.
            log.exception(event("not_audited", action=entries[0].action, outcome=entries[0].outcome))


def entry_of(scope: Scope, action: str, outcome: int, at: datetime) -> Entry:
    """What is known of a request or socket: who, which patient or session its address names, and what it noted."""
    caller: Caller | None = scope.get("state", {}).get("caller")
    # What stands in an address may be anything that somebody typed: only what is written like an id is kept.
    named = {name: value for name, value in scope.get("path_params", {}).items() if AN_ID.fullmatch(str(value))}
    code, noted = named.get("code"), noted_in(scope)
    others = [f"{name}={value}" for name, value in named.items() if name not in ("code", "session")]
    return Entry(
        at=at,
        actor_kind=caller.kind if caller is not None else "nobody",
        actor=caller.account if caller is not None else None,
        role=caller.role if caller is not None else None,
        clinic=caller.clinic if caller is not None else None,
        action=action,
        patient=code if code is not None and A_CODE.fullmatch(code) else None,
        session=noted.session or named.get("session"),
        object=" ".join([*others, *([noted.object] if noted.object else [])])[:120] or None,
        outcome=outcome,
        reason=noted.reason,
    )
