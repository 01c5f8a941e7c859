"""One leg's swings: when the foot left the ground and when it came down again."""

from dataclasses import asdict, dataclass, field
from statistics import median
from typing import NamedTuple

from schemas.vocabulary import GaitEventKind
from services.flow.node import State
from services.segmentation.parameters import SegmentationParameters


class Contact(NamedTuple):
    """An event as the detector sees it."""

    kind: GaitEventKind
    captured_ns: int
    std_s: float


@dataclass
class Rotation:
    """Forward rotation of the shank that goes on."""

    start_ns: int  # the rate passes zero, between two samples
    angle: float  # rad
    peak: float  # rad/s
    end_ns: int  # the rate passes zero again; the newest sample while the rotation goes on
    ended: bool


@dataclass
class SwingState:
    """Everything of a detector that changes."""

    last_ns: int | None = None
    last_rate: float = 0.0
    rotation: Rotation | None = None
    swinging: bool = False
    toe_off_ns: int = 0
    hindmost: float = 0.0
    own_angles: list[float] = field(default_factory=list)
    trail: list[tuple[int, float]] = field(default_factory=list)


class SwingDetector:
    """Finds swings in the shank's rotation and times them by the ankle.

    A swing is a forward rotation of the shank that is large for this person. Toe-off is timed by the hindmost ankle
    before it and by the start of the rotation, initial contact by the foremost ankle at its end, ankles relative to the
    pelvis: these turning points exist in slow and in asymmetric gait and survive the smoothing of an estimator better
    than the troughs of the rate do. Before a slow or a weak push-off the ankle lingers, and soft tissue that moves
    decides where it is hindmost; the rotation starts as sharply as ever. Toe-off is reported in early swing (about
    0.2 s late), contact when the ankle has come back a little or after `landing_timeout_s`.
    """

    def __init__(self, parameters: SegmentationParameters) -> None:
        self.parameters = parameters
        self.state = SwingState()

    @property
    def rotating(self) -> bool:
        """The shank has rotated forward by half of what makes a swing, half as fast, and still does."""
        rotation = self.state.rotation
        if rotation is None or rotation.ended or rotation.peak < 0.5 * self.parameters.swing_rate_floor:
            return False
        return rotation.angle > 0.5 * self._swing_angle()

    def step(self, captured_ns: int, rate: float, forward: float, other_rotating: bool) -> Contact | None:
        """Take the shank rate (rad/s, forward positive) and the ankle's place ahead of the pelvis (m)."""
        state = self.state
        state.trail.append((captured_ns, forward))
        self._follow_rotation(captured_ns, rate)
        state.last_ns, state.last_rate = captured_ns, rate
        if state.swinging:
            return self._land(captured_ns)
        self._forget()
        return self._lift() if not other_rotating else None

    def interrupt(self) -> None:
        """Samples are missing: what was going on is given up."""
        memory = self.state.own_angles
        self.state = SwingState(own_angles=memory)

    def _swing_angle(self) -> float:
        own, p = self.state.own_angles, self.parameters
        return max(p.swing_angle_floor, p.swing_angle_fraction * median(own) if own else 0.0)

    def _follow_rotation(self, captured_ns: int, rate: float) -> None:
        state, p = self.state, self.parameters
        rotation = state.rotation
        dt = 0.0 if state.last_ns is None else (captured_ns - state.last_ns) * 1e-9
        if rotation is None:
            if rate > 0:
                state.rotation = Rotation(self._zero_ns(captured_ns, rate), 0.0, rate, captured_ns, ended=False)
        elif rate > 0:
            if not rotation.ended:
                rotation.angle += rate * dt
                rotation.peak = max(rotation.peak, rate)
                rotation.end_ns = captured_ns
        elif state.swinging:
            # The rotation is kept until the foot has landed.
            if not rotation.ended:
                rotation.end_ns, rotation.ended = self._zero_ns(captured_ns, rate), True
        else:
            rotation.angle += rate * dt
            if rate < -p.swing_end_rate or rotation.angle <= 0:
                state.rotation = None
        if not state.swinging and rotation is not None and captured_ns - rotation.start_ns > p.most_swing_s * 1e9:
            state.rotation = None

    def _zero_ns(self, captured_ns: int, rate: float) -> int:
        """When the rate passed zero on its way to this sample; the sample's own time when it did not."""
        last_ns, last_rate = self.state.last_ns, self.state.last_rate
        if last_ns is None or (last_rate > 0) == (rate > 0):
            return captured_ns
        return last_ns + round((captured_ns - last_ns) * last_rate / (last_rate - rate))

    def _forget(self) -> None:
        state = self.state
        begin = state.last_ns if state.rotation is None else state.rotation.start_ns
        assert begin is not None
        oldest = begin - int(self.parameters.hindmost_search_s * 1e9)
        kept = next(i for i, (ns, _) in enumerate(state.trail) if ns >= oldest)
        del state.trail[:kept]

    def _lift(self) -> Contact | None:
        state, p = self.state, self.parameters
        rotation = state.rotation
        if rotation is None or rotation.angle < self._swing_angle() or rotation.peak < p.swing_rate_floor:
            return None
        toe_off = self._time_toe_off(rotation)
        state.toe_off_ns, state.swinging = toe_off.captured_ns, True
        return toe_off

    def _time_toe_off(self, rotation: Rotation) -> Contact:
        state, p = self.state, self.parameters
        before = [i for i, (ns, _) in enumerate(state.trail) if ns <= rotation.start_ns]
        at = min(before, key=lambda i: state.trail[i][1])
        state.hindmost = state.trail[at][1]
        toe_off_ns = self._agreed(turning_point(state.trail, at), rotation)
        # What was before belongs to the last stride: its foremost point must not be taken for this one's.
        del state.trail[:at]
        return Contact(GaitEventKind.TOE_OFF, toe_off_ns, p.toe_off_std_s)

    def _agreed(self, hindmost_ns: int, rotation: Rotation) -> int:
        """Half-way between what the hindmost ankle says and what the start of the shank's rotation says.

        Both constants are those of force plates, where their errors are independent: 15 and 14 ms, their mean 9 ms.
        A rotation that began long before or after the ankle turned was not that of the swing alone.
        """
        p = self.parameters
        by_ankle_ns = hindmost_ns + int(p.toe_off_after_hindmost_s * 1e9)
        by_shank_ns = rotation.start_ns - int(p.shank_toe_off_before_swing_s * 1e9)
        if abs(by_shank_ns - by_ankle_ns) > p.toe_off_rules_apart_s * 1e9:
            return by_ankle_ns
        return (by_ankle_ns + by_shank_ns) // 2

    def _land(self, captured_ns: int) -> Contact | None:
        p, rotation = self.parameters, self.state.rotation
        assert rotation is not None
        if captured_ns - rotation.start_ns > (p.most_swing_s + p.landing_timeout_s) * 1e9:
            self.interrupt()
            return None
        contact = self._time_contact(captured_ns, rotation) if rotation.ended else None
        return None if contact is None else self._put_down(contact)

    def _time_contact(self, captured_ns: int, rotation: Rotation) -> Contact | None:
        """The contact that ends the swing, once it is sure."""
        state, p = self.state, self.parameters
        at = max(range(len(state.trail)), key=lambda i: state.trail[i][1])
        foremost = state.trail[at][1]
        back = max(p.turn_round_floor_m, p.turn_round_share * (foremost - state.hindmost))
        if state.trail[-1][1] < foremost - back:
            contact_ns = turning_point(state.trail, at) + int(p.contact_after_foremost_s * 1e9)
            contact = Contact(GaitEventKind.INITIAL_CONTACT, contact_ns, p.contact_std_s)
            return contact if contact_ns <= captured_ns else None
        if captured_ns - rotation.end_ns > p.landing_timeout_s * 1e9:
            contact_ns = rotation.end_ns + int(p.contact_after_swing_s * 1e9)
            return Contact(GaitEventKind.INITIAL_CONTACT, contact_ns, p.resting_contact_std_s)
        return None

    def _put_down(self, contact: Contact) -> Contact | None:
        state = self.state
        assert state.rotation is not None
        known = state.own_angles[-self.parameters.swing_memory + 1 :]
        after = [(ns, forward) for ns, forward in state.trail if ns >= contact.captured_ns]
        self.state = SwingState(state.last_ns, state.last_rate, own_angles=[*known, state.rotation.angle], trail=after)
        return contact if contact.captured_ns > state.toe_off_ns else None

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state)

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        rotation = state["rotation"]
        self.state = SwingState(
            last_ns=state["last_ns"],
            last_rate=state["last_rate"],
            rotation=None if rotation is None else Rotation(**rotation),
            swinging=state["swinging"],
            toe_off_ns=state["toe_off_ns"],
            hindmost=state["hindmost"],
            own_angles=list(state["own_angles"]),
            trail=[(ns, forward) for ns, forward in state["trail"]],
        )


def turning_point(trail: list[tuple[int, float]], at: int) -> int:
    """Time of the extremum near sample `at` of (ns, value) samples: vertex of the parabola through three samples.

    Exact for evenly spaced samples; never more than half a sample away from `at`.
    """
    if not 0 < at < len(trail) - 1:
        return trail[at][0]
    (first, a), (middle, b), (last, c) = trail[at - 1 : at + 2]
    bend = a - 2 * b + c
    shift = 0.0 if bend == 0 else min(0.5, max(-0.5, 0.5 * (a - c) / bend))
    return middle + round(shift * 0.5 * (last - first))
