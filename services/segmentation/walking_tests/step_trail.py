"""The steps of a walk in order, and how far each has brought the person."""

from bisect import bisect_left, bisect_right
from dataclasses import asdict, dataclass, field
from operator import attrgetter
from typing import NamedTuple

from schemas.gait import Stride
from schemas.vocabulary import Side
from services.flow.node import State
from services.segmentation.walking_tests.parameters import WalkingTestParameters


class Landing(NamedTuple):
    """A foot comes down."""

    side: Side
    at_ns: int
    std_s: float
    onward: float  # share of the step that goes along the straight way: less in a turn
    apart_m: float | None  # how far it is ahead of the other foot, where the posture tells it
    lost_s: float  # s without samples since the one before
    turning: bool  # the person turned within the step
    missed_m: float  # what the other foot went first, unseen


@dataclass
class Step:
    """A landing whose stride may still come."""

    at_ns: int
    side: str
    std_s: float
    lifted_ns: int | None  # when its foot left the ground
    first: bool  # after standing
    onward: float
    apart_m: float | None
    lost_s: float
    turning: bool
    length_m: float | None = None
    length_std_m: float = 0.0


class Mark(NamedTuple):
    """A step whose length is settled; sums since the session started."""

    at_ns: int
    std_s: float
    lifted_ns: int
    walked_m: float
    variance_m2: float  # of what each step errs by itself
    first: bool


@dataclass
class TrailState:
    """Everything that changes."""

    waiting: list[Step] = field(default_factory=list)
    marks: list[Mark] = field(default_factory=list)
    contacts_ns: list[int] = field(default_factory=list)
    forgotten: int = 0  # contacts that are no longer in the list
    toe_off_ns: dict[str, int] = field(default_factory=dict)  # newest of each foot
    row: int = 0  # contacts since the person stood
    begun_ns: int = 0  # first toe-off of the row
    measured: bool = False  # a length was ever measured
    speed: float = 0.0  # m/s, the person's own


class StepTrail:
    """Contacts as they come, lengths as strides bring them; what no stride measures is filled in and less sure."""

    def __init__(self, parameters: WalkingTestParameters) -> None:
        self._parameters = parameters
        self.state = TrailState()

    @property
    def last_ns(self) -> int | None:
        """The newest contact."""
        contacts = self.state.contacts_ns
        return contacts[-1] if contacts else None

    def lifted_ns(self, side: Side, at_ns: int) -> int:
        """When the foot that lands left the ground, as far as that was seen."""
        seen = self.state.toe_off_ns.get(side.value)
        usual = at_ns - round(self._parameters.swing_s * 1e9)
        return seen if seen is not None and at_ns - 2_000_000_000 < seen < at_ns else usual

    def lift(self, side: Side, at_ns: int) -> None:
        """A foot left the ground."""
        self.state.toe_off_ns[side.value] = at_ns

    def land(self, landing: Landing, stands: bool) -> None:
        """A foot came down. `stands`: the person stood before."""
        p, state, last_ns, at_ns = self._parameters, self.state, self.last_ns, landing.at_ns
        if last_ns is not None and at_ns <= last_ns:
            return
        lifted_ns = state.toe_off_ns.get(landing.side.value)
        if lifted_ns is not None and not max(last_ns or 0, at_ns - round(p.rest_s * 1e9)) - 5e8 < lifted_ns < at_ns:
            lifted_ns = None
        first = stands or last_ns is None
        apart_m = landing.apart_m
        if first:
            state.row, state.begun_ns = 0, lifted_ns or at_ns - round(p.swing_s * 1e9)
            if landing.missed_m and apart_m is not None:
                state.begun_ns -= round(p.first_step_s * 1e9)
                apart_m += landing.missed_m
        state.row += 1
        state.contacts_ns.append(at_ns)
        state.waiting.append(
            Step(
                at_ns, landing.side.value, landing.std_s, lifted_ns, first, landing.onward, apart_m, landing.lost_s,
                landing.turning,
            )
        )  # fmt: skip

    def measure(self, stride: Stride) -> None:
        """A stride tells the step that ends it, and the other foot's within it."""
        if stride.step_length_m is None:
            return
        std_m = stride.step_length_std_m or 0.0
        self._measure(stride.end_ns, stride.side, stride.step_length_m, std_m)
        if stride.opposite_contact_ns is not None and stride.stride_length_m is not None:
            other_m = stride.stride_length_m - stride.step_length_m
            self._measure(stride.opposite_contact_ns, stride.side.other, other_m, std_m)

    def _measure(self, at_ns: int, side: Side, length_m: float, std_m: float) -> None:
        for step in self.state.waiting:
            if step.at_ns == at_ns and step.side == side.value and step.length_m is None:
                step.length_m, step.length_std_m = length_m, std_m
                self.state.measured = True

    def settle(self, now_ns: int | None) -> None:
        """Sum up the steps that have a length, or have waited long enough for one; all of them for None."""
        p, state = self._parameters, self.state
        while state.waiting:
            step = state.waiting[0]
            if now_ns is not None and step.length_m is None and now_ns - step.at_ns < p.settled_s * 1e9:
                break
            self._sum_up(state.waiting.pop(0))
        oldest_ns = 0 if now_ns is None else now_ns - round(p.steps_memory_s * 1e9)
        while len(state.marks) > 3 and state.marks[2].at_ns < oldest_ns:
            del state.marks[0]
        while len(state.contacts_ns) > 3 and state.contacts_ns[2] < oldest_ns:
            del state.contacts_ns[0]
            state.forgotten += 1

    def _sum_up(self, step: Step) -> None:
        p, state = self._parameters, self.state
        last = state.marks[-1] if state.marks else None
        since_s = p.swing_s if last is None or step.first else (step.at_ns - last.at_ns) * 1e-9
        length_m, std_m = self._length(step, since_s)
        if step.length_m is not None and not step.first and step.lost_s == 0.0:
            share = 1 / p.own_steps if state.speed else 1.0
            state.speed += share * (length_m / since_s - state.speed)
        before_m, variance = (0.0, 0.0) if last is None else (last.walked_m, last.variance_m2)
        swing_s = min(p.swing_s, p.swing_share * since_s) if not step.first else p.swing_s
        lifted_ns = step.at_ns - round(swing_s * 1e9) if step.lifted_ns is None else step.lifted_ns
        walked_m = before_m + max(0.0, length_m) * step.onward
        state.marks.append(Mark(step.at_ns, step.std_s, lifted_ns, walked_m, variance + std_m**2, step.first))

    def _length(self, step: Step, since_s: float) -> tuple[float, float]:
        """m, with its own deviation: as measured, else by the feet's distance at contact, else at the own speed."""
        p = self._parameters
        if step.lost_s > p.lost_s:
            length_m = self.state.speed * since_s
        elif step.length_m is not None and not (step.turning and step.apart_m is not None):
            return step.length_m, step.length_std_m
        elif step.apart_m is not None:
            length_m = step.apart_m
        else:
            length_m = p.first_step_m if step.first or not self.state.speed else self.state.speed * since_s
        return length_m, p.unmeasured_std_share * abs(length_m)

    def walked(self, at_ns: int) -> tuple[float, float] | None:
        """m since the session started and their variance, between two contacts; None where nothing was measured."""
        marks = self.state.marks
        if not self.state.measured or not marks:
            return None
        i = bisect_left(marks, at_ns, key=attrgetter("at_ns"))
        if i == 0 or i == len(marks):
            end = marks[min(i, len(marks) - 1)]
            return end.walked_m, end.variance_m2
        before, after = marks[i - 1], marks[i]
        begun_ns = max(before.at_ns, min(after.lifted_ns, after.at_ns - 1)) if after.first else before.at_ns
        part = min(1.0, max(0.0, (at_ns - begun_ns) / (after.at_ns - begun_ns)))
        walked_m = before.walked_m + part * (after.walked_m - before.walked_m)
        return walked_m, before.variance_m2 + part * (after.variance_m2 - before.variance_m2)

    def steps(self, until_ns: int) -> int:
        """Contacts up to an instant."""
        return self.state.forgotten + bisect_right(self.state.contacts_ns, until_ns)

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state) | {"marks": [list(mark) for mark in self.state.marks]}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        made = {
            "waiting": [Step(**step) for step in state["waiting"]],
            "marks": [Mark(*mark) for mark in state["marks"]],
            "contacts_ns": list(state["contacts_ns"]),
            "toe_off_ns": dict(state["toe_off_ns"]),
        }
        self.state = TrailState(**{**state, **made})
