"""The paired comparison without assumptions about the curves: signs of the differences exchanged at will.

If two methods do not differ, each person's difference could as well have the other sign. The highest point of all t
curves that arise so says how high chance rises (Nichols and Holmes 2002, Human Brain Mapping 15, 1-25).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.spm.paired import Cluster, stretches, t_curve

Array = NDArray[np.float64]

ALL_UP_TO = 12
"""Pairs of which all 2^n exchanges are tried; of more, some are drawn."""
DRAWN = 4096


class Flipped(NamedTuple):
    """What exchanged signs say of a comparison."""

    threshold: float  # t that the highest point exceeds with probability alpha
    p: float  # of the highest point
    clusters: list[Cluster]
    least_p: float  # no smaller one is possible with so few pairs


def compare_by_flips(
    first: Array, second: Array, alpha: float = 0.05, *, two_tailed: bool = True, seed: int = 0
) -> Flipped:
    """Where curves `first` (n, m) differ from `second` (n, m), one row per person.

    p of a cluster: how often exchanged signs give one whose t sums up to as much above the threshold. Raises
    ValueError as `t_curve` does; with so few pairs that least_p > alpha nothing can be significant.
    """
    difference = first - second
    t = t_curve(difference)
    curves = _t_curves(difference, _signs(len(difference), seed))
    heights = np.abs(curves).max(axis=1) if two_tailed else curves.max(axis=1)
    observed = float(np.abs(t).max() if two_tailed else t.max())
    rank = int(np.floor(alpha * len(heights)))
    threshold = float(np.sort(heights)[::-1][rank]) if rank < len(heights) else float(heights.min())
    masses = np.zeros(len(curves))
    for k in np.flatnonzero(heights > threshold):
        masses[k] = max(_masses(curves[k], threshold, two_tailed=two_tailed))
    clusters = [
        Cluster(begin, end, sign > 0.0, _share(masses, _mass(sign * t, begin, end, threshold)))
        for sign in ((1.0, -1.0) if two_tailed else (1.0,)) for begin, end in stretches(sign * t, threshold)
    ]  # fmt: skip
    least = (2.0 if two_tailed else 1.0) / len(heights)
    return Flipped(threshold, _share(heights, observed), sorted(clusters), least)


def _signs(n: int, seed: int) -> Array:
    """(exchanges, n) of 1 and -1, the first as it is."""
    if n <= ALL_UP_TO:
        bits = (np.arange(2**n)[:, None] >> np.arange(n)) & 1
        return np.asarray(1.0 - 2.0 * bits)
    drawn = np.random.default_rng(seed).choice([-1.0, 1.0], size=(DRAWN, n))
    drawn[0] = 1.0
    return np.asarray(drawn)


def _t_curves(difference: Array, signs: Array) -> Array:
    """(exchanges, m): squares do not change with signs, so only the mean does."""
    n = len(difference)
    mean = signs @ difference / n
    variance = np.maximum((np.square(difference).sum(axis=0) - n * mean**2) / (n - 1), 1e-30)
    return np.asarray(mean / np.sqrt(variance / n))


def _masses(curve: Array, height: float, *, two_tailed: bool) -> list[float]:
    return [
        _mass(sign * curve, begin, end, height)
        for sign in ((1.0, -1.0) if two_tailed else (1.0,)) for begin, end in stretches(sign * curve, height)
    ]  # fmt: skip


def _mass(curve: Array, begin: float, end: float, height: float) -> float:
    inside = curve[int(np.ceil(begin)) : int(np.floor(end)) + 1]
    return float((inside - height).sum())


def _share(of: Array, value: float) -> float:
    """How many are at least that large; the observed one is among them."""
    return float((of >= value - 1e-9).mean())
