"""The timed part of a walkway, and when it is entered and left."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from schemas.session import SessionDescription
from services.segmentation.timed_up_and_go.turns import Boundary
from services.segmentation.walking_tests.crossings import Ruler, crossing
from services.segmentation.walking_tests.parameters import WalkingTestParameters
from services.segmentation.walking_tests.step_trail import Mark

_PLACES = (-1.8, -1.2, -0.6, 0.0, 0.6, 1.2, 1.8)
"""Standard deviations from a line at which its crossing is looked at."""
_DENSITY = tuple(math.exp(-z * z / 2) for z in _PLACES)
_WEIGHTS = tuple(density / sum(_DENSITY) for density in _DENSITY)


class LengthStart(NamedTuple):
    """Where a length begins: after standing, or half-way through a turn."""

    at_ns: int
    turned: bool


class ZoneTimes(NamedTuple):
    """When the foremost foot crosses the lines; None while it has not."""

    enters: Boundary | None
    leaves: Boundary | None
    speed_change: float | None  # m/s, of the second half against the first


@dataclass(frozen=True)
class Zone:
    """From one line to another, m from the start."""

    from_m: float
    to_m: float
    walkway_m: float | None
    parameters: WalkingTestParameters

    @classmethod
    def of(cls, description: SessionDescription, parameters: WalkingTestParameters) -> "Zone":
        """As somebody said; else the middle of 10 m."""
        said, usual = description.conditions, parameters.default_zone_m
        from_m = usual[0] if said.timed_from_m is None else said.timed_from_m
        to_m = usual[1] if said.timed_to_m is None else said.timed_to_m
        return cls(from_m, max(to_m, from_m + 0.1), description.walkway_m, parameters)

    def scale(self, total_m: float) -> float | None:
        """What makes the steps of a length as long as the declared walkway; None where that is not what was walked."""
        if self.walkway_m is None or total_m <= 0:
            return None
        scale = self.walkway_m / total_m
        return scale if abs(scale - 1) <= self.parameters.most_scaling else None

    def ends_at(self, total_m: float, *, scaled: bool) -> bool:
        """Whether somebody who stops after so many metres without having crossed the last line stops at it."""
        p = self.parameters
        unsure_m = 0.0 if scaled else 2 * p.length_std_share * self.to_m
        return abs(total_m - self.to_m) <= p.reached_m + unsure_m

    def times(self, marks: Sequence[Mark], ruler: Ruler, start: LengthStart, *, scaled: bool) -> ZoneTimes:
        """Of a length. `scaled`: between the ends of a known walkway."""
        enters, middle, leaves = (
            self._crossed(marks, ruler, start, line_m, self.line_std_m(line_m, scaled=scaled, turned=start.turned))
            for line_m in (self.from_m, (self.from_m + self.to_m) / 2, self.to_m)
        )
        change = None
        if enters and middle and leaves and enters.at_ns < middle.at_ns < leaves.at_ns:
            half_m = (self.to_m - self.from_m) / 2
            first_s, second_s = (middle.at_ns - enters.at_ns) * 1e-9, (leaves.at_ns - middle.at_ns) * 1e-9
            change = half_m / second_s - half_m / first_s
        return ZoneTimes(enters, leaves, change)

    def line_std_m(self, line_m: float, *, scaled: bool, turned: bool) -> float:
        """m, deviation of where a line lies among the steps."""
        p = self.parameters
        place_m = p.turned_line_std_m if turned else p.line_std_m
        return place_m if scaled else math.hypot(p.unsure_line_std_m, place_m, p.length_std_share * line_m)

    def _crossed(
        self, marks: Sequence[Mark], ruler: Ruler, start: LengthStart, line_m: float, line_std_m: float
    ) -> Boundary | None:
        """Mean and deviation of the crossing over where the line may lie.

        The foremost foot stands for most of a step: a centimetre decides whether it or the next one crosses, and a
        third of a second with it. So the crossing is taken at seven places, weighted as a normal distribution.
        """
        p = self.parameters
        if line_m <= 0:
            return Boundary(start.at_ns, p.start_std_s)
        places = [crossing(marks, ruler, line_m + z * line_std_m, start.at_ns) for z in _PLACES]
        found = [place for place in places if place is not None]
        if len(found) < len(_PLACES):
            return None
        first_ns = found[0].at_ns
        after_s = [(place.at_ns - first_ns) * 1e-9 for place in found]
        mean_s = sum(w * at_s for w, at_s in zip(_WEIGHTS, after_s, strict=True))
        variance = sum(w * (at_s - mean_s) ** 2 for w, at_s in zip(_WEIGHTS, after_s, strict=True))
        std_s = math.hypot(math.sqrt(variance), found[3].contact_std_s, p.crossing_std_s)
        return Boundary(first_ns + round(mean_s * 1e9), std_s)
