"""A linear model with one random intercept per subject, as in McGrath et al. 2018, sections 3.5 and 4.2."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.optimize import minimize_scalar

Array = NDArray[np.float64]


class Coefficient(NamedTuple):
    """One line of table 2."""

    term: str
    estimate: float
    std_error: float
    t: float
    p: float


class MixedModel(NamedTuple):
    """The fitted model; deviations in the unit of the response."""

    coefficients: list[Coefficient]
    adjusted_r_squared: float  # of the fitted values, subjects' intercepts included
    fixed_r_squared: float  # of the fixed effects alone, adjusted
    p: float  # that no factor has an effect
    subject_std: float
    residual_std: float


def fit(response: Array, factors: dict[str, Array], subjects: Sequence[int]) -> MixedModel:
    """Fit response (n,) = constant + factors (n,) each + subject + noise by restricted maximum likelihood.

    With lam the ratio of both variances, taking (1 - 1 / sqrt(1 + lam n_s)) of each subject's mean off leaves white
    noise: least squares for every lam, and one search over lam.

    Raises:
        ValueError: there are not more trials than coefficients.
    """
    X = np.column_stack([np.ones_like(response), *factors.values()])
    n, p = X.shape
    if n <= p:
        raise ValueError(f"{n} trials do not tell {p} coefficients")
    of = np.unique(subjects, return_inverse=True)[1]
    counts = np.bincount(of).astype(float)

    def whitened(values: Array, lam: float) -> Array:
        share = 1.0 - 1.0 / np.sqrt(1.0 + lam * counts)
        means = np.stack([np.bincount(of, column) / counts for column in values.T], axis=1)
        return np.asarray(values - (share[:, None] * means)[of])

    def solve(lam: float) -> tuple[Array, float, Array]:
        Xw, yw = whitened(X, lam), whitened(response[:, None], lam)[:, 0]
        beta = np.asarray(np.linalg.lstsq(Xw, yw, rcond=None)[0], dtype=np.float64)
        return beta, float(np.sum((yw - Xw @ beta) ** 2)), Xw

    def misfit(log_lam: float) -> float:
        lam = float(np.exp(log_lam))
        _, rss, Xw = solve(lam)
        return float((n - p) * np.log(rss) + np.sum(np.log1p(lam * counts)) + np.linalg.slogdet(Xw.T @ Xw)[1])

    lam = float(np.exp(minimize_scalar(misfit, bounds=(-12.0, 7.0), method="bounded").x))
    beta, rss, Xw = solve(lam)
    variance = rss / (n - p)
    covariance = variance * np.linalg.inv(Xw.T @ Xw)
    left = response - X @ beta
    intercepts = lam * np.bincount(of, left) / (1.0 + lam * counts)
    return MixedModel(
        _coefficients(["constant", *factors], beta, np.sqrt(np.diag(covariance)), n - p),
        _adjusted(response, left - intercepts[of], p), _adjusted(response, left, p),
        _no_effect(beta, covariance, n), float(np.sqrt(lam * variance)), float(np.sqrt(variance)),
    )  # fmt: skip


def _coefficients(terms: list[str], beta: Array, errors: Array, freedom: int) -> list[Coefficient]:
    ratio = beta / errors
    p = 2.0 * stats.t.sf(np.abs(ratio), freedom)
    return [
        Coefficient(*line)
        for line in zip(terms, beta.tolist(), errors.tolist(), ratio.tolist(), p.tolist(), strict=True)
    ]


def _adjusted(response: Array, left: Array, p: int) -> float:
    """Adjusted coefficient of determination for what the model leaves (n,)."""
    n = len(response)
    return float(1.0 - (n - 1) / (n - p) * np.sum(left**2) / np.sum((response - response.mean()) ** 2))


def _no_effect(beta: Array, covariance: Array, n: int) -> float:
    """Probability that all slopes are zero (F test)."""
    slopes = len(beta) - 1
    statistic = beta[1:] @ np.linalg.solve(covariance[1:, 1:], beta[1:]) / slopes
    return float(stats.f.sf(statistic, slopes, n - slopes - 1))
