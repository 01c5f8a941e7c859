import sys
from pathlib import Path

import numpy as np
import pytest

from schemas.session import StandingInterval
from services.estimation.samples import Tick
from services.estimation.standing import StandingDetector

sys.path.insert(0, str(Path(__file__).parent))
from tests.unit.estimation import estimation_walks as walks

SENSORS = walks.describe().hubs[0].sensors
ALL = np.ones(5, dtype=np.bool_)


def ticks(samples, first: int = 0) -> list[Tick]:
    return [Tick((first + k) * 10_000_000, sample, ALL) for k, sample in enumerate(samples)]


def standing(seconds: float, *, scale: float = 1.0, seed: int = 0):
    samples = walks.walk(seed=seed)[1][:200]
    repeats = int(np.ceil(seconds / 2.0))
    result = np.concatenate([samples] * repeats)[: int(seconds * 100)].copy()
    result[:, :, 3:] *= scale
    return result


def feed(detector: StandingDetector, samples, first: int = 0) -> StandingDetector:
    for tick in ticks(samples, first):
        detector.add(tick)
    return detector


def test_standing_gives_verticals_and_biases() -> None:
    detector = feed(StandingDetector(SENSORS), standing(4.0))
    reference = detector.reference
    assert reference is not None
    assert reference.duration_s > 3.0
    np.testing.assert_allclose(np.linalg.norm(reference.mean_force, axis=1), 9.81, atol=0.02)
    np.testing.assert_allclose(reference.gyro_bias, walks.gyro_bias(), atol=4e-3)
    assert reference.usable.all()
    assert not reference.wrong_units.any()


def test_too_short_is_no_standing() -> None:
    assert feed(StandingDetector(SENSORS), standing(1.0)).reference is None


def test_the_share_of_standing_grows_until_there_is_one_and_falls_to_nothing_in_a_movement() -> None:
    detector = StandingDetector(SENSORS)
    shares = []
    for tick in ticks(standing(2.0)):
        detector.add(tick)
        shares.append(detector.stood)
        assert (detector.reference is not None) == (detector.stood == 1.0) or detector.stood > 0.9
    assert shares == sorted(shares)
    assert shares[0] == 0.0
    assert shares[-1] == 1.0
    interrupted = feed(StandingDetector(SENSORS), standing(0.8))
    assert 0.3 < interrupted.stood < 1.0
    assert feed(interrupted, walks.walk()[1][300:400], first=80).stood == 0.0


def test_walking_is_no_standing() -> None:
    detector = feed(StandingDetector(SENSORS), walks.walk()[1][300:])
    assert detector.reference is None
    assert not detector.is_still


def test_the_onset_of_walking_is_not_averaged_in() -> None:
    detector = feed(StandingDetector(SENSORS), walks.walk()[1][:400])
    assert detector.reference is not None
    assert detector.reference.until_ns <= walks.STANDING_S * 1e9
    np.testing.assert_allclose(detector.reference.gyro_bias, walks.gyro_bias(), atol=6e-3)


def test_the_newest_standing_counts() -> None:
    detector = feed(StandingDetector(SENSORS), walks.walk()[1][:500])
    first = detector.reference
    feed(detector, standing(3.0, seed=1), first=500)
    assert first is not None
    assert detector.reference is not None
    assert detector.reference.until_ns > first.until_ns


@pytest.mark.parametrize(
    ("scale", "wrong"), [(1 / 9.81, True), (0.94, True), (0.97, False), (1.03, False), (1.06, True)]
)
def test_gravity_tells_wrong_units(scale: float, wrong: bool) -> None:
    reference = feed(StandingDetector(SENSORS), standing(3.0, scale=scale)).reference
    assert reference is not None
    assert reference.wrong_units.tolist() == [wrong] * 5
    assert reference.usable.tolist() == [not wrong] * 5


def test_a_silent_sensor_is_not_usable() -> None:
    detector = StandingDetector(SENSORS)
    fresh = np.array([True, True, False, True, True])
    for tick in ticks(standing(3.0)):
        detector.add(Tick(tick.captured_ns, tick.samples * fresh[:, None], fresh))
    assert detector.reference is not None
    np.testing.assert_array_equal(detector.reference.usable, fresh)


def test_sitting_is_told_by_the_thighs() -> None:
    samples = standing(3.0)
    samples[:, 1, 3:] = [0.5, 0.0, 9.79] + 0.01 * samples[:, 1, :3]
    detector = feed(StandingDetector(SENSORS), samples)
    assert detector.is_sitting
    assert detector.reference is None


def test_marked_standing_is_taken_as_it_is() -> None:
    marked = [StandingInterval(from_ns=1_000_000_000, to_ns=2_000_000_000)]
    detector = feed(StandingDetector(SENSORS, marked), walks.walk()[1][:300])
    assert detector.reference is not None
    assert detector.reference.until_ns == 2_000_000_000
    assert detector.reference.duration_s == 1.0
