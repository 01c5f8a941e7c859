"""The live connections: one session, or the list of all that run."""

import contextlib
from datetime import UTC, datetime

import anyio
from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from starlette.concurrency import run_in_threadpool

from services.gateway.access.identify import Identified, NotKnown, identify_again
from services.gateway.access.rules import READ
from services.gateway.access.scope import EVERYTHING
from services.gateway.audit import records as audit
from services.gateway.audit.trail import entry_of
from services.gateway.context import Context, Gateway
from services.gateway.live.hub import NotLive, TooManyViewers
from services.gateway.live.viewer import NORMAL, POLICY, SIGN_IN, TRY_AGAIN, Ended, Viewer
from services.gateway.security import is_same_origin

router = APIRouter(prefix="/v1/live")

NOT_LIVE = 4404
"""Close code beside the viewer's own: no such session runs now."""


@router.websocket("", dependencies=READ)
async def watch_floor(socket: WebSocket, gateway: Context, caller: Identified) -> None:
    """The running sessions, twice a second."""
    await _serve(socket, gateway.live.watch_floor(caller.scope), gateway)


@router.websocket("/{session}", dependencies=READ)
async def watch_session(socket: WebSocket, session: str, gateway: Context, caller: Identified) -> None:
    """Skeletons, events and numbers of one running session."""
    await _serve(socket, gateway.live.watch(session, caller.scope), gateway)


async def _serve(socket: WebSocket, watching: contextlib.AbstractContextManager[Viewer], gateway: Gateway) -> None:
    stall_s = gateway.parameters.stall_s
    if not is_same_origin(socket.headers):
        await socket.close(POLICY, "open the page from the gateway itself")
        return
    await socket.accept()
    try:
        with watching as viewer:
            await run_in_threadpool(_audit, socket, gateway)
            code, reason = await _until_either_ends(socket, viewer, gateway)
    except NotLive:
        code, reason = NOT_LIVE, "this session does not run now"
    except TooManyViewers:
        code, reason = TRY_AGAIN, "too many viewers"
    with contextlib.suppress(RuntimeError, WebSocketDisconnect, TimeoutError), anyio.fail_after(stall_s):
        await socket.close(code, reason)


def _audit(socket: WebSocket, gateway: Gateway) -> None:
    action = socket.scope["route"].name if "route" in socket.scope else "watch"
    with gateway.database.transaction(EVERYTHING) as database:
        audit.append(database, entry_of(socket.scope, action, 101, datetime.now(UTC)))


async def _until_either_ends(socket: WebSocket, viewer: Viewer, gateway: Gateway) -> tuple[int, str]:
    ending = NORMAL, ""

    async def send() -> None:
        nonlocal ending
        ending = await _send_all(socket, viewer, gateway.parameters.stall_s)
        group.cancel_scope.cancel()

    async def listen() -> None:
        await _listen(socket)
        group.cancel_scope.cancel()

    async with anyio.create_task_group() as group:
        group.start_soon(send)
        group.start_soon(listen)
        group.start_soon(_ask_again, socket, viewer, gateway.parameters.ask_again_s)
    return ending


async def _ask_again(socket: WebSocket, viewer: Viewer, every_s: float) -> None:
    """A connection lives as long as the sign-in behind it, and shows what its owner may see now."""
    while True:
        await anyio.sleep(every_s)
        try:
            caller = await run_in_threadpool(identify_again, socket)
        except NotKnown:
            viewer.end(SIGN_IN, "the sign-in has ended")
            return
        if caller.scope != viewer.scope:
            viewer.end(TRY_AGAIN, "what may be seen has changed")
            return


async def _send_all(socket: WebSocket, viewer: Viewer, stall_s: float) -> tuple[int, str]:
    try:
        while True:
            text = await viewer.take()
            with anyio.fail_after(stall_s):
                await socket.send_text(text)
    except Ended as end:
        return end.code, end.reason
    except TimeoutError:
        return TRY_AGAIN, "stalled"
    except (WebSocketDisconnect, RuntimeError):
        return NORMAL, ""


async def _listen(socket: WebSocket) -> None:
    # Nothing is expected from the page; reading is how a closed connection is noticed.
    while (await socket.receive())["type"] != "websocket.disconnect":
        pass
