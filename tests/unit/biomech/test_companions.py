"""States beside the filter's own: what they cost it (nothing), what they follow, and when they are believed."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from services.biomech.companions import CompanionModel, smaller_parts
from services.biomech.kernels.evidence import bold_share
from services.biomech.lower_body import LowerBodyModel
from services.biomech.lower_body_ekf import LowerBodyEkf, MeasurementModel

sys.path.insert(0, str(Path(__file__).parent))
from test_lower_body_ekf import ALL, BODY, mounts, rest_of, samples_of

MODEL = LowerBodyModel(BODY)
KNEE = MODEL.names.index("knee_flexion_right")
JOINTS = ("knee_flexion_right", "hip_flexion_left")
BESIDE = CompanionModel((1.0, 0.1), JOINTS)
NOTHING = np.zeros(15)


def filter_with(companions: CompanionModel | None = None, measurement: MeasurementModel | None = None) -> LowerBodyEkf:
    return LowerBodyEkf(MODEL, mounts(), np.zeros((5, 3)), measurement or MeasurementModel(), companions=companions)


def feed(ekf: LowerBodyEkf, steps: int = 150, jerk: float = 0.0) -> None:
    ekf.companions.jerk[:, KNEE] = jerk
    for sample in samples_of(MODEL, steps, 0.01):
        ekf.advance(0.01, sample, ALL, NOTHING, rest_of(MODEL))


def test_the_filter_itself_knows_nothing_of_its_companions() -> None:
    alone, accompanied = filter_with(), filter_with(BESIDE)
    feed(alone)
    feed(accompanied, jerk=300.0)
    np.testing.assert_array_equal(accompanied.x, alone.x)
    np.testing.assert_array_equal(accompanied.P, alone.P)
    np.testing.assert_array_equal(alone.estimate, alone.x)
    assert not np.array_equal(accompanied.companions.x[0], alone.x)


@pytest.mark.parametrize("yaw", ["none", "relative", "world"])
def test_a_companion_that_expects_the_same_is_the_same(yaw: str) -> None:
    ekf = filter_with(CompanionModel((1.0,), JOINTS), MeasurementModel(yaw=yaw))
    feed(ekf)
    np.testing.assert_allclose(ekf.companions.x[0], ekf.x, atol=1e-9)


def test_a_companion_follows_the_filter_that_is_fed_the_same_jerk() -> None:
    """Gains are those of the filter without jerk: not the same, but nearly."""
    beside, fed, jerk = filter_with(CompanionModel((1.0,), JOINTS)), filter_with(), NOTHING.copy()
    jerk[KNEE] = 100.0
    beside.companions.jerk[0] = jerk
    for sample in samples_of(MODEL, 150, 0.01):
        beside.advance(0.01, sample, ALL, NOTHING, rest_of(MODEL))
        fed.advance(0.01, sample, ALL, jerk, rest_of(MODEL))
    apart = np.abs(fed.x - beside.x).max(axis=1)
    left = np.abs(fed.x - beside.companions.x[0]).max(axis=1)
    assert (left < np.array([0.3, 0.01, 0.01]) * apart).all()


def test_a_wrong_jerk_is_not_believed_and_touches_no_other_joint() -> None:
    ekf = filter_with(BESIDE)
    feed(ekf, jerk=800.0)
    decided = [MODEL.names.index(name) for name in JOINTS]
    assert ekf.companions.weight[0, ekf.companions.group[KNEE]] == 0.0
    np.testing.assert_array_equal(ekf.estimate[:, KNEE], ekf.x[:, KNEE])
    others = [j for j in range(15) if j not in decided]
    np.testing.assert_array_equal(ekf.estimate[:, others], ekf.x[:, others])


@pytest.mark.parametrize(("judges", "groups"), [("segment", 4), ("leg", 2), ("body", 1)])
def test_who_judges(judges: str, groups: int) -> None:
    ekf = filter_with(replace(BESIDE, judges=judges))
    feed(ekf, 20, jerk=800.0)
    assert ekf.companions.weight.shape == (2, groups)
    assert (ekf.companions.group >= 0).sum() == 2


def test_state_goes_on_from_a_snapshot() -> None:
    whole, first, second = filter_with(BESIDE), filter_with(BESIDE), filter_with(BESIDE)
    feed(whole, 100, jerk=50.0)
    feed(first, 60, jerk=50.0)
    second.x[:], second.P[:] = first.x, first.P
    second.unpack_companions(first.pack_companions())
    for sample in samples_of(MODEL, 100, 0.01)[60:]:
        second.advance(0.01, sample, ALL, NOTHING, rest_of(MODEL))
    np.testing.assert_array_equal(second.estimate, whole.estimate)
    np.testing.assert_array_equal(second.companions.weight, whole.companions.weight)


def test_settling_brings_everyone_to_the_same_pose() -> None:
    ekf = filter_with(BESIDE)
    feed(ekf, 50, jerk=300.0)
    ekf.settle()
    for state in (ekf.estimate, *ekf.companions.x):
        np.testing.assert_array_equal(state, ekf.x)
    assert not ekf.companions.jerk.any()


@pytest.mark.parametrize("density", [3.0, 300.0, 3e4])
@pytest.mark.parametrize("share", [0.01, 0.1, 0.5])
def test_smaller_parts_are_those_of_a_filter_with_less_noise(density: float, share: float) -> None:
    """Against the steady gains of velocity and acceleration, found by running the covariance until it settles."""

    def gains(S: float) -> np.ndarray:
        dt, P = 0.01, np.eye(2)
        F, G = np.array([[1.0, dt], [0.0, 1.0]]), np.array([dt * dt / 2.0, dt])
        K = np.zeros(2)
        for _ in range(5000):
            P = F @ P @ F.T + np.outer(G, G) * S / dt
            K = P[:, 0] / (P[0, 0] + 0.05**2)
            P = P - np.outer(K, P[0])
        return K

    parts = smaller_parts(density, 0.05, 0.01, share)
    np.testing.assert_allclose(parts, gains(share * density) / gains(density), rtol=1e-6)
    assert smaller_parts(density, 0.05, 0.01, 1.0) == (1.0, 1.0)


def test_evidence_moves_the_share_both_ways() -> None:
    evidence = np.zeros(2)
    random = np.random.default_rng(0)
    better = [bold_share(evidence, 1.0 + random.normal(), 0.01, 1.0, 0.5, -0.5) for _ in range(300)]
    worse = [bold_share(evidence, -1.0 + random.normal(), 0.01, 1.0, 0.5, -0.5) for _ in range(300)]
    assert better[-1] == 1.0
    assert worse[-1] == 0.0
