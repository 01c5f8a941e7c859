"""Steps of the shanks that are seen, and whether somebody walks."""

from dataclasses import asdict, dataclass, field

from services.flow.node import State
from services.segmentation.timed_up_and_go.instants import Instant
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters


@dataclass
class Swing:
    """Forward rotation of one shank that goes on."""

    angle: float = 0.0  # rad
    peak: float = 0.0  # rad/s
    counted: bool = False


@dataclass
class StepState:
    """Everything that changes."""

    swings: list[Swing] = field(default_factory=lambda: [Swing(), Swing()])
    steps_ns: list[int] = field(default_factory=list)  # instants at which steps were recognised
    bounces_ns: list[int] = field(default_factory=list)  # the same for bounces of a lone pelvis
    bounces: int = 0  # as last seen
    last_ns: int | None = None


class Steps:
    """Counts from `start` on."""

    def __init__(self, parameters: TimedUpAndGoParameters, *, sees_both: bool) -> None:
        """`sees_both`: both shanks wear a sensor."""
        self._parameters, self._sees_both = parameters, sees_both
        self.state = StepState()

    def start(self) -> None:
        """Forget what was counted."""
        self.state = StepState(bounces=self.state.bounces, last_ns=self.state.last_ns)

    def step(self, instant: Instant, shank_rates: list[float]) -> None:
        """Take the newest instant; rad/s of the shanks, left and right, not positive where they are not seen."""
        p, state, now_ns = self._parameters, self.state, instant.captured_ns
        dt_s = 0.0 if state.last_ns is None else (now_ns - state.last_ns) * 1e-9
        state.last_ns = now_ns
        for swing, rate in zip(state.swings, shank_rates, strict=True):
            if rate <= 0.0:
                swing.angle, swing.peak, swing.counted = 0.0, 0.0, False
                continue
            swing.angle, swing.peak = swing.angle + rate * dt_s, max(swing.peak, rate)
            if not swing.counted and swing.angle > p.swing_angle and swing.peak > p.swing_rate:
                swing.counted = True
                state.steps_ns.append(now_ns)
        if instant.bounces is not None:
            state.bounces_ns += [now_ns] * min(instant.bounces - state.bounces, p.bounces)
            del state.bounces_ns[: -p.bounces]
            state.bounces = instant.bounces

    def walks(self, since_ns: int) -> bool:
        """Whether there was walking since a time."""
        p, state = self._parameters, self.state
        swings, bounces = (sum(ns > since_ns for ns in times) for times in (state.steps_ns, state.bounces_ns))
        return swings >= p.swings or bounces >= p.bounces

    def of_both(self, start_ns: int, end_ns: int) -> int | None:
        """Steps of both legs within a span; None where one is not seen."""
        if not self._sees_both:
            return None
        return sum(start_ns < ns <= end_ns for ns in self.state.steps_ns)

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state)

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        swings = [Swing(**swing) for swing in state["swings"]]
        steps_ns, bounces_ns = list(state["steps_ns"]), list(state["bounces_ns"])
        self.state = StepState(swings, steps_ns, bounces_ns, state["bounces"], state["last_ns"])
