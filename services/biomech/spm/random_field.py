"""How high a smooth random t curve rises by chance: Gaussian random field theory in one dimension.

Sources: [W] Worsley et al. 1996, Human Brain Mapping 4, 58-73; [F] Friston et al. 1994, Human Brain Mapping 1,
210-220; [K] Kiebel et al. 1999, NeuroImage 10, 756-766.
"""

from dataclasses import dataclass
from math import exp, expm1, gamma, isfinite, log, pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import stdtr, stdtrit

Array = NDArray[np.float64]

HIGHEST = 1e4
"""t beyond which no threshold is looked for."""


def full_width_half_maximum(residuals: Array) -> float:
    """Smoothness of curves in nodes, from residuals (n curves, m nodes) about their mean [K].

    FWHM = 1 / mean(sqrt(v / (4 ln 2))) with v the variance of the residuals' slope over that of the residuals.

    Raises:
        ValueError: fewer than two nodes, or a node at which all curves agree.
    """
    if residuals.ndim != 2 or residuals.shape[1] < 2:
        raise ValueError(f"smoothness needs curves of at least two nodes, not an array of shape {residuals.shape}")
    squares = np.square(residuals).sum(axis=0)
    if not (squares > 0.0).all():
        raise ValueError(f"all curves agree at node {int(np.argmin(squares))}: there is nothing to test them against")
    slope = np.square(np.gradient(residuals, axis=1)).sum(axis=0) / squares
    resels_per_node = float(np.sqrt(slope / (4.0 * log(2.0))).mean())
    return 1.0 / max(resels_per_node, 1e-12)


@dataclass(frozen=True)
class TField:
    """A t curve with nu degrees of freedom over `nodes` samples of smoothness `fwhm` nodes, if nothing differs."""

    nu: float
    nodes: int
    fwhm: float

    @property
    def resels(self) -> float:
        """Length in units of the smoothness."""
        return (self.nodes - 1) / self.fwhm

    def beyond(self, height: float) -> float:
        """P(t > height) at one node."""
        return float(stdtr(self.nu, -height))

    def excursions(self, height: float) -> float:
        """Expected Euler characteristic of where the curve exceeds a height: sum of resels times density [W].

        rho_0 = P(t > u), rho_1 = sqrt(4 ln 2) / (2 pi) (1 + u^2 / nu)^(-(nu - 1) / 2).
        """
        return self.beyond(height) + self.resels * self._density(height)

    def _density(self, height: float) -> float:
        tail: float = (1.0 + height**2 / self.nu) ** (-(self.nu - 1.0) / 2.0)
        return sqrt(4.0 * log(2.0)) / (2.0 * pi) * tail

    def exceeds(self, height: float) -> float:
        """P(the highest point of the curve exceeds a height > 0): excursions are Poisson, or every node for itself."""
        return min(-expm1(-self.excursions(height)), 1.0, self.nodes * self.beyond(height))

    def threshold(self, alpha: float) -> float:
        """Height that the curve exceeds anywhere with probability alpha.

        Raises:
            ValueError: alpha is not between 0 and 0.5, or the field has no degree of freedom or no smoothness.
        """
        if not 0.0 < alpha < 0.5:
            raise ValueError(f"alpha is a probability between 0 and 0.5, not {alpha}")
        if self.nu < 1.0 or self.nodes < 2 or not (isfinite(self.fwhm) and self.fwhm > 0.0):
            raise ValueError(f"{self} is no field: it needs nu >= 1, at least two nodes and a smoothness")
        node_by_node = float(-stdtrit(self.nu, alpha / self.nodes))
        if self.exceeds(HIGHEST) > alpha:
            return node_by_node
        lowest = float(-stdtrit(self.nu, min(2.0 * alpha, 0.5)))
        field = float(brentq(lambda u: -expm1(-self.excursions(u)) - alpha, lowest, HIGHEST, xtol=1e-10))
        return min(field, node_by_node)

    def cluster_at_least(self, extent: float, height: float) -> float:
        """P(some stretch above a height is at least so long), extent in nodes [F].

        The number of stretches is Poisson with the expected Euler characteristic; their length has
        P(length >= k) = exp(-(Gamma(3/2) k / E[length])^2) and E[length] = P(t > u) / rho_1 resels, as inside a curve.
        """
        expected = self.excursions(height)
        mean_length = self.beyond(height) / self._density(height)
        longer = exp(-((gamma(1.5) * extent / self.fwhm / mean_length) ** 2))
        return -expm1(-expected * longer)
