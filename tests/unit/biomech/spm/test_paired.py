"""Comparison of paired curves, against the kept oracle spm1d and against what was put in."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from scipy.stats import ttest_rel

from services.biomech.spm.paired import compare, normalised, stretches, t_curve


def curves(seed: int, people: int, sigma: float, effect: float) -> tuple[np.ndarray, np.ndarray]:
    """Two methods that differ about the middle of the movement."""
    generator = np.random.default_rng(seed)
    first, second = (gaussian_filter1d(generator.normal(size=(people, 101)), sigma, axis=1) for _ in range(2))
    return first * sigma**0.5 + effect * np.exp(-(((np.arange(101) - 50.0) / 15.0) ** 2)), second * sigma**0.5


CASES = [(1, 7, 8.0, 2.0), (2, 10, 5.0, 1.5), (3, 7, 20.0, 3.0), (4, 30, 3.0, -0.8)]
KNOWN = [
    (16.226873, 5.130857, []),
    (11.688948, 4.352443, [(35.240785, 67.420183, 0.0)]),
    (68.153989, 3.686249, [(31.880609, 73.131228, 0.0063632)]),
    (7.656531, 3.506294, [(46.959185, 58.523119, 6.4e-07)]),
]
"""spm1d 0.4.55 on CASES, two-tailed: FWHM, t*, and first, last and p of the clusters."""


def test_t_is_that_of_every_node() -> None:
    first, second = curves(0, 9, 5.0, 1.0)
    assert t_curve(first - second) == pytest.approx(ttest_rel(first, second).statistic)


@pytest.mark.parametrize(("case", "known"), list(zip(CASES, KNOWN, strict=True)))
def test_agrees_with_what_spm1d_said(case: tuple, known: tuple) -> None:
    found = compare(*curves(*case))
    fwhm, threshold, clusters = known
    assert found.field.fwhm == pytest.approx(fwhm, rel=1e-6)
    assert found.threshold == pytest.approx(threshold, abs=1e-5)
    assert [(c.first, c.last, c.p) for c in found.clusters] == [pytest.approx(c, abs=1e-5) for c in clusters]


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("two_tailed", [True, False])
def test_agrees_with_spm1d(case: tuple, two_tailed: bool) -> None:
    spm1d = pytest.importorskip("spm1d", reason="the oracle is in the extra `peers`")
    first, second = curves(*case)
    theirs = spm1d.stats.ttest_paired(first, second)
    said = theirs.inference(0.05, two_tailed=two_tailed, interp=True)
    found = compare(first, second, two_tailed=two_tailed)
    assert found.t == pytest.approx(np.asarray(theirs.z))
    assert found.threshold == pytest.approx(float(said.zstar), abs=1e-6)
    clusters = sorted((*map(float, c.endpoints), float(c.P)) for c in said.clusters)
    assert [(c.first, c.last, c.p) for c in found.clusters] == [pytest.approx(c, abs=1e-6) for c in clusters]


def test_finds_where_they_differ_and_which_has_more() -> None:
    found = compare(*curves(1, 12, 8.0, 3.0))
    assert len(found.clusters) == 1
    cluster = found.clusters[0]
    assert cluster.positive
    assert cluster.first < 50 < cluster.last
    assert cluster.p < 1e-3
    assert found.share(positive=True) == pytest.approx(cluster.extent / 100)
    assert found.share(positive=False) == 0.0


def test_exchanging_the_methods_exchanges_the_sign() -> None:
    first, second = curves(1, 12, 8.0, 3.0)
    one, other = compare(first, second), compare(second, first)
    assert other.t == pytest.approx(-one.t)
    assert [c.positive for c in other.clusters] == [False]
    assert other.clusters[0][:2] == pytest.approx(one.clusters[0][:2])


def test_one_tail_does_not_see_the_other_sign() -> None:
    first, second = curves(1, 12, 8.0, 3.0)
    assert not compare(second, first, two_tailed=False).clusters
    assert compare(first, second, two_tailed=False).threshold < compare(first, second).threshold


def test_stretches_begin_and_end_where_the_curve_crosses() -> None:
    assert stretches(np.array([0.0, 2.0, 2.0, 0.0, 0.0, 4.0]), 1.0) == [(0.5, 2.5), (4.25, 5.0)]
    assert stretches(np.array([2.0, 2.0]), 1.0) == [(0.0, 1.0)]
    assert stretches(np.array([0.0, 0.5]), 1.0) == []


def test_repetitions_are_stretched_to_a_hundred_percent() -> None:
    values = np.arange(20.0)
    found = normalised(values, [(2, 5), (10, 19)], nodes=5)
    assert found == pytest.approx(np.array([[2.0, 2.5, 3.0, 3.5, 4.0], [10.0, 12.0, 14.0, 16.0, 18.0]]))


@pytest.mark.parametrize("borders", [(3, 4), (-1, 5), (15, 21)])
def test_what_is_no_repetition_is_told(borders: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="no repetition"):
        normalised(np.zeros(20), [borders])


def test_bad_curves_are_told() -> None:
    good = np.random.default_rng(0).normal(size=(5, 10))
    with pytest.raises(ValueError, match="shapes"):
        compare(good, good[:, 1:])
    with pytest.raises(ValueError, match="finite"):
        compare(good, np.full_like(good, np.nan))
    with pytest.raises(ValueError, match="differ by the same"):
        compare(good, good + 1.0)
    with pytest.raises(ValueError, match="pairs"):
        compare(good[:2], good[2:4])
