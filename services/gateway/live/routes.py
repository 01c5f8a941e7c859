"""The live connections: one session, or the list of all that run."""

import contextlib

import anyio
from fastapi import APIRouter, WebSocket, WebSocketDisconnect

from services.gateway.context import Context
from services.gateway.live.hub import NotLive, TooManyViewers
from services.gateway.live.viewer import NORMAL, TRY_AGAIN, Ended, Viewer
from services.gateway.security import is_same_origin

router = APIRouter(prefix="/v1/live")

POLICY, NOT_LIVE = 1008, 4404
"""Close codes beside the viewer's own: a foreign page; no such session runs now."""


@router.websocket("")
async def watch_floor(socket: WebSocket, gateway: Context) -> None:
    """The running sessions, twice a second."""
    await _serve(socket, gateway.live.watch_floor(), gateway.parameters.stall_s)


@router.websocket("/{session}")
async def watch_session(socket: WebSocket, session: str, gateway: Context) -> None:
    """Skeletons, events and numbers of one running session."""
    await _serve(socket, gateway.live.watch(session), gateway.parameters.stall_s)


async def _serve(socket: WebSocket, watching: contextlib.AbstractContextManager[Viewer], stall_s: float) -> None:
    if not is_same_origin(socket.headers):
        await socket.close(POLICY, "open the page from the gateway itself")
        return
    await socket.accept()
    try:
        with watching as viewer:
            code, reason = await _until_either_ends(socket, viewer, stall_s)
    except NotLive:
        code, reason = NOT_LIVE, "this session does not run now"
    except TooManyViewers:
        code, reason = TRY_AGAIN, "too many viewers"
    with contextlib.suppress(RuntimeError, WebSocketDisconnect, TimeoutError), anyio.fail_after(stall_s):
        await socket.close(code, reason)


async def _until_either_ends(socket: WebSocket, viewer: Viewer, stall_s: float) -> tuple[int, str]:
    ending = NORMAL, ""

    async def send() -> None:
        nonlocal ending
        ending = await _send_all(socket, viewer, stall_s)
        group.cancel_scope.cancel()

    async def listen() -> None:
        await _listen(socket)
        group.cancel_scope.cancel()

    async with anyio.create_task_group() as group:
        group.start_soon(send)
        group.start_soon(listen)
    return ending


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
