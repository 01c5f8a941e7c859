"""Where within a swing the foot crosses a line on the floor."""

from collections.abc import Sequence
from typing import NamedTuple

from services.segmentation.walking_tests.step_trail import Mark


class Crossing(NamedTuple):
    """When the foremost foot passes a line."""

    at_ns: int
    contact_std_s: float


class Ruler(NamedTuple):
    """Distances from where a length of a walkway begins: scale x (walked - zero)."""

    zero_m: float
    scale: float

    def at(self, mark: Mark) -> float:
        """m from the start."""
        return self.scale * (mark.walked_m - self.zero_m)


def crossing(marks: Sequence[Mark], ruler: Ruler, line_m: float, start_ns: int) -> Crossing | None:
    """The swing that carries a foot beyond a line; None while none has.

    A foot swings from its own last place, two steps back, to its next. It starts and lands gently: with u the share of
    the swing's time it has covered s(u) = 10 u^3 - 15 u^4 + 6 u^5 of the way (the smoothest one, Flash and Hogan 1985).
    """
    for i, mark in enumerate(marks):
        if mark.at_ns <= start_ns or ruler.at(mark) < line_m:
            continue
        lands_m, left_m = ruler.at(mark), 0.0 if i < 2 else max(0.0, ruler.at(marks[i - 2]))
        lifted_ns, way_m = max(start_ns, mark.lifted_ns), lands_m - left_m
        part = _when(min(1.0, max(0.0, (line_m - left_m) / way_m))) if way_m > 0 else 1.0
        return Crossing(lifted_ns + round(part * (mark.at_ns - lifted_ns)), mark.std_s)
    return None


def _when(share: float) -> float:
    """u at which s(u) is a share, by bisection: s rises from 0 to 1."""
    low, high = 0.0, 1.0
    for _ in range(30):
        u = (low + high) / 2
        if u**3 * (10 + u * (-15 + 6 * u)) < share:
            low = u
        else:
            high = u
    return (low + high) / 2
