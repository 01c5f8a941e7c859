"""Paired comparison of two methods along a movement: t at every node, where it exceeds chance, and by how much.

SPM{t} of Friston et al. for curves, as Pataky (2012, J. Biomech. 45) brought it to biomechanics.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.spm.random_field import TField, full_width_half_maximum

Array = NDArray[np.float64]

NODES = 101
"""0 to 100 % of a movement."""
FEWEST = 3
"""Pairs below which a t curve says nothing."""


class Cluster(NamedTuple):
    """A stretch in which the curve exceeds its threshold."""

    first: float  # node, between samples where it crosses
    last: float
    positive: bool  # the first method has more
    p: float

    @property
    def extent(self) -> float:
        """Nodes."""
        return self.last - self.first


class Comparison(NamedTuple):
    """SPM{t} of first minus second."""

    t: Array  # (m,)
    threshold: float  # t*, exceeded anywhere with probability alpha
    clusters: list[Cluster]
    field: TField
    two_tailed: bool

    def share(self, *, positive: bool) -> float:
        """Share of the movement, 0 to 1, in clusters of that sign."""
        return float(sum(c.extent for c in self.clusters if c.positive is positive)) / (len(self.t) - 1)


def t_curve(difference: Array) -> Array:
    """(m,) mean over its standard error of paired differences (n, m).

    Raises:
        ValueError: fewer than three pairs, not finite, or a node at which all pairs differ by the same.
    """
    n = len(difference)
    if difference.ndim != 2 or n < FEWEST or difference.shape[1] < 2:
        raise ValueError(f"a paired comparison needs (pairs >= {FEWEST}, nodes >= 2), not shape {difference.shape}")
    if not np.isfinite(difference).all():
        raise ValueError("curves to compare must be finite")
    deviation = difference.std(axis=0, ddof=1)
    if not (deviation > 0.0).all():
        raise ValueError(f"all pairs differ by the same at node {int(np.argmin(deviation))}: nothing to test against")
    return np.asarray(difference.mean(axis=0) / (deviation / np.sqrt(n)))


def compare(first: Array, second: Array, alpha: float = 0.05, *, two_tailed: bool = True) -> Comparison:
    """Where curves `first` (n, m) differ from `second` (n, m), one row per person.

    Two-tailed: each sign has half of alpha, and p counts both signs. Raises ValueError as `t_curve` does.
    """
    if first.shape != second.shape:
        raise ValueError(f"pairs need equal shapes, not {first.shape} and {second.shape}")
    difference = first - second
    t = t_curve(difference)
    field = TField(len(difference) - 1.0, len(t), full_width_half_maximum(difference - difference.mean(axis=0)))
    tails = 2 if two_tailed else 1
    threshold = field.threshold(alpha / tails)
    clusters = []
    for sign in (1.0, -1.0)[:tails]:
        for begin, end in stretches(sign * t, threshold):
            p = min(1.0, tails * field.cluster_at_least(end - begin, threshold))
            clusters.append(Cluster(begin, end, sign > 0.0, p))
    return Comparison(t, threshold, sorted(clusters), field, two_tailed)


def stretches(curve: Array, height: float) -> list[tuple[float, float]]:
    """(first, last) node of each stretch above a height, interpolated where the curve crosses it."""
    above = np.concatenate([[False], curve > height, [False]])
    edges = np.flatnonzero(np.diff(above.astype(np.int8)))
    return [
        (_crossing(curve, begin - 1, height, float(begin)), _crossing(curve, end - 1, height, end - 1.0))
        for begin, end in zip(edges[::2], edges[1::2], strict=True)
    ]


def _crossing(curve: Array, before: int, height: float, otherwise: float) -> float:
    """Where between a node and the next the height is crossed; at either end of the curve, that end."""
    if before < 0 or before + 1 >= len(curve):
        return otherwise
    return float(before + (height - curve[before]) / (curve[before + 1] - curve[before]))


def normalised(values: Array, borders: Sequence[tuple[int, int]], nodes: int = NODES) -> Array:
    """(repetitions, nodes) of a signal (n,), each repetition [first, end) stretched to 0 to 100 %.

    Raises:
        ValueError: a repetition of fewer than two samples, or outside the signal.
    """
    share = np.linspace(0.0, 1.0, nodes)
    rows = []
    for first, end in borders:
        if not 0 <= first < end - 1 < len(values):
            raise ValueError(f"samples {first} to {end} are no repetition in a signal of {len(values)}")
        rows.append(np.interp(share, np.linspace(0.0, 1.0, end - first), values[first:end]))
    return np.array(rows).reshape(len(rows), nodes)
