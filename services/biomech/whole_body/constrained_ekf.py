"""Constrained extended Kalman filter of the whole body on the joint centres of a depth camera (Colombel eq. 1-5).

Ours differs from the printed one where that cannot be right: the updated estimate is brought within bounds, not the
predicted one; in the metric of the covariance; and the covariance stays that of the optimal gain (Joseph's form), so
it remains symmetric and positive definite. `colombel.py` holds the printed form.
"""

from dataclasses import dataclass, field
from math import radians

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.kernels.frame import advance
from services.biomech.whole_body.kernels.tables import (
    BELIEF,
    BIASES,
    CENTRES,
    COORDINATES,
    FIRST_BOUNDED,
    SEEN,
    WORK,
    Bounds,
    Table,
    aligned,
    covariance_room,
    full_covariance,
    table,
)
from services.biomech.whole_body.model import MODEL, WholeBodyModel
from services.biomech.whole_body.parameters import (
    LENGTH_RANGE,
    LIMITS_DEG,
    NOMINAL_DT_S,
    REST_DEG,
    CameraNoise,
    ProcessNoise,
    SoftPriors,
    per_angle,
)
from services.biomech.whole_body.start import Start
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]

LONE_LIMIT = 1e6
"""A bound that nothing reaches."""


@dataclass(frozen=True)
class FilterSettings:
    """What the filter believes of camera, movement and person."""

    camera: CameraNoise = field(default_factory=CameraNoise)
    process: ProcessNoise = field(default_factory=ProcessNoise)
    priors: SoftPriors = field(default_factory=SoftPriors)
    constrained: bool = True
    margin: float = radians(10.0)
    """rad. What is carried on may exceed the limits of angles by this much; what is told never does. An offset of the
    camera holds a straight knee beyond its limit for long: to clip it at every frame would read that into the biases
    and the other angles. Lengths have no margin. [K]"""
    lengths_learnt_s: float = 5.0
    """s in view after which lengths are held. What still moves them then is the camera's systematic error, which more
    frames do not average out."""
    biases_learnt_s: float = 8.0
    """The same for the biases: what moves them then is mostly what the filter makes of quick movement. [K]"""


HELD = 1e-3
"""What is left of the deviation of a length that is held."""
SLOWED = 0.1
"""The same for biases. They go on being learnt, slowly: a start from a poor second is mended by and by."""

OURS = FilterSettings()


class WholeBodyEkf:
    """The filter of one person in view. `x`, `P` and `in_view_s` are its whole state.

    `estimate` (n,) is x within the limits: what is told.

    x (n,): 25 coordinates q, 12 lengths, 45 biases if the start has any, 25 velocities, 25 accelerations.
    """

    def __init__(self, start: Start, settings: FilterSettings = OURS, model: WholeBodyModel = MODEL) -> None:
        self.settings, self.model, self.start = settings, model, start
        self.biased = start.bias_std is not None
        self.velocity = SEEN + (BIASES if self.biased else 0)
        n = self.velocity + 2 * COORDINATES
        self._derivatives = (0, self.velocity, self.velocity + COORDINATES)
        self.x, self._kept = aligned(n), covariance_room(n)
        self.x[:SEEN] = np.concatenate([start.q, start.lengths])
        self._start_covariance()
        self.estimate = self.x.copy()
        self._belief, self._work = beliefs_of(start, settings), table(WORK)
        self._centres, self._state = np.zeros((CENTRES, 3)), np.zeros(CENTRES, dtype=np.int64)
        self.in_view_s = 0.0
        self.active = 0
        self.swapped = False

    @property
    def P(self) -> Array:
        """(n, n) covariance, a copy."""
        return full_covariance(self._kept)

    @P.setter
    def P(self, covariance: Array) -> None:
        self._kept[:, : len(self.x)] = covariance

    def _start_covariance(self) -> None:
        start = self.start
        velocity, acceleration = start.noise.rate_variances()
        diagonal = np.zeros(len(self.x))
        diagonal[:COORDINATES] = start.q_std**2
        if start.bias_std is not None:
            diagonal[SEEN : self.velocity] = np.tile(np.square(start.bias_std), CENTRES)
        diagonal[self.velocity : self.velocity + COORDINATES] = velocity
        diagonal[self.velocity + COORDINATES :] = acceleration
        self.P = np.diag(diagonal)
        self._kept[COORDINATES:SEEN, COORDINATES:SEEN] = start.length_covariance

    def advance(self, dt_s: float, centres: Array, state: NDArray[np.int64]) -> None:
        """Predict over dt_s >= 0 and fuse one frame.

        centres (15, 3) m in world axes, in the order of JointCentre; state (15,) 0 not tracked, 1 inferred, 2 tracked.
        A centre that is not tracked or not finite has no row. Without any centre it only predicts.
        """
        self._centres[:], self._state[:] = centres, state
        share = NOMINAL_DT_S / max(dt_s, 1e-3)
        count, self.swapped, self.active = advance(
            self.x, self._kept, self.estimate, self.velocity, dt_s, share, self._centres, self._state,
            self.model.body, self._belief, self._work,
        )  # fmt: skip
        self._learn_constants(dt_s if count else 0.0)

    def _learn_constants(self, dt_s: float) -> None:
        before, self.in_view_s = self.in_view_s, self.in_view_s + dt_s
        if before < self.settings.lengths_learnt_s <= self.in_view_s:
            self._hold(slice(COORDINATES, SEEN), HELD)
        if self.biased and before < self.settings.biases_learnt_s <= self.in_view_s:
            self._hold(slice(SEEN, self.velocity), SLOWED)

    def _hold(self, states: slice, share: float) -> None:
        # D P D with D diagonal stays positive definite.
        self.x[states] = self.estimate[states]
        self._kept[states] *= share
        self._kept[:, states] *= share

    @property
    def q(self) -> Array:
        """(25,) translations of spine_base, m, and the angles, rad."""
        return self.estimate[:COORDINATES]

    @property
    def angles(self) -> Array:
        """(22,) rad, in the order of WHOLE_BODY."""
        return self.estimate[3:COORDINATES]

    def angles_before(self, lag_s: float) -> Array:
        """(22,) rad, what the angles were lag_s before the last frame, in the light of all frames since.

        The estimate run backwards with constant acceleration: what a smoother of that lag would tell if nothing drove
        the movement within it. Good for 0.1 to 0.2 s; a live picture wants none.
        """
        q, v, a = (self.estimate[first + 3 : first + COORDINATES] for first in self._derivatives)
        belief, angles = self._belief[0], COORDINATES - FIRST_BOUNDED
        return np.clip(q - lag_s * v + lag_s**2 / 2.0 * a, belief["low"][:angles], belief["high"][:angles])

    @property
    def lengths(self) -> Array:
        """(12,) m."""
        return self.estimate[COORDINATES:SEEN]

    @property
    def rates(self) -> Array:
        """(22,) rad/s."""
        return self.estimate[self.velocity + 3 : self.velocity + COORDINATES]

    def deviations(self) -> Array:
        """(2, 22) standard deviations of the angles, rad, and their rates, rad/s."""
        variance = np.diagonal(self._kept)
        first = self.velocity + 3
        return np.sqrt(np.stack([variance[3:COORDINATES], variance[first : first + COORDINATES - 3]]))

    def distances(self) -> Array:
        """(15,) squared innovation of each centre of the last frame in variances, 3 expected; 0 without a row."""
        work, distances = self._work[0], np.zeros(CENTRES)
        used = work["used"][: work["in_use"]]
        distances[used] = work["distance"][used]
        return distances

    def evidence(self) -> tuple[int, float, float]:
        """Of the last frame's centres: how many rows, their squared innovations in variances, log det of S."""
        work = self._work[0]
        return 3 * int(work["in_use"]), float(work["squares"]), float(work["log_determinant"])

    def settle(self) -> None:
        """After a time without frames: keep posture, lengths and biases, forget how it moved and how sure it was."""
        self.x[self.velocity :] = 0.0
        self.estimate[self.velocity :] = 0.0
        constants = slice(COORDINATES, self.velocity)
        known = self.P[constants, constants]
        self._start_covariance()
        self._kept[constants, constants] = known

    def snapshot(self) -> State:
        """Everything that changes, and the start, as JSON values; of the symmetric P the upper triangle."""
        return {
            "start": self.start.packed(),
            "x": pack_array(self.x),
            "P": pack_array(self.P[np.triu_indices(len(self.x))]),
            "estimate": pack_array(self.estimate),
            "in_view_s": self.in_view_s,
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot of a filter with the same start and settings, to the last bit.

        What is told of the last frame alone (`active`, `swapped`, `distances`, `evidence`) comes with the next one.

        Raises:
            ValueError: the snapshot is of a filter with other states, or from another start.
        """
        x, n = unpack_array(state["x"]), len(self.x)
        if len(x) != n or state["start"] != self.start.packed():
            raise ValueError(f"whole-body snapshot of {len(x)} states and its start, this filter has {n} and its own")
        self.x[:], self.estimate[:] = x, unpack_array(state["estimate"])
        upper = np.zeros((n, n))
        upper[np.triu_indices(n)] = unpack_array(state["P"])
        self.P = full_covariance(upper)
        self.in_view_s = float(state["in_view_s"])

    @classmethod
    def resumed(cls, state: State, settings: FilterSettings = OURS, model: WholeBodyModel = MODEL) -> "WholeBodyEkf":
        """The filter that a snapshot was taken of, given the same settings."""
        ekf = cls(Start.unpacked(state["start"]), settings, model)
        ekf.restore(state)
        return ekf

    def is_sound(self) -> bool:
        """Finite throughout."""
        return bool(np.isfinite(self.x).all() and np.isfinite(self._kept).all())


def bounds_of(start: Start, *, constrained: bool) -> Bounds:
    """Limits of the 22 angles and of the 12 lengths, +-20 % of where they started."""
    low, high = per_angle(LIMITS_DEG).T
    low, high = low.copy(), high.copy()
    low[0] += start.q[3]
    high[0] += start.q[3]
    low = np.concatenate([low, (1.0 - LENGTH_RANGE) * start.lengths])
    high = np.concatenate([high, (1.0 + LENGTH_RANGE) * start.lengths])
    if not constrained:
        low, high = np.full_like(low, -LONE_LIMIT), np.full_like(high, LONE_LIMIT)
    return Bounds(low, high)


def beliefs_of(start: Start, settings: FilterSettings) -> Table:
    """(1,) BELIEF, what the kernels are told of camera, movement and person."""
    beliefs = table(BELIEF)
    belief, camera, priors = beliefs[0], settings.camera, settings.priors
    belief["variance"], belief["along"] = camera.per_centre()
    for name in ("inferred", "stretch", "gate", "swap_scale", "swap_most", "swap_share"):
        belief[name] = getattr(camera, name)
    belief["density"], belief["held"] = settings.process.densities(), float(settings.process.held)
    columns = priors.columns()
    belief["priors"] = len(columns)
    belief["prior_column"][: len(columns)] = columns
    belief["prior_value"][: len(columns)] = per_angle(REST_DEG)[columns - FIRST_BOUNDED, 0]
    belief["prior_variance"][: len(columns)] = priors.variances()
    belief["low"], belief["high"] = bounds_of(start, constrained=settings.constrained)
    margin = np.zeros(len(belief["low"]))
    margin[: COORDINATES - FIRST_BOUNDED] = settings.margin
    belief["wide_low"], belief["wide_high"] = belief["low"] - margin, belief["high"] + margin
    return beliefs
