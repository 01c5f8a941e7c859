import numpy as np
import pytest

from schemas.gait import Stride
from schemas.vocabulary import Side
from services.bench.performance.loss_scores import Errors, recovery_s, rms
from services.bench.performance.lossy_strides import compare

TIME_S = np.arange(0.0, 10.0, 0.01)


def errors(disturbed: np.ndarray) -> Errors:
    valid = (TIME_S < 4.0) | (TIME_S > 7.0)
    return Errors(TIME_S, disturbed, np.full(len(TIME_S), 2.0), np.full(len(TIME_S), 3.0), valid)


def test_growth_is_what_faults_add():
    found = errors(np.where((TIME_S >= 4.0) & (TIME_S < 6.0), -7.0, 2.0))
    assert found.within(4.0, 6.0).growth == pytest.approx(5.0)
    assert found.within(0.0, 4.0).growth == 0.0
    assert found.where_valid().growth == 0.0
    assert found.within(4.0, 6.0).claimed == 0.0
    assert found.within(6.0, 7.0).claimed == 1.0


def test_instants_without_truth_do_not_count():
    assert rms(np.array([3.0, np.nan, -3.0])) == 3.0
    assert np.isnan(rms(np.array([np.nan])))


@pytest.mark.parametrize(("falls_s", "expected"), [(6.0, 0.0), (6.8, 0.8), (7.5, 1.5)])
def test_recovery_is_when_the_error_is_back_for_good(falls_s, expected):
    found = errors(np.where((TIME_S >= 4.0) & (falls_s > TIME_S), 9.0, 2.5))
    assert recovery_s(found, 6.0) == pytest.approx(expected, abs=0.05)


def stride(start_s: float, end_s: float) -> Stride:
    """Only its side and its ends count."""
    return Stride.model_construct(
        side=Side.LEFT,
        start_ns=round(start_s * 1e9),
        end_ns=round(end_s * 1e9),
        stride_time_s=end_s - start_s,
        valid=True,
    )


def test_a_stride_is_found_when_both_its_ends_are_true_contacts():
    contacts_s = {Side.LEFT: np.array([1.0, 2.0, 3.0, 4.0]), Side.RIGHT: np.zeros(1)}
    found = compare([stride(1.01, 2.03), stride(2.03, 4.0), stride(3.5, 4.0)], contacts_s)
    assert (found.true, found.found, found.invented) == (3, 1, 2)
    assert found.errors_ms == [pytest.approx(20.0)]
