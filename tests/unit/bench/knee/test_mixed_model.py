"""The mixed model finds what data were made of."""

import numpy as np
import pytest

from services.bench.knee.mixed_model import fit


def made(subject_std: float, noise: float):
    draw = np.random.default_rng(4)
    subjects = np.repeat(np.arange(40), 10)
    x, z = draw.uniform(0.0, 5.0, 400), draw.uniform(0.0, 5.0, 400)
    y = (
        2.0
        + 0.8 * x
        + 0.1 * x * z
        + subject_std * draw.standard_normal(40)[subjects]
        + noise * draw.standard_normal(400)
    )
    return y, {"x": x, "z": z, "x z": x * z}, subjects


def test_coefficients_and_both_deviations_are_found():
    model = fit(*made(1.0, 0.3))
    estimates = [c.estimate for c in model.coefficients]
    assert estimates[1:] == pytest.approx([0.8, 0.0, 0.1], abs=0.06)
    assert model.subject_std == pytest.approx(1.0, rel=0.25)
    assert model.residual_std == pytest.approx(0.3, rel=0.1)
    assert [c.p < 0.001 for c in model.coefficients] == [True, True, False, True]
    assert model.p < 1e-6
    assert model.adjusted_r_squared > model.fixed_r_squared


def test_without_subjects_it_is_plain_least_squares():
    y, factors, subjects = made(0.0, 0.3)
    model = fit(y, factors, subjects)
    plain = np.linalg.lstsq(np.column_stack([np.ones(400), *factors.values()]), y, rcond=None)[0]
    assert [c.estimate for c in model.coefficients] == pytest.approx(plain.tolist(), abs=0.02)
    assert model.subject_std < 0.06


def test_the_standard_error_holds_over_repetitions():
    estimates, errors = [], []
    for seed in range(60):
        draw = np.random.default_rng(seed)
        subjects = np.repeat(np.arange(8), 6)
        x = draw.normal(size=48) + draw.normal(size=8)[subjects]
        y = 0.5 * x + draw.normal(size=8)[subjects] + draw.normal(size=48)
        slope = fit(y, {"x": x}, subjects).coefficients[1]
        estimates.append(slope.estimate)
        errors.append(slope.std_error)
    assert np.mean(estimates) == pytest.approx(0.5, abs=0.08)
    assert np.std(estimates) == pytest.approx(np.mean(errors), rel=0.25)


def test_too_few_trials_are_refused():
    with pytest.raises(ValueError, match="do not tell"):
        fit(np.ones(2), {"x": np.arange(2.0)}, [0, 1])
