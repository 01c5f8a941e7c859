"""What happens now, for everybody who watches: fed from any thread, fanned out on the event loop."""

import asyncio
import contextlib
import logging
import math
import time
from collections import deque
from collections.abc import Callable, Iterator

from schemas.kinematics import LivePose
from schemas.quality import DataQuality
from schemas.session import SessionDescription
from services.bus.logs import event
from services.gateway.access.scope import Scope
from services.gateway.health.board import HealthBoard
from services.gateway.live import views
from services.gateway.live.audience import Audience
from services.gateway.live.cards import card_view
from services.gateway.live.session import ArrivedPose, LiveSession
from services.gateway.live.viewer import GOING_AWAY, NORMAL, POLICY, Viewer
from services.gateway.live.views import View
from services.gateway.parameters import GatewayParameters

log = logging.getLogger(__name__)


class NotLive(LookupError):
    """No such session runs now."""


class TooManyViewers(RuntimeError):
    """The bound on open live connections is reached."""


class LiveHub:
    """The only place where threads meet: `pose` just stores, everything else hops onto the event loop."""

    def __init__(
        self, parameters: GatewayParameters | None = None, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.parameters = parameters or GatewayParameters()
        self.clock = clock
        self.health = HealthBoard(self.parameters.stale_s, clock)
        self.audience = Audience()
        self.undecodable = 0
        self._loop: asyncio.AbstractEventLoop | None = None
        self._sessions: dict[str, LiveSession] = {}
        self._floor_viewers: set[Viewer] = set()
        self._floor_task: asyncio.Task[None] | None = None

    # Fed by the bus, from any thread.

    def pose(self, session: str, payload: bytes) -> None:
        """The newest skeleton of a session. Decoded only when somebody looks, and shown at once then."""
        live = self._sessions.get(session)
        if live is None:
            return
        live.poses.append(ArrivedPose(payload, self.clock()))
        if live.task is not None:
            self._on_loop(live.arrival.set)

    def open(self, description: SessionDescription) -> None:
        """A session runs. Known ones are left as they are."""
        self._on_loop(lambda: self._open(description))

    def assign(self, session: str, patient: str | None, clinic: str) -> None:
        """The session belongs to this patient and this clinic."""
        self._on_loop(lambda: self._assign(session, patient, clinic))

    def tell(self, session: str, view: View) -> None:
        """An event of a session, for everybody who watches it. Remembers what a late viewer must know."""
        self._on_loop(lambda: self._tell(session, view))

    def measure(self, session: str, quality: DataQuality) -> None:
        """What the sensors of a session told so far: viewers hear what came of the last ten seconds."""
        self._on_loop(lambda: self._measure(session, quality))

    def close(self, session: str, state: str) -> None:
        """A session is over: viewers are told its state, then let go."""
        self._on_loop(lambda: self._close(session, state))

    def forget(self, session: str) -> None:
        """The session was erased: whoever watches it is let go, and nothing of it is kept."""
        self.close(session, "erased")

    # Asked by routes, on the event loop.

    def bind(self, loop: asyncio.AbstractEventLoop) -> None:
        """From now on fan out on this loop."""
        self._loop = loop

    async def stop(self) -> None:
        """Let all viewers go and end the tasks."""
        self._loop = None
        everybody = set(self._floor_viewers).union(*(live.viewers for live in self._sessions.values()))
        for viewer in everybody:
            viewer.end(GOING_AWAY, "the gateway stops")
        tasks = [live.task for live in self._sessions.values()] + [self._floor_task]
        for task in filter(None, tasks):
            task.cancel()
        await asyncio.gather(*filter(None, tasks), return_exceptions=True)

    @contextlib.contextmanager
    def watch(self, session: str, scope: Scope) -> Iterator[Viewer]:
        """Watch one session. Raises TooManyViewers, or NotLive, also when it is not the viewer's to see."""
        live = self._sessions.get(session)
        if live is None or not scope.sees(live.clinic, live.patient):
            raise NotLive(session)
        viewer = self._new_viewer(scope)
        live.viewers.add(viewer)
        for view in (views.session_view(live.description, live.patient), *live.memory):
            viewer.tell(views.encode(view))
        if live.task is None:
            live.task = asyncio.get_running_loop().create_task(self._show_poses(live))
        try:
            yield viewer
        finally:
            live.viewers.discard(viewer)
            self.audience.leave(viewer)
            if not live.viewers and live.task is not None:
                live.task.cancel()
                live.task = None

    @contextlib.contextmanager
    def watch_floor(self, scope: Scope) -> Iterator[Viewer]:
        """Watch the list of running sessions. Raises TooManyViewers."""
        viewer = self._new_viewer(scope)
        self._floor_viewers.add(viewer)
        self._show_cards({viewer})
        if self._floor_task is None:
            self._floor_task = asyncio.get_running_loop().create_task(self._show_floor())
        try:
            yield viewer
        finally:
            self._floor_viewers.discard(viewer)
            self.audience.leave(viewer)
            if not self._floor_viewers and self._floor_task is not None:
                self._floor_task.cancel()
                self._floor_task = None

    def is_live(self, session: str) -> bool:
        """Whether the session runs now."""
        return session in self._sessions

    def _new_viewer(self, scope: Scope) -> Viewer:
        sizes = self.audience.sizes()
        of_clinic = sizes.get(scope.clinic or "", 0)
        if sum(sizes.values()) >= self.parameters.most_viewers or of_clinic >= self.parameters.most_viewers_of_clinic:
            raise TooManyViewers
        return self.audience.join(Viewer(self.parameters.event_queue, scope))

    def _on_loop(self, call: Callable[[], None]) -> None:
        if self._loop is None:
            call()
            return
        with contextlib.suppress(RuntimeError):  # the loop has just been closed: nobody watches any more
            self._loop.call_soon_threadsafe(call)

    def _open(self, description: SessionDescription) -> None:
        live = LiveSession(description, poses=deque(maxlen=self.parameters.trail))
        self._sessions.setdefault(description.session, live)

    def _assign(self, session: str, patient: str | None, clinic: str) -> None:
        live = self._sessions.get(session)
        if live is None:
            return
        live.clinic = clinic
        for viewer in [each for each in live.viewers if not each.scope.sees(clinic, patient)]:
            viewer.end(POLICY, "this session is not yours to see any more")
        if live.patient != patient:
            live.patient = patient
            self._tell(session, {"kind": "patient", "patient": patient})

    def _tell(self, session: str, view: View) -> None:
        live = self._sessions.get(session)
        if live is None:
            return
        live.memory.keep(view)
        text = views.encode(view)
        for viewer in live.viewers:
            viewer.tell(text)

    def _measure(self, session: str, quality: DataQuality) -> None:
        live = self._sessions.get(session)
        if live is None:
            return
        before = live.qualities[0] if live.qualities else None
        live.qualities.append(quality)
        self._tell(session, views.quality_view(quality, before))

    def _close(self, session: str, state: str) -> None:
        live = self._sessions.get(session)
        if live is None:
            return
        self._tell(session, {"kind": "ended", "state": state})
        for viewer in live.viewers:
            viewer.end(NORMAL, "the session has ended")
        if live.task is not None:
            live.task.cancel()
            live.task = None
        del self._sessions[session]

    async def _show_poses(self, live: LiveSession) -> None:
        shown_s = beat_s = -math.inf
        while True:
            fresh = [each for each in live.poses.copy() if each.received_s > shown_s]
            if fresh:
                shown_s = fresh[-1].received_s
                self._show(live.viewers, "pose", self._pose_view(live, fresh))
            if self.clock() - beat_s >= self.parameters.heartbeat_s:
                beat_s = self.clock()
                self._show(live.viewers, "status", self._status_view(live))
            await asyncio.sleep(self.parameters.pose_interval_s)
            await live.until_arrival(self.parameters.heartbeat_s)

    async def _show_floor(self) -> None:
        while True:
            await asyncio.sleep(self.parameters.floor_interval_s)
            self._show_cards(self._floor_viewers)

    def _show(self, viewers: set[Viewer], slot: str, view: View | None) -> None:
        if view is not None and viewers:
            text = views.encode(view)
            for viewer in viewers:
                viewer.show(slot, text)

    def _decode(self, live: LiveSession, arrived: ArrivedPose) -> LivePose | None:
        try:
            return LivePose.model_validate_json(arrived.payload)
        except ValueError:
            self.undecodable += 1
            log.warning(event("undecodable_pose", session=live.description.session, count=self.undecodable))
            return None

    def _pose_view(self, live: LiveSession, fresh: list[ArrivedPose]) -> View | None:
        poses = [pose for each in fresh if (pose := self._decode(live, each)) is not None]
        return views.pose_view(poses, self.clock() - fresh[-1].received_s) if poses else None

    def _status_view(self, live: LiveSession) -> View:
        stopped = self.health.recording_stopped(live.description.session)
        age_s = live.age_s(self.clock())
        return {"kind": "status", "age_s": age_s, "recording_stopped": stopped, **self.health.brief()}

    def _show_cards(self, viewers: set[Viewer]) -> None:
        """Each card is made once, and each list once for all who may see the same."""
        cards = [(live, self._card_view(live)) for live in self._sessions.values()]
        brief = self.health.brief()
        for scope in {viewer.scope for viewer in viewers}:
            seen = [card for live, card in cards if scope.sees(live.clinic, live.patient)]
            alike = {viewer for viewer in viewers if viewer.scope == scope}
            self._show(alike, "floor", {"kind": "floor", "sessions": seen, **brief})

    def _card_view(self, live: LiveSession) -> View:
        pose = self._decode(live, live.poses[-1]) if live.poses else None
        stopped = self.health.recording_stopped(live.description.session)
        return card_view(live, pose, live.age_s(self.clock()), stopped)
