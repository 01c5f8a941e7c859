"""When to ask a producer's ring for what is missing of a stream, and when to stop asking."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic

from services.flow.inbox import Hole, Item, OrderedInbox
from services.flow.message import Envelope
from services.flow.ring import Place, Question, RingExtent


@dataclass(frozen=True)
class RepairTimes:
    """Patience, all in s."""

    hole: float = 0.3
    """The substrate's own recovery takes a round trip; what it has not filled by now, it will not."""
    give_up: float = 5.0
    """A producer that still speaks, but does not answer for a hole, has not got it."""
    absent: float = 60.0
    """One that is silent too may be starting anew, on a busy machine for long; it will fill the hole itself. To wait
    costs nothing: what comes behind the hole has come already."""
    silence: float = 2.0
    """A stream's last messages leave no hole when they are lost, so silence is questioned; ever more rarely."""
    longest_silence: float = 30.0
    answer: float = 3.0
    """A question without a word after this time is taken as unanswered."""


DEFAULT_TIMES = RepairTimes()


class Repair(Generic[Item]):
    """Watches one inbox. Times are monotonic seconds given by the caller, so a test can be the clock.

    The first question asks for everything after the inbox's position. Later ones ask for the first hole, or, after
    an answer that said there is more and after silence, for everything after the position again.
    """

    def __init__(self, inbox: OrderedInbox[Item], now: float, times: RepairTimes = DEFAULT_TIMES) -> None:
        self._inbox = inbox
        self._times = times
        self._asked_at: float | None = None
        self._asked_from = self._place()
        self._answered_at = now
        self._begun = False
        self._hurry = True
        self._newest = Place(-1, -1)
        self._heard_at = now
        self._speaks_since = now
        self._silence = times.silence
        self._hole: Hole | None = None
        self._hole_since = now
        self._hole_questions = 0

    def heard(self, now: float) -> None:
        """A live message of the stream came."""
        if self._is_absent(now):
            self._speaks_since = now
        self._heard_at = now
        self._silence = self._times.silence

    @property
    def is_settled(self) -> bool:
        """Asked, answered, and nothing of the answer is missing."""
        answered = self._begun and self._asked_at is None
        return answered and self._newest <= self._place() and self._inbox.hole() is None

    def question(self, now: float) -> Question | None:
        """What to ask now; the caller then owes an `answered`."""
        if self._asked_at is not None:
            if now - self._asked_at < self._times.answer:
                return None
            self._hole_questions += 1
        self._asked_at = None
        question = self._choose(now)
        if question is not None:
            self._asked_at = now
            self._asked_from = self._place()
            self._begun = True
            self._hurry = False
        return question

    def answered(self, now: float, extents: Sequence[RingExtent]) -> list[tuple[Envelope, Item]]:
        """The answer, if any, is in the inbox; `extents` are those of the rings that spoke.

        What the oldest ring does not reach back to is given up at once, what stays missing after a while: the
        messages that waited behind it.
        """
        self._asked_at = None
        self._answered_at = now
        self._hole_questions += 1
        self._watch_hole(now)
        ready = self._give_up(now, extents)
        self._newest = max((extent.newest for extent in extents), default=self._newest)
        progress = self._place() > self._asked_from
        self._hurry = progress and (self._newest > self._place() or self._inbox.hole() is not None)
        return ready

    def _choose(self, now: float) -> Question | None:
        self._watch_hole(now)
        patient = self._hurry or now - self._answered_at >= self._times.hole
        if not self._begun or (self._newest > self._place() and patient):
            return self._everything_after()
        if self._hole is not None:
            old = self._hurry or now - self._hole_since >= self._times.hole
            return Question(*self._hole) if old and patient else None
        ended = self._inbox.position is not None and self._inbox.position.ended
        if not ended and now - max(self._heard_at, self._answered_at) >= self._silence:
            self._silence = min(2 * self._silence, self._times.longest_silence)
            return self._everything_after()
        return None

    def _watch_hole(self, now: float) -> None:
        hole = self._inbox.hole()
        if hole is None or self._hole is None or (hole.epoch, hole.first) != (self._hole.epoch, self._hole.first):
            self._hole_since = now
            self._hole_questions = 0
        self._hole = hole

    def _give_up(self, now: float, extents: Sequence[RingExtent]) -> list[tuple[Envelope, Item]]:
        hole = self._inbox.hole()
        if hole is None:
            return []
        oldest = min((extent.oldest for extent in extents), default=None)
        if oldest is not None and oldest > Place(hole.epoch, hole.first):
            return self._inbox.give_up(oldest.sequence - 1 if oldest.epoch == hole.epoch else None)
        since = max(self._hole_since, self._speaks_since)
        patience = self._times.absent if self._is_absent(now) else self._times.give_up
        return self._inbox.give_up() if self._hole_questions >= 2 and now - since >= patience else []

    def _is_absent(self, now: float) -> bool:
        return now - self._heard_at >= self._times.silence

    def _everything_after(self) -> Question:
        position = self._inbox.position
        return Question(None, 0, None) if position is None else Question(position.epoch, position.sequence + 1, None)

    def _place(self) -> Place:
        position = self._inbox.position
        return Place(-1, -1) if position is None else Place(position.epoch, position.sequence)
