"""The constrained filter as printed (Colombel eq. 1-5): a baseline, to be scored, not to be shown.

What cannot be right is kept: the violation is that of the predicted state, angles and lengths weigh alike, and the
covariance is (I - K_R H) P, which for this gain is neither symmetric nor positive. The state is [q, dq, ddq, L] in
meaning; three translations of the base join the 22 angles. P0 = I and the start is one fitted frame, as in section 3.4.
"""

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.constrained_ekf import bounds_of
from services.biomech.whole_body.kernels.tables import BOUNDED, COORDINATES, FIRST_BOUNDED, SEEN
from services.biomech.whole_body.model import MODEL, WholeBodyModel
from services.biomech.whole_body.parameters import ProcessNoise
from services.biomech.whole_body.presets import PUBLISHED_VARIANCE
from services.biomech.whole_body.start import Start
from services.biomech.whole_body.textbook import measurement, process_noise, transition
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]


class ColombelCekf:
    """The printed filter of one person."""

    def __init__(
        self,
        start: Start,
        process: ProcessNoise,
        variance: float = PUBLISHED_VARIANCE,
        model: WholeBodyModel = MODEL,
    ) -> None:
        self.start, self.model, self.process, self.variance = start, model, process, variance
        n = SEEN + 2 * COORDINATES
        self.x, self.P = np.zeros(n), np.eye(n)
        self.x[:SEEN] = np.concatenate([start.q, start.lengths])
        self._low, self._high = bounds_of(start, constrained=True)

    def advance(self, dt_s: float, centres: Array, state: NDArray[np.int64]) -> None:
        """Predict over dt_s and fuse centres (15, 3) m; without a complete frame it only predicts."""
        n = len(self.x)
        F = transition(n, dt_s)
        self.x = F @ self.x
        self.P = F @ self.P @ F.T + process_noise(n, dt_s, self.process.densities(), held=self.process.held)
        if (state > 0).all() and np.isfinite(centres).all():
            self._update(centres)

    def _update(self, centres: Array) -> None:
        expected, H = measurement(self.model, self.x)
        v = centres.ravel() - expected
        S = H @ self.P @ H.T + self.variance * np.eye(len(v))
        try:
            gain, weighted = np.linalg.solve(S.T, H @ self.P.T).T, np.linalg.solve(S, v)
        except np.linalg.LinAlgError:
            # An S without inverse is where the printed filter ends.
            self.x, self.P = np.full_like(self.x, np.nan), np.full_like(self.P, np.nan)
            return
        # C' (C C')^-1 (C x - d) of the violated rows is the violation itself, in the place of its state.
        violation = np.zeros(len(self.x))
        bounded = slice(FIRST_BOUNDED, FIRST_BOUNDED + BOUNDED)
        value = self.x[bounded]
        violation[bounded] = np.maximum(value - self._high, 0.0) - np.maximum(self._low - value, 0.0)
        gain = gain - np.outer(violation, weighted) / (v @ weighted)
        self.x = self.x + gain @ v
        self.P = (np.eye(len(self.x)) - gain @ H) @ self.P

    @property
    def angles(self) -> Array:
        """(22,) rad, in the order of WHOLE_BODY."""
        return self.x[3:COORDINATES]

    @property
    def lengths(self) -> Array:
        """(12,) m."""
        return self.x[COORDINATES:SEEN]

    def snapshot(self) -> State:
        """Everything that changes, and the start, as JSON values; what is not finite stays so."""
        return {"start": self.start.packed(), "x": pack_array(self.x), "P": pack_array(self.P)}

    def restore(self, state: State) -> None:
        """Go on from a snapshot of a filter with the same start, to the last bit.

        Raises:
            ValueError: the snapshot is from another start.
        """
        if state["start"] != self.start.packed():
            raise ValueError("whole-body snapshot is from another start than this filter's")
        self.x, self.P = unpack_array(state["x"]), unpack_array(state["P"])

    @classmethod
    def resumed(
        cls, state: State, process: ProcessNoise, variance: float = PUBLISHED_VARIANCE, model: WholeBodyModel = MODEL
    ) -> "ColombelCekf":
        """The filter that a snapshot was taken of, given the same noise."""
        ekf = cls(Start.unpacked(state["start"]), process, variance, model)
        ekf.restore(state)
        return ekf
