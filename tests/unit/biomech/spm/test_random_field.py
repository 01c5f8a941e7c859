"""Heights that chance reaches, against closed forms and simulation."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from scipy.stats import t as student

from services.biomech.spm.paired import compare, t_curve
from services.biomech.spm.random_field import TField, full_width_half_maximum


def noise(generator: np.random.Generator, curves: int, nodes: int, sigma: float) -> np.ndarray:
    """Smooth curves without an edge."""
    white = generator.normal(size=(curves, nodes + 200))
    return gaussian_filter1d(white, sigma, axis=1)[:, 100 : 100 + nodes]


def test_smoothness_of_smoothed_noise_is_that_of_the_kernel() -> None:
    """A Gaussian kernel of sigma makes a field of FWHM sigma sqrt(8 ln 2)."""
    curves = noise(np.random.default_rng(0), 400, 501, 8.0)
    assert full_width_half_maximum(curves - curves.mean(axis=0)) == pytest.approx(
        8.0 * np.sqrt(8 * np.log(2)), rel=0.02
    )


def test_a_field_without_length_is_students_t() -> None:
    """But for excursions being Poisson: 1 - exp(-P) = alpha."""
    field = TField(nu=9.0, nodes=2, fwhm=1e9)
    assert field.threshold(0.05) == pytest.approx(student.isf(-np.log(0.95), 9), abs=1e-6)


def test_a_rough_field_costs_no_more_than_every_node_for_itself() -> None:
    field = TField(nu=9.0, nodes=101, fwhm=0.5)
    assert field.threshold(0.05) == pytest.approx(student.isf(0.05 / 101, 9), abs=1e-6)


def test_threshold_of_many_degrees_of_freedom_is_that_of_a_gaussian_field() -> None:
    """rho_1 of a Gaussian field is sqrt(4 ln 2) / (2 pi) exp(-u^2 / 2) (Worsley 1996, table II)."""
    field, u = TField(nu=1e7, nodes=101, fwhm=20.0), 3.0
    expected = student.sf(u, 1e7) + 5.0 * np.sqrt(4 * np.log(2)) / (2 * np.pi) * np.exp(-(u**2) / 2)
    assert field.excursions(u) == pytest.approx(expected, rel=1e-5)


def test_rougher_and_longer_curves_need_higher_peaks() -> None:
    heights = [TField(6.0, 101, fwhm).threshold(0.05) for fwhm in (60.0, 30.0, 15.0, 7.0)]
    assert heights == sorted(heights)
    assert heights[0] > student.isf(0.05, 6)


def test_longer_stretches_are_more_surprising() -> None:
    field = TField(6.0, 101, 20.0)
    chances = [field.cluster_at_least(extent, field.threshold(0.05)) for extent in (0.0, 2.0, 8.0, 30.0)]
    assert chances == sorted(chances, reverse=True)
    assert chances[0] == pytest.approx(0.05)
    assert chances[-1] < 1e-3


@pytest.mark.parametrize("alpha", [0.0, -0.1, 0.6])
def test_an_alpha_that_is_none_is_told(alpha: float) -> None:
    with pytest.raises(ValueError, match="alpha"):
        TField(6.0, 101, 20.0).threshold(alpha)


def test_curves_that_agree_somewhere_cannot_be_tested() -> None:
    curves = np.random.default_rng(0).normal(size=(5, 20))
    curves[:, 7] = 0.0
    with pytest.raises(ValueError, match="node 7"):
        full_width_half_maximum(curves)


@pytest.mark.parametrize(("people", "sigma"), [(7, 8.0), (12, 4.0)])
def test_chance_exceeds_the_threshold_as_often_as_said(people: int, sigma: float) -> None:
    """The threshold for the kernel's true smoothness, over 1500 comparisons of noise with none: 0.05 +- 0.015."""
    generator = np.random.default_rng(people)
    height = TField(people - 1.0, 101, sigma * np.sqrt(8 * np.log(2))).threshold(0.025)
    peaks = [np.abs(t_curve(noise(generator, people, 101, sigma))).max() for _ in range(1500)]
    assert np.mean(np.array(peaks) > height) == pytest.approx(0.05, abs=0.015)


def test_chance_does_so_with_the_smoothness_estimated_from_the_curves_too() -> None:
    generator = np.random.default_rng(3)
    found = [bool(compare(noise(generator, 8, 101, 7.0), noise(generator, 8, 101, 7.0)).clusters) for _ in range(500)]
    assert np.mean(found) == pytest.approx(0.05, abs=0.025)
