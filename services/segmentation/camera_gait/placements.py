"""Where feet were put on the ground, also on one that moves: what steps are measured by."""

from bisect import bisect_left, bisect_right
from statistics import median

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Side
from services.flow.node import State, pack_array, unpack_array
from services.segmentation.camera_gait.direction import Floor, Walker
from services.segmentation.camera_gait.parameters import CameraGaitParameters
from services.segmentation.gait.history import Span
from services.segmentation.gait.leg_kinematics import SIDES
from services.segmentation.gait.step_length import StepLength

Array = NDArray[np.float64]

PELVIS, FORWARD = slice(0, 2), slice(6, 8)
ANKLES = (slice(2, 4), slice(4, 6))
COLUMNS = 8
KEPT_S = 7.0
"""s of places kept: the longest stride, its release and margins."""


class Placements:
    """Walkers in order of time, and how fast the ground under them moves.

    A foot that stands does not move over its ground. In the middle of each stance its ankle's speed in the room is
    therefore that of the ground: 0 on a floor, minus the walking speed on a treadmill. A step is the distance between
    the places of both feet on the ground, each averaged after its contact, when the ankle stays: so neither the time of
    contact nor a person who drifts on the belt matters.
    """

    def __init__(self, parameters: CameraGaitParameters) -> None:
        self._parameters = parameters
        self._captured_ns: list[int] = []
        self._rows: list[Array] = []
        self._stances: list[tuple[float, float]] = []  # m/s forward: of the ground in the room, of the pelvis over it

    def append(self, captured_ns: int, walker: Walker, forward: Floor) -> None:
        """Add the newest sample with the unit vector of the walking direction."""
        left, right = walker.ankles
        self._captured_ns.append(captured_ns)
        self._rows.append(np.array([*walker.pelvis, *left, *right, *forward]))
        if captured_ns - self._captured_ns[0] > (KEPT_S + 1.0) * 1e9:
            old = bisect_left(self._captured_ns, captured_ns - round(KEPT_S * 1e9))
            del self._captured_ns[:old], self._rows[:old]

    def stood(self, side: Side, contact_ns: int, toe_off_ns: int) -> None:
        """A foot stood from its contact to its toe-off: what the ground did meanwhile."""
        p, stance_ns = self._parameters, toe_off_ns - contact_ns
        ns, rows = self._between(contact_ns + round(p.flat_from * stance_ns), contact_ns + round(p.flat_to * stance_ns))
        if len(ns) < p.least_flat_samples:
            return
        ways = rows[:, [*range(8)[ANKLES[SIDES.index(side)]], *range(8)[PELVIS]]].reshape(-1, 2, 2)
        forward = rows[:, FORWARD].mean(axis=0)
        time_s = (ns - ns[0]) / 1e9
        ankle, pelvis = np.polyfit(time_s, ways @ forward / np.linalg.norm(forward), 1)[0]
        self._stances = [*self._stances, (float(ankle), float(pelvis - ankle))][-p.belt_memory :]

    @property
    def ground_speed(self) -> float | None:
        """m/s forward in the room: 0 of a floor, negative of a treadmill; None before the first stance."""
        if not self._stances:
            return None
        ground, over_it = (median(column) for column in zip(*self._stances, strict=True))
        return ground if -ground > self._parameters.belt_share * over_it else 0.0

    def step(self, leading: Side, contact_ns: int, trailing_ns: int, _span: Span) -> StepLength | None:
        """How far forward the leading foot was put from the other one; None where either was not seen."""
        p, ground = self._parameters, self.ground_speed
        now, then = self._placed(leading, contact_ns), self._placed(leading.other, trailing_ns)
        if ground is None or now is None or then is None:
            return None
        (now_s, put), (then_s, other), forward = now[:2], then[:2], now[2] + then[2]
        along = float((put - other) @ forward / np.linalg.norm(forward))
        apart_s = now_s - then_s
        belt_std = 0.0 if ground == 0.0 else self._belt_std() * apart_s
        return StepLength(along - ground * apart_s, float(np.hypot(np.sqrt(2.0) * p.placement_std_m, belt_std)))

    def width(self, leading: Side, contact_ns: int, trailing_ns: int) -> float | None:
        """m, how far apart sideways both feet were put, negative where they crossed; None where one was not seen."""
        now, then = self._placed(leading, contact_ns), self._placed(leading.other, trailing_ns)
        if now is None or then is None:
            return None
        forward = now[2] + then[2]
        # Forward is up cross right, so right is (-z, x) of it; a belt does not move sideways.
        to_the_right = np.array([-forward[1], forward[0]]) / np.linalg.norm(forward)
        across = float((now[1] - then[1]) @ to_the_right)
        return across if leading is Side.RIGHT else -across

    def _placed(self, side: Side, contact_ns: int) -> tuple[float, Array, Array] | None:
        """Mean time, s, place (2,) m and walking direction (2,) of a foot after its contact."""
        p = self._parameters
        ns, rows = self._between(contact_ns + round(p.placed_from_s * 1e9), contact_ns + round(p.placed_to_s * 1e9))
        if len(ns) < p.least_placed_samples:
            return None
        mean = rows.mean(axis=0)
        return float(ns.mean()) / 1e9, mean[ANKLES[SIDES.index(side)]], mean[FORWARD]

    def _belt_std(self) -> float:
        """m/s, one standard deviation of the belt's speed: that of a mean of the stances."""
        speeds = [ground for ground, _ in self._stances]
        return float(np.std(speeds) / np.sqrt(len(speeds)))

    def _between(self, from_ns: int, to_ns: int) -> tuple[NDArray[np.int64], Array]:
        first, last = bisect_left(self._captured_ns, from_ns), bisect_right(self._captured_ns, to_ns)
        rows = np.array(self._rows[first:last]).reshape(-1, COLUMNS)
        return np.array(self._captured_ns[first:last], dtype=np.int64), rows

    def snapshot(self) -> State:
        """Times, places and stances."""
        return {
            "captured_ns": list(self._captured_ns),
            "rows": pack_array(np.array(self._rows).reshape(-1, COLUMNS)),
            "stances": [list(stance) for stance in self._stances],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._captured_ns = list(state["captured_ns"])
        self._rows = list(unpack_array(state["rows"]))
        self._stances = [(ground, over_it) for ground, over_it in state["stances"]]
