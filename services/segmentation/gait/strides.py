"""Strides out of contacts: pairs them, measures them, and says why one does not count."""

from collections.abc import Callable
from dataclasses import asdict, dataclass, field

import numpy as np

from schemas.gait import Stride, StrideCurve
from schemas.session import Anthropometry
from schemas.vocabulary import GaitEventKind, Side
from services.flow.node import State
from services.segmentation.batch import COLUMNS
from services.segmentation.gait.circumduction import circumduction
from services.segmentation.gait.history import HEADING, History, Span
from services.segmentation.gait.step_length import StepLength, step_length
from services.segmentation.gait.swing import Contact
from services.segmentation.parameters import SegmentationParameters

GAP = "samples are missing within the stride"
OUT_OF_VIEW = "the camera did not see this leg within the stride"
SENSOR_MISSING = "a sensor of this leg was missing within the stride"
TOO_SHORT = "shorter than a stride can be"
NO_OTHER_CONTACT = "the other foot did not come down within the stride"
MANY_OTHER_CONTACTS = "the other foot came down more than once within the stride"
NOT_ALTERNATING = "both feet came down together"
PHASE_SHORT = "the rhythm saw less than one stride"
PHASE_LONG = "the rhythm saw more than one stride"


@dataclass
class Flaw:
    """A time during which a leg was not seen. `until_ns` is None while it goes on."""

    from_ns: int
    until_ns: int | None
    reason: str


@dataclass
class Leg:
    """What is known of one leg."""

    contacts: list[int] = field(default_factory=list)
    toe_offs: list[int] = field(default_factory=list)
    flaws: list[Flaw] = field(default_factory=list)
    bout_start_ns: int | None = None  # last contact of the bout; a stride can begin there
    strides: int = 0

    def flaw_within(self, start_ns: int, end_ns: int) -> str | None:
        """Why the leg was not seen all the time."""
        for flaw in self.flaws:
            if flaw.from_ns < end_ns and (flaw.until_ns is None or flaw.until_ns > start_ns):
                return flaw.reason
        return None


StepMeasure = Callable[[Side, int, int, Span], StepLength | None]
"""The step of a leading foot at its contact, ns, after the other foot's contact, ns, within a stride."""
WidthMeasure = Callable[[Side, int, int], float | None]
"""m, how far apart sideways the feet are put in that step."""


class StrideAssembler:
    """Takes contacts and holes as they become known, hands out strides in order of their end.

    A stride waits `release_delay_s`, so that a contact of the other foot that is noticed later but lies within it
    is not missed. Steps are measured by the joint angles at the contacts unless there is another measure; their width
    only where there is a measure, for the angles of inertial sensors do not tell it.
    """

    def __init__(
        self,
        parameters: SegmentationParameters,
        body: Anthropometry,
        history: History,
        measure_step: StepMeasure | None = None,
        measure_width: WidthMeasure | None = None,
    ) -> None:
        self.parameters = parameters
        self.body = body
        self.history = history
        self._measure_step = measure_step or self._step_by_angles
        self._measure_width = measure_width
        self.legs = {side: Leg() for side in Side}
        self._waiting: list[tuple[int, int, Side]] = []  # end, start, side

    def add_event(self, side: Side, event: Contact) -> None:
        """A new event of one foot."""
        leg, at = self.legs[side], event.captured_ns
        if event.kind is GaitEventKind.TOE_OFF:
            leg.toe_offs.append(at)
            return
        leg.contacts.append(at)
        start_ns, leg.bout_start_ns = leg.bout_start_ns, at
        if start_ns is not None and 0 < at - start_ns <= self.parameters.longest_stride_s * 1e9:
            self._waiting.append((at, start_ns, side))
            self._waiting.sort()

    def add_flaw(self, side: Side, flaw: Flaw) -> None:
        """The leg was not seen for a while."""
        self.legs[side].flaws.append(flaw)

    def end_bout(self) -> None:
        """The person stands: the next contact of either foot begins a stride but ends none."""
        for leg in self.legs.values():
            leg.bout_start_ns = None

    def release(self, now_ns: int | None) -> list[Stride]:
        """The strides that have waited long enough; all of them when `now_ns` is None."""
        strides: list[Stride] = []
        ripe_ns = None if now_ns is None else now_ns - int(self.parameters.release_delay_s * 1e9)
        while self._waiting and (ripe_ns is None or self._waiting[0][0] <= ripe_ns):
            end_ns, start_ns, side = self._waiting.pop(0)
            stride = self._measure(side, start_ns, end_ns)
            strides += [] if stride is None else [stride]
        return strides

    def forget(self, now_ns: int) -> None:
        """Drop what no stride can need any more."""
        p = self.parameters
        starts = [start for _, start, _ in self._waiting]
        starts += [leg.bout_start_ns for leg in self.legs.values() if leg.bout_start_ns is not None]
        margin_ns = int(p.history_margin_s * 1e9)
        longest_ns = int((p.longest_stride_s + p.release_delay_s) * 1e9)
        oldest = max(min([*starts, now_ns]), now_ns - longest_ns) - margin_ns
        self.history.forget_before(oldest)
        for leg in self.legs.values():
            leg.contacts = [ns for ns in leg.contacts if ns >= oldest]
            leg.toe_offs = [ns for ns in leg.toe_offs if ns >= oldest]
            leg.flaws = [flaw for flaw in leg.flaws if flaw.until_ns is None or flaw.until_ns >= oldest]

    def _measure(self, side: Side, start_ns: int, end_ns: int) -> Stride | None:
        span = self.history.between(start_ns, end_ns)
        if span is None:
            return None
        leg, other = self.legs[side], self.legs[side.other]
        opposite = [ns for ns in other.contacts if start_ns < ns < end_ns]
        opposite_ns = opposite[0] if len(opposite) == 1 else None
        toe_off_ns = next((ns for ns in leg.toe_offs if start_ns < ns < end_ns), None)
        stride_time_s = (end_ns - start_ns) * 1e-9
        step = self._step(side, end_ns, opposite_ns, span)
        first_step = None if opposite_ns is None else self._step(side.other, opposite_ns, start_ns, span)
        stride_length = None if step is None or first_step is None else step.length_m + first_step.length_m
        turned = span.curve(HEADING)[-1] - span.curve(HEADING)[0]
        reason = self._reason(side, span, opposite)
        leg.strides += 1
        return Stride(
            side=side,
            index=leg.strides - 1,
            start_ns=start_ns,
            toe_off_ns=toe_off_ns,
            opposite_contact_ns=opposite_ns,
            opposite_toe_off_ns=_lifted_before(other, start_ns, opposite_ns),
            end_ns=end_ns,
            stride_time_s=stride_time_s,
            stance_fraction=None if toe_off_ns is None else (toe_off_ns - start_ns) / (end_ns - start_ns),
            step_time_s=None if opposite_ns is None else (end_ns - opposite_ns) * 1e-9,
            step_length_m=None if step is None else step.length_m,
            step_length_std_m=None if step is None else step.std_m,
            stride_length_m=stride_length,
            walking_speed=None if stride_length is None else stride_length / stride_time_s,
            step_width_m=self._width(side, end_ns, opposite_ns),
            circumduction_m=self._circumduction(side, opposite_ns, end_ns),
            turn=float(turned),
            phase_advance=span.phase_advance(),
            turning=bool(abs(turned) > self.parameters.turn_limit),
            valid=reason is None,
            rejected_because=reason,
            curves=_curves(span),
        )

    def _step(self, leading: Side, contact_ns: int, trailing_ns: int | None, span: Span) -> StepLength | None:
        return None if trailing_ns is None else self._measure_step(leading, contact_ns, trailing_ns, span)

    def _step_by_angles(self, leading: Side, contact_ns: int, trailing_ns: int, span: Span) -> StepLength | None:
        now, then = self.history.at(contact_ns), self.history.at(trailing_ns)
        if now is None or then is None:
            return None
        return step_length(leading, now, then, span.mean_heading(), self.body, self.parameters.foot_roll_share)

    def _width(self, leading: Side, contact_ns: int, trailing_ns: int | None) -> float | None:
        if self._measure_width is None or trailing_ns is None:
            return None
        return self._measure_width(leading, contact_ns, trailing_ns)

    def _circumduction(self, side: Side, opposite_ns: int | None, end_ns: int) -> float | None:
        standing = None if opposite_ns is None else self.history.between(opposite_ns, end_ns)
        return None if standing is None else circumduction(side, standing, self.body)

    def _reason(self, side: Side, span: Span, opposite: list[int]) -> str | None:
        """Why the stride does not count; None when it does."""
        p, start_ns, end_ns = self.parameters, span.start_ns, span.end_ns
        flaw = self.legs[side].flaw_within(start_ns, end_ns)
        if flaw is not None:
            return flaw
        if end_ns - start_ns < p.shortest_stride_s * 1e9:
            return TOO_SHORT
        advance = span.phase_advance()
        if advance is not None and advance < p.least_phase * 2 * np.pi:
            return PHASE_SHORT
        if advance is not None and advance > p.most_phase * 2 * np.pi:
            return PHASE_LONG
        if self.legs[side.other].flaw_within(start_ns, end_ns) is not None:
            return None
        if len(opposite) != 1:
            return MANY_OTHER_CONTACTS if opposite else NO_OTHER_CONTACT
        share = (opposite[0] - start_ns) / (end_ns - start_ns)
        return None if p.least_step_share <= share <= 1 - p.least_step_share else NOT_ALTERNATING

    def snapshot(self) -> State:
        """Legs and waiting strides as JSON values."""
        return {
            "legs": {side.value: asdict(leg) for side, leg in self.legs.items()},
            "waiting": [list(entry) for entry in self._waiting],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`; the history is restored by its owner."""
        for side in Side:
            kept = state["legs"][side]
            flaws = [Flaw(**flaw) for flaw in kept["flaws"]]
            contacts, toe_offs = list(kept["contacts"]), list(kept["toe_offs"])
            self.legs[side] = Leg(contacts, toe_offs, flaws, kept["bout_start_ns"], kept["strides"])
        self._waiting = [(end, start, Side(side)) for end, start, side in state["waiting"]]


def _lifted_before(other: Leg, start_ns: int, contact_ns: int | None) -> int | None:
    """When the other foot left the ground, on its way to its contact within the stride."""
    return None if contact_ns is None else next((ns for ns in other.toe_offs if start_ns < ns < contact_ns), None)


def _curves(span: Span) -> dict[str, StrideCurve]:
    # Six decimals, 1e-6 rad, keep the message short.
    return {
        name: StrideCurve(
            position=[round(float(value), 6) for value in span.curve(i)],
            position_std=round(float(span.position_std[i]), 6),
        )
        for i, name in enumerate(COLUMNS[: len(span.valid)])
        if span.valid[i]
    }
