"""Steps told by a sensor on the lower back alone: contacts and toe-offs of both feet, with their sides."""

import math
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from statistics import median
from typing import NamedTuple

from schemas.vocabulary import GaitEventKind, Side
from services.flow.node import State
from services.segmentation.gait.swing import Contact, turning_point
from services.segmentation.parameters import SegmentationParameters


class SidedContact(NamedTuple):
    """A contact or toe-off and the foot it belongs to."""

    side: Side
    contact: Contact


class Smoothed(NamedTuple):
    """Acceleration of the lower back at one time, smoothed over a step's fraction."""

    captured_ns: int
    up: float  # m/s^2
    right: float  # m/s^2


class Catch(NamedTuple):
    """One foot comes down, then the other one leaves the ground."""

    contact_ns: int
    toe_off_ns: int


class Held(NamedTuple):
    """A catch with the evidence of its side: positive is a left contact, m/s^2."""

    catch: Catch
    leftness: float


@dataclass
class BackState:
    """Everything of the detector that changes."""

    window: list[tuple[int, float, float]] = field(default_factory=list)  # raw ns, up, right
    trail: list[Smoothed] = field(default_factory=list)
    climbing: bool = True
    top: tuple[int, float] | None = None  # where the last climb was highest
    bottom: float = 0.0  # m/s^2 below that climb
    own_climbs: list[float] = field(default_factory=list)  # m/s^2
    pending: list[Catch] = field(default_factory=list)  # those whose side is not seen yet
    held: list[Held] = field(default_factory=list)  # the run at hand, newest last
    own_steps_s: list[float] = field(default_factory=list)  # between them
    walking: bool = False
    leftness: float = 0.0


class BackStepDetector:
    """Finds each contact where the trunk is caught, and its side where the trunk is sent next.

    The smoothed upward acceleration climbs once a step, while the weight falls on the leading leg; contact lies a
    constant time after the steepest rise (the derivative that McCamley et al. 2012 take for it; here causal, with a
    smoothing of bounded length). A climb counts when it is large for this person. The other foot leaves the ground a
    constant time after the top.

    Side: on one leg the trunk is pushed away from the foot that stands, so at a left contact the rightward
    acceleration changes from negative to positive. Contacts alternate, so half of the last evidence counts against.

    A run of contacts is walking once it is long and even enough; its first contacts are held back until then.
    """

    def __init__(self, parameters: SegmentationParameters) -> None:
        self.parameters = parameters
        self.state = BackState()

    def step(self, captured_ns: int, up: float, right: float) -> list[SidedContact]:
        """Take the acceleration without gravity, m/s^2, and hand out the events that are now known, in order."""
        newest = self._smooth(captured_ns, up, right)
        self._climb(newest)
        p, state = self.parameters, self.state
        found: list[SidedContact] = []
        while state.pending and newest.captured_ns >= state.pending[0].contact_ns + int(p.back_side_after_s * 1e9):
            found += self._place(state.pending.pop(0))
        return found

    def interrupt(self) -> None:
        """Samples are missing: what was going on is given up."""
        self.state = BackState(own_climbs=self.state.own_climbs)

    def _smooth(self, captured_ns: int, up: float, right: float) -> Smoothed:
        """Mean over twice `back_smoothing_s` with raised-cosine weights, for the middle of that time."""
        state, reach_ns = self.state, int(self.parameters.back_smoothing_s * 1e9)
        state.window.append((captured_ns, up, right))
        old = next(i for i, row in enumerate(state.window) if row[0] > captured_ns - 2 * reach_ns)
        del state.window[:old]
        middle_ns, turn = captured_ns - reach_ns, math.pi / reach_ns
        total = ups = rights = 0.0
        for ns, one, other in state.window:
            weight = 1.0 + math.cos((ns - middle_ns) * turn)
            total += weight
            ups += weight * one
            rights += weight * other
        # A single sample at the very end of the window weighs nothing.
        smoothed = Smoothed(middle_ns, ups / total, rights / total) if total > 1e-9 else Smoothed(middle_ns, 0.0, 0.0)
        state.trail.append(smoothed)
        old_ns = middle_ns - int(self.parameters.back_memory_s * 1e9)
        if state.trail[0].captured_ns < old_ns:
            del state.trail[0]
        return smoothed

    def _climb(self, newest: Smoothed) -> None:
        """Follow the up and down of the upward acceleration; movements smaller than the threshold are not seen."""
        state, value = self.state, newest.up
        least = self._least_climb()
        if state.top is None:
            state.top, state.bottom = (newest.captured_ns, value), value
        if not state.climbing:
            state.bottom = min(state.bottom, value)
            if value - state.bottom >= least:
                state.climbing, state.top = True, (newest.captured_ns, value)
            return
        if value > state.top[1] or value < state.bottom:
            state.bottom = min(state.bottom, value)
            state.top = (newest.captured_ns, value)
        climb = state.top[1] - state.bottom
        if climb >= least and state.top[1] - value >= least:
            contact_ns = self._steepest_ns(state.top[0]) + int(self.parameters.back_contact_after_rise_s * 1e9)
            toe_off_ns = state.top[0] + int(self.parameters.back_toe_off_after_top_s * 1e9)
            state.pending.append(Catch(contact_ns, toe_off_ns))
            state.own_climbs = [*state.own_climbs[-self.parameters.back_climb_memory + 1 :], climb]
            state.climbing, state.bottom = False, value

    def _least_climb(self) -> float:
        own, p = self.state.own_climbs, self.parameters
        return max(p.back_climb_floor, p.back_climb_fraction * median(own) if own else 0.0)

    def _steepest_ns(self, top_ns: int) -> int:
        """When the climb to a top was steepest."""
        first_ns = top_ns - int(self.parameters.back_rise_s * 1e9)
        rows = [row for row in self.state.trail if first_ns <= row.captured_ns <= top_ns]
        slopes = [
            ((a.captured_ns + b.captured_ns) // 2, (b.up - a.up) / (b.captured_ns - a.captured_ns))
            for a, b in pairwise(rows)
        ]
        if not slopes:
            return top_ns
        return turning_point(slopes, max(range(len(slopes)), key=lambda i: slopes[i][1]))

    def _place(self, catch: Catch) -> list[SidedContact]:
        """Put a catch into the run of them; what may be handed out."""
        p, state = self.parameters, self.state
        since_s = (catch.contact_ns - state.held[-1].catch.contact_ns) * 1e-9 if state.held else None
        if since_s is not None and since_s < p.back_shortest_step_s:
            return []
        if since_s is None or not self._is_even(since_s):
            state.held, state.own_steps_s, state.walking, state.leftness = [], [], False, 0.0
        else:
            state.own_steps_s = [*state.own_steps_s[-p.back_step_memory + 1 :], since_s]
        state.leftness = self._push_right(catch.contact_ns) - 0.5 * state.leftness
        state.held.append(Held(catch, state.leftness))
        if not state.walking and len(state.held) < p.back_fewest_contacts:
            return []
        found = state.held[-1:] if state.walking else state.held
        state.held, state.walking = state.held[-1:], True
        return [event for held in found for event in self._events(held)]

    def _events(self, held: Held) -> list[SidedContact]:
        p, side = self.parameters, Side.LEFT if held.leftness > 0 else Side.RIGHT
        contact = Contact(GaitEventKind.INITIAL_CONTACT, held.catch.contact_ns, p.back_contact_std_s)
        toe_off = Contact(GaitEventKind.TOE_OFF, held.catch.toe_off_ns, p.back_toe_off_std_s)
        return [SidedContact(side, contact), SidedContact(side.other, toe_off)]

    def _is_even(self, step_s: float) -> bool:
        """Whether a step is as long as the others of its run."""
        p, own = self.parameters, self.state.own_steps_s
        if step_s > p.back_longest_step_s:
            return False
        return not own or 1.0 / p.back_uneven <= step_s / median(own) <= p.back_uneven

    def _push_right(self, contact_ns: int) -> float:
        """m/s^2 by which the rightward acceleration is larger after a contact than before it."""
        p = self.parameters
        edge_ns, before_ns, after_ns = (
            int(s * 1e9) for s in (p.back_side_edge_s, p.back_side_before_s, p.back_side_after_s)
        )
        return self._mean_right(contact_ns + edge_ns, contact_ns + after_ns) - self._mean_right(
            contact_ns - before_ns, contact_ns - edge_ns
        )

    def _mean_right(self, first_ns: int, last_ns: int) -> float:
        rights = [row.right for row in self.state.trail if first_ns <= row.captured_ns <= last_ns]
        return sum(rights) / len(rights) if rights else 0.0

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state)

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        top = state["top"]
        self.state = BackState(
            window=[(ns, up, right) for ns, up, right in state["window"]],
            trail=[Smoothed(*row) for row in state["trail"]],
            climbing=state["climbing"],
            top=None if top is None else (top[0], top[1]),
            bottom=state["bottom"],
            own_climbs=list(state["own_climbs"]),
            pending=[Catch(*row) for row in state["pending"]],
            held=[Held(Catch(*catch), leftness) for catch, leftness in state["held"]],
            own_steps_s=list(state["own_steps_s"]),
            walking=state["walking"],
            leftness=state["leftness"],
        )
