"""Follows whoever is in view: frames in, postures out. No message, no picture: what a camera alone tells of the body.

A start needs a standing, still second, for only there the camera's offsets can be told from the posture. Who moves on
is followed without, and begun anew when such a second comes. What was kept while waiting is estimated then.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.model import CENTRE_NAMES, MODEL
from services.biomech.whole_body.start import Start
from services.estimation.body.filters import KINDS, NOBODY, BodyFilter, Told, published_start
from services.estimation.body.frames import Frame
from services.estimation.body.parameters import BodyParameters
from services.estimation.body.recent import RecentFrames, start_from_fit, start_from_standing
from services.estimation.body.visibility import Visibility
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]


class Posture(NamedTuple):
    """The body at one instant."""

    captured_ns: int
    told: Told
    centres: Array  # (15, 3) m, room
    rotations: Array  # (22, 3, 3) R_room_from_segment behind each joint
    seen: list[bool]  # (15,) the camera saw this centre a moment ago
    valid: list[bool]  # (22,) the angle may be shown
    start: int  # number of the start that it goes back to
    absolute: bool  # that start was a standing second


class BodyTracker:
    """Of one camera. `begun` counts the starts, so that a new one is noticed."""

    def __init__(self, estimator: str, stature: float | None, parameters: BodyParameters) -> None:
        self._kind, self._stature, self._parameters = KINDS[estimator], stature, parameters
        self._recent = RecentFrames(parameters)
        self._visibility = Visibility(parameters)
        self._filter: BodyFilter | None = None
        self._body: int | None = None
        self._since_ns: int | None = None  # first frame of the person who is waited for
        self._newest_ns: int | None = None  # last frame that the filter has
        self._there_ns: int | None = None  # last frame with the person in it
        self._looked_ns = 0
        self._held: Told | None = None
        self.begun = 0
        self.diverged = 0

    @property
    def is_following(self) -> bool:
        """There has been a start, of the person who was in view last."""
        return self._filter is not None

    @property
    def absolute(self) -> bool:
        """Angles refer to a posture that was known."""
        return self._filter is not None and self._filter.absolute

    @property
    def holds_lengths(self) -> bool:
        """The bones' lengths do not change any more."""
        return self._filter is not None and self._filter.holds_lengths

    @property
    def can_be_absolute(self) -> bool:
        """A standing second would make them so."""
        return self._kind.waits

    def take(self, frame: Frame) -> list[Posture]:
        """Take the next frame: nothing while it is waited for a start, then everything since."""
        if not frame.is_somebody:
            return self._miss(frame)
        if frame.body != self._body:
            self._forget()
            self._body = frame.body
        was_there_ns, self._there_ns = self._there_ns, frame.captured_ns
        if self._filter is None:
            return self._wait(frame)
        self._recent.add(frame)
        if was_there_ns is not None and self._is_away(frame.captured_ns, was_there_ns):
            self._filter.rejoin(frame.centres, frame.state)
            self._visibility.hide()
            self._newest_ns = frame.captured_ns
        posture = self._follow(frame)
        if posture is None:
            return []
        self._stand_if_still(frame.captured_ns)
        return [posture]

    def stand(self, from_ns: int, to_ns: int) -> tuple[str, list[Posture]]:
        """The operator says that this was standing.

        Why it was not, or nothing: then angles refer to it from now on. And the postures since, if there were none
        before.
        """
        if not self._kind.waits:
            return "this estimator starts from one frame, whatever the posture", []
        frames, was_following = self._recent.marked(from_ns, to_ns), self.is_following
        reason = self._recent.why_not_standing(frames)
        if reason:
            return reason, []
        start = start_from_standing(frames, self._stature)
        postures = self._begin(start, self._recent.since(frames[0].captured_ns))
        return "", [] if was_following else postures

    def finish(self) -> list[Posture]:
        """No more frames: whoever is waited for is followed with what there is."""
        return self._begin_unknown() if self._filter is None else []

    def _is_away(self, now_ns: int, there_ns: int) -> bool:
        return now_ns - there_ns > self._parameters.predict_s * 1e9

    def _forget(self) -> None:
        """Somebody else: nothing of the one before is kept."""
        self._filter, self._held, self._since_ns, self._there_ns = None, None, None, None
        self._recent.forget()
        self._visibility.begin()

    def _miss(self, frame: Frame) -> list[Posture]:
        """Nobody in view: for a moment the filter goes on by itself, then the last posture is held and not shown."""
        if self._there_ns is None:
            return []
        away = self._is_away(frame.captured_ns, self._there_ns)
        if self._filter is None:
            if away:
                self._forget()
                self._body = None
            return []
        if not away:
            posture = self._follow(frame)
            return [] if posture is None else [posture]
        assert self._held is not None
        still = np.zeros_like(self._held.rates)
        self._held = self._held._replace(rates=still, accelerations=still)
        self._visibility.hide()
        return [self._posture(frame.captured_ns, [False] * len(CENTRE_NAMES), [False] * len(still))]

    def _wait(self, frame: Frame) -> list[Posture]:
        """Keep the frame; start when there is enough."""
        self._recent.add(frame)
        if self._since_ns is None:
            self._since_ns = self._looked_ns = frame.captured_ns
        if not self._kind.waits:
            return self._begin_unknown()
        if self._is_time_to_look(frame.captured_ns):
            frames = self._recent.newest_second()
            if frames and not self._recent.why_not_standing(frames):
                return self._begin(start_from_standing(frames, self._stature), frames)
        if frame.captured_ns - self._since_ns >= self._parameters.wait_s * 1e9:
            return self._begin_unknown()
        return []

    def _is_time_to_look(self, now_ns: int) -> bool:
        if now_ns - self._looked_ns < self._parameters.look_s * 1e9:
            return False
        self._looked_ns = now_ns
        return True

    def _begin_unknown(self) -> list[Posture]:
        """Start from what the first frames look like; nothing while they show too little of the body."""
        frames, p = self._recent.since(self._since_ns or 0), self._parameters
        if not frames:
            return []
        if not self._kind.waits:
            if not frames[-1].state.all():
                return []
            return self._begin(published_start(frames[-1].centres, frames[-1].state), frames[-1:])
        start = start_from_fit(frames[: p.first_frames], self._stature, p.fewest_to_fit)
        if start is None:
            self._since_ns = frames[min(p.first_frames, len(frames) - 1)].captured_ns
            return []
        return self._begin(start, frames)

    def _begin(self, start: Start, frames: Sequence[Frame]) -> list[Posture]:
        """Follow the person from a start through all frames since."""
        self._filter, self._newest_ns = self._kind.begin(start), None
        self.begun += 1
        self._visibility.begin()
        postures = [self._follow(frame) for frame in frames]
        return [posture for posture in postures if posture is not None]

    def _stand_if_still(self, now_ns: int) -> None:
        """Begin anew from a standing second where the start before had none; what was published stays."""
        if self.absolute or not self._kind.waits or not self._is_time_to_look(now_ns):
            return
        frames = self._recent.newest_second()
        if frames and not self._recent.why_not_standing(frames):
            self._begin(start_from_standing(frames, self._stature), frames)

    def _follow(self, frame: Frame) -> Posture | None:
        """One frame through the filter; None where that has diverged, which ends it."""
        assert self._filter is not None
        now_ns = frame.captured_ns
        dt_s = 0.0 if self._newest_ns is None else (now_ns - self._newest_ns) / 1e9
        self._newest_ns = now_ns
        centres, state = (frame.centres, frame.state) if frame.is_somebody else NOBODY
        if not self._filter.advance(dt_s, centres, state):
            self._forget()
            self.diverged += 1
            return None
        told = self._held = self._filter.told()
        self._visibility.see(now_ns, frame.state)
        return self._posture(now_ns, self._visibility.seen(now_ns), self._visibility.shown(now_ns, told))

    def _posture(self, now_ns: int, seen: list[bool], valid: list[bool]) -> Posture:
        assert self._held is not None
        pose = MODEL.pose(self._held.q, self._held.lengths)
        return Posture(now_ns, self._held, pose.centre, pose.rotation, seen, valid, self.begun, self.absolute)

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "recent": self._recent.snapshot(),
            "visibility": self._visibility.snapshot(),
            "filter": None if self._filter is None else self._filter.snapshot(),
            "held": None if self._held is None else _pack(self._held),
            "body": self._body,
            "times_ns": [self._since_ns, self._newest_ns, self._there_ns, self._looked_ns],
            "counts": [self.begun, self.diverged],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._recent.restore(state["recent"])
        self._visibility.restore(state["visibility"])
        self._filter = None if state["filter"] is None else self._kind.resumed(state["filter"])
        self._held = None if state["held"] is None else _unpack(state["held"])
        self._body = state["body"]
        self._since_ns, self._newest_ns, self._there_ns, self._looked_ns = state["times_ns"]
        self.begun, self.diverged = state["counts"]


def _pack(told: Told) -> State:
    return {"arrays": [pack_array(a) for a in told[:-1]], "usable": told.usable.tolist()}


def _unpack(state: State) -> Told:
    q, lengths, rates, accelerations, deviations = (unpack_array(array) for array in state["arrays"])
    return Told(q, lengths, rates, accelerations, deviations, np.array(state["usable"], dtype=np.bool_))
