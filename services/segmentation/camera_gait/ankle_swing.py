"""One leg's swings, told by how far its ankle is ahead of the pelvis."""

from dataclasses import asdict, dataclass, field
from statistics import median

import numpy as np

from schemas.vocabulary import GaitEventKind
from services.flow.node import State
from services.segmentation.camera_gait.parameters import CameraGaitParameters
from services.segmentation.gait.swing import Contact


@dataclass
class AnkleState:
    """Everything of a detector that changes. `trail` reaches back to before the last turning point."""

    swinging: bool = False
    hindmost: tuple[int, float] | None = None  # since the last contact: ns, m
    foremost: tuple[int, float] = (0, 0.0)  # of the swing at hand
    toe_off_ns: int = 0
    lifted: float = 0.0  # m, where the swing began
    own_swings: list[float] = field(default_factory=list)  # m
    trail: list[tuple[int, float]] = field(default_factory=list)


class AnkleSwingDetector:
    """Zeni's coordinate rule (2008): contact at the foremost, toe-off at the hindmost ankle, against the pelvis.

    A coming forward that is large for this person is a swing. Both turning points are vertices of parabolas through
    the samples around them, since a camera's frame lasts 33 ms and its noise moves the extreme by more. A foot that
    comes to rest beside the other one has no foremost point: its contact is where it has stopped.
    """

    def __init__(self, parameters: CameraGaitParameters) -> None:
        self.parameters = parameters
        self.state = AnkleState()

    def step(self, captured_ns: int, forward: float) -> Contact | None:
        """Take how far the ankle is ahead of the pelvis, m; the event that is recognised now."""
        state = self.state
        state.trail.append((captured_ns, forward))
        if state.swinging:
            return self._land(captured_ns, forward)
        if state.hindmost is None or forward <= state.hindmost[1]:
            state.hindmost = (captured_ns, forward)
        self._forget(state.hindmost[0])
        if forward - state.hindmost[1] < self._least_swing():
            return None
        return self._lift(captured_ns, forward)

    def interrupt(self) -> None:
        """Samples are missing: what was going on is given up."""
        self.state = AnkleState(own_swings=self.state.own_swings)

    def _least_swing(self) -> float:
        p, own = self.parameters, self.state.own_swings
        return max(p.swing_floor_m, p.swing_share * median(own)) if own else p.swing_floor_m

    def _lift(self, captured_ns: int, forward: float) -> Contact:
        state, p = self.state, self.parameters
        assert state.hindmost is not None
        state.swinging, state.foremost, state.lifted = True, (captured_ns, forward), state.hindmost[1]
        state.toe_off_ns = self._turned_ns(state.hindmost[0]) + round(p.toe_off_after_hindmost_s * 1e9)
        return Contact(GaitEventKind.TOE_OFF, state.toe_off_ns, p.toe_off_std_s)

    def _land(self, captured_ns: int, forward: float) -> Contact | None:
        state, p = self.state, self.parameters
        if forward > state.foremost[1]:
            state.foremost = (captured_ns, forward)
        self._forget(state.foremost[0])
        swing = state.foremost[1] - state.lifted
        if state.foremost[1] - forward >= max(p.back_floor_m, p.back_share * swing):
            at_ns = self._turned_ns(state.foremost[0]) + round(p.contact_after_foremost_s * 1e9)
            return self._put_down(at_ns, p.contact_std_s, swing)
        if captured_ns - state.foremost[0] > p.landing_timeout_s * 1e9:
            return self._put_down(state.foremost[0], p.resting_contact_std_s, swing)
        return None

    def _put_down(self, contact_ns: int, std_s: float, swing: float) -> Contact | None:
        state, p = self.state, self.parameters
        trail = [(ns, forward) for ns, forward in state.trail if ns >= state.foremost[0]]
        hindmost = min(reversed(trail), key=lambda sample: sample[1])
        own = [*state.own_swings[-p.swing_memory + 1 :], swing]
        after_toe_off = contact_ns > state.toe_off_ns
        self.state = AnkleState(hindmost=hindmost, own_swings=own, trail=trail)
        return Contact(GaitEventKind.INITIAL_CONTACT, contact_ns, std_s) if after_toe_off else None

    def _turned_ns(self, extreme_ns: int) -> int:
        """The vertex of the least-squares parabola around an extreme; the extreme where there is none nearby."""
        reach_ns = round(self.parameters.turn_reach_s * 1e9)
        near = [(ns, forward) for ns, forward in self.state.trail if abs(ns - extreme_ns) <= reach_ns]
        if len(near) < 4:
            return extreme_ns
        time_s = np.array([(ns - extreme_ns) / 1e9 for ns, _ in near])
        bend, slope, _ = np.polyfit(time_s, np.array([forward for _, forward in near]), 2)
        shift_s = -slope / (2.0 * bend) if bend != 0.0 else 0.0
        return extreme_ns + round(float(np.clip(shift_s, time_s[0], time_s[-1])) * 1e9)

    def _forget(self, needed_ns: int) -> None:
        oldest = needed_ns - round(self.parameters.turn_reach_s * 1e9)
        kept = next(i for i, (ns, _) in enumerate(self.state.trail) if ns >= oldest)
        del self.state.trail[:kept]

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state)

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        hindmost = state["hindmost"]
        self.state = AnkleState(
            swinging=state["swinging"],
            hindmost=None if hindmost is None else (hindmost[0], hindmost[1]),
            foremost=(state["foremost"][0], state["foremost"][1]),
            toe_off_ns=state["toe_off_ns"],
            lifted=state["lifted"],
            own_swings=list(state["own_swings"]),
            trail=[(ns, forward) for ns, forward in state["trail"]],
        )
