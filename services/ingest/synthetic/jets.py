"""A quantity over time with its first and second time derivative, so that kinematics stay exact to the last bit."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

Curve = Callable[[Array], tuple[Array, Array, Array]]
"""Value, first and second derivative of a function at n arguments."""


@dataclass(frozen=True, slots=True)
class Jet:
    """n instants of x(t), dx/dt and d2x/dt2, in x's unit per s and s^2."""

    value: Array
    rate: Array
    acceleration: Array

    @classmethod
    def constant(cls, value: float, like: Array) -> "Jet":
        """The same value at every instant of `like`."""
        return cls(np.full_like(like, value), np.zeros_like(like), np.zeros_like(like))

    def __add__(self, other: "Jet") -> "Jet":
        return Jet(self.value + other.value, self.rate + other.rate, self.acceleration + other.acceleration)

    def __mul__(self, other: "Jet") -> "Jet":
        """Leibniz: (ab)'' = a''b + 2a'b' + ab''."""
        return Jet(
            self.value * other.value,
            self.rate * other.value + self.value * other.rate,
            self.acceleration * other.value + 2 * self.rate * other.rate + self.value * other.acceleration,
        )

    def scaled(self, factor: float) -> "Jet":
        """Times a constant."""
        return Jet(factor * self.value, factor * self.rate, factor * self.acceleration)

    def shifted(self, offset: float) -> "Jet":
        """Plus a constant."""
        return Jet(self.value + offset, self.rate, self.acceleration)

    def through(self, curve: Curve) -> "Jet":
        """f(x(t)) by the chain rule: f'' x'^2 + f' x''."""
        f, df, ddf = curve(self.value)
        return Jet(f, df * self.rate, ddf * self.rate**2 + df * self.acceleration)


def smooth_step(start: float, end: float) -> Curve:
    """0 before `start`, 1 after `end`, in between the seventh-order polynomial whose first three derivatives vanish
    at both ends."""

    def curve(x: Array) -> tuple[Array, Array, Array]:
        width = end - start
        u = np.clip((x - start) / width, 0.0, 1.0)
        value = u**4 * (35 + u * (-84 + u * (70 - 20 * u)))
        first = 140 * u**3 * (1 - u) ** 3
        second = 420 * u**2 * (1 - u) ** 2 * (1 - 2 * u)
        return value, first / width, second / width**2

    return curve


def sum_of(curves: list[tuple[float, Curve]]) -> Curve:
    """Weighted sum of curves."""

    def curve(x: Array) -> tuple[Array, Array, Array]:
        parts = [(weight, part(x)) for weight, part in curves]
        value, first, second = (sum((w * part[i] for w, part in parts), np.zeros_like(x)) for i in range(3))
        return value, first, second

    return curve
