"""What one stride tells: times in s, shares of the stride, lengths in m, angles in rad. None where it does not."""

from collections.abc import Callable
from operator import attrgetter

from schemas.gait import Stride
from services.definitions.definition import Measure

Curve = list[float]


def field(name: str) -> Measure:
    """What the stride carries itself."""
    return attrgetter(name)


def steps_per_minute(stride: Stride) -> float | None:
    """Two steps in each stride."""
    return 120.0 / stride.stride_time_s


def swing_fraction(stride: Stride) -> float | None:
    """What is not stance."""
    return None if stride.stance_fraction is None else 1.0 - stride.stance_fraction


def initial_double_support(stride: Stride) -> float | None:
    """Share of the stride from this foot's contact to the other one's toe-off."""
    if stride.opposite_toe_off_ns is None or stride.opposite_contact_ns is None:
        return None
    if stride.opposite_toe_off_ns > stride.opposite_contact_ns:
        return None  # the other foot's toe-off after its next contact is that of the stride after
    return (stride.opposite_toe_off_ns - stride.start_ns) / (stride.end_ns - stride.start_ns)


def terminal_double_support(stride: Stride) -> float | None:
    """Share of the stride from the other foot's contact to this one's toe-off; below zero where a person runs."""
    if stride.opposite_contact_ns is None or stride.toe_off_ns is None:
        return None
    return (stride.toe_off_ns - stride.opposite_contact_ns) / (stride.end_ns - stride.start_ns)


def double_support(stride: Stride) -> float | None:
    """Share of the stride in which both feet are on the ground."""
    initial, terminal = initial_double_support(stride), terminal_double_support(stride)
    return None if initial is None or terminal is None else initial + terminal


def single_support(stride: Stride) -> float | None:
    """Share of the stride from the other foot's toe-off to its contact."""
    initial = initial_double_support(stride)
    if initial is None or stride.opposite_contact_ns is None:
        return None
    return (stride.opposite_contact_ns - stride.start_ns) / (stride.end_ns - stride.start_ns) - initial


def in_seconds(share: Measure) -> Measure:
    """A share of the stride as time."""

    def measure(stride: Stride) -> float | None:
        value = share(stride)
        return None if value is None else value * stride.stride_time_s

    return measure


def of_curve(joint: str, take: Callable[[Curve], float]) -> Measure:
    """A number of the whole curve of a joint of the stride's own leg, or of the pelvis."""

    def measure(stride: Stride) -> float | None:
        curve = _curve(stride, joint)
        return None if curve is None else take(curve)

    return measure


def in_swing(joint: str, take: Callable[[Curve], float]) -> Measure:
    """A number of the curve from toe-off to the end of the stride."""

    def measure(stride: Stride) -> float | None:
        curve = _curve(stride, joint)
        if curve is None or stride.stance_fraction is None:
            return None
        return take(curve[round(100 * stride.stance_fraction) :])

    return measure


def in_stance(joint: str, take: Callable[[Curve], float]) -> Measure:
    """A number of the curve from contact to toe-off."""

    def measure(stride: Stride) -> float | None:
        curve = _curve(stride, joint)
        if curve is None or stride.stance_fraction is None:
            return None
        return take(curve[: round(100 * stride.stance_fraction) + 1])

    return measure


def extent(curve: Curve) -> float:
    """Largest minus smallest."""
    return max(curve) - min(curve)


def mean(curve: Curve) -> float:
    """Over the curve's samples, which are evenly spaced."""
    return sum(curve) / len(curve)


def depth(curve: Curve) -> float:
    """The negative of the smallest: how far to the other direction."""
    return -min(curve)


def at_contact(curve: Curve) -> float:
    """The first sample."""
    return curve[0]


def _curve(stride: Stride, joint: str) -> Curve | None:
    curve = stride.curves.get(joint) or stride.curves.get(f"{joint}_{stride.side}")
    return None if curve is None else curve.position
