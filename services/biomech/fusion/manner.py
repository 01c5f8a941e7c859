"""How one source's angle follows from terms of the other's, learned while both are there: recursive least squares."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

START_RESIDUAL = 1.5
"""Of the source's noise: what is left before anything is known."""


class Manner:
    """q = c . terms for each of n angles, independently of each other."""

    def __init__(self, mean: Array, spread: Array, noise: Array, memory_s: float, residual_memory_s: float) -> None:
        """`mean` and `spread` (n, k) of the coefficients before any comparison; `noise` (n,) rad of the source."""
        self._memory_s, self._residual_memory_s = memory_s, residual_memory_s
        self.coefficients = mean.copy()
        self._start_P = spread[:, :, None] ** 2 * np.eye(mean.shape[1])
        self._P = self._start_P.copy()
        self._residual = (START_RESIDUAL * noise) ** 2

    def learn(self, dt_s: float, terms: Array, q: Array, variance: Array, use: Flags) -> None:
        """Compare q (n,) with its terms (n, k), where `use`; `variance` (n,) of one such comparison."""
        self._P += self._start_P * (2.0 * dt_s / self._memory_s) ** 2
        Ph = np.einsum("nij,nj->ni", self._P, terms)
        share = np.where(use, 1.0, 0.0)[:, None]
        gain = share * Ph / (np.einsum("ni,ni->n", Ph, terms) + variance)[:, None]
        missed = np.where(use, wrapped(q - self.value(terms)), 0.0)
        self.coefficients += gain * missed[:, None]
        self._P -= gain[:, :, None] * Ph[:, None, :]
        newer = np.where(use, min(1.0, dt_s / self._residual_memory_s), 0.0)
        self._residual += newer * (missed**2 - self._residual)

    def value(self, terms: Array) -> Array:
        """(n,) rad."""
        return np.asarray(np.einsum("ni,ni->n", self.coefficients, terms))

    def variance(self, terms: Array) -> Array:
        """(n,) rad^2 of `value`: of the coefficients, and of what they leave."""
        return np.asarray(np.einsum("ni,nij,nj->n", terms, self._P, terms) + self._residual)

    def snapshot(self) -> dict[str, Array]:
        """Everything that changes."""
        return {"coefficients": self.coefficients, "P": self._P, "residual": self._residual}

    def restore(self, state: dict[str, Array]) -> None:
        """Inverse of `snapshot`."""
        self.coefficients, self._P, self._residual = state["coefficients"], state["P"], state["residual"]


def wrapped(angle: Array) -> Array:
    """The same angles in [-pi, pi): a heading may be whole turns apart."""
    return np.asarray(np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi)
